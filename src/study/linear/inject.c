// Measures a loop in runs of its scenario: the loop gain from small sines that are added
// to the command, and the least impulse at the tip that loses contact.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/rig/controller_values.h"
#include "src/run/run_loop.h"
#include "src/study/linear/linear.h"

enum {
    FIRST_FREQUENCIES = 28, // of the first pass
    REFINING_PASSES = 4,    // each halves the intervals with a crossing
    MOST_POINTS = 160,
    MOST_WINDOWS = 40, // that a sine is measured in
    PUSH_HALVINGS = 28
};

#define LOWEST_FREQUENCY 0.5  // [Hz]
#define LEAST_WINDOW     0.5  // in which a sine is measured [s]
#define LEAST_CYCLES     3    // of the sine in a window
#define AGREEMENT        1e-4 // relative difference of two windows that agree
#define FIRST_SHARE      0.02 // first amplitude over the command that holds the contact
#define MOST_SINE        0.2  // largest amplitude over the largest command
#define NO_ANSWER        1e-9 // loop gain below which the law does not answer
#define FOLLOWED         0.5  // time for which a push is followed [s]
#define MOST_PUSHED      10.0 // largest impulse that is tried [N s]

// The two sines that are added to the command: the one whose answer is measured, and one
// at another frequency that keeps a law moving which sleeps while little changes.
enum { MEASURED, WAKING, SINES };

// A law that calls another one, the measured law, and adds sines to its command. `inner`
// holds the measured law, its memory and, of a process, the program.
typedef struct sine_probe {
    rig *inner;
    double amplitude[SINES];  // [V]
    double phase_step[SINES]; // from sample to sample [rad]
    double first_amplitude;   // with which each measurement begins [V]
    double wanted_swing;      // amplitude of the force to aim at [N]
    double waking_amplitude;  // the smallest to which the law answered [V]
    double waking_hertz;      // the frequency at which it did

    // of the window so far: samples, Fourier sums at the measured frequency, plain sums
    long sample;
    double complex law_fourier, command_fourier, force_fourier;
    double command_sum, force_sum, force_square_sum;
} sine_probe;

// Asks the measured law for its command, adds both sines to it, and adds what the law
// answered, the command and the force to the window's sums.
static void sample_with_sine(void *memory, const controller_input *in,
                             controller_output *out)
{
    sine_probe *probe;
    double sine, cosine;
    memcpy(&probe, memory, sizeof probe);
    probe->inner->law->sample(probe->inner->memory, in, out);
    const double answer = out->command;

    // each sine begins at 45 degrees: sin(x + 45 degrees) = sqrt(1/2) (sin x + cos x)
    inline_sincos(probe->phase_step[WAKING] * (double)probe->sample, &sine, &cosine);
    out->command += probe->amplitude[WAKING] * sqrt(0.5) * (sine + cosine);
    inline_sincos(probe->phase_step[MEASURED] * (double)probe->sample, &sine, &cosine);
    out->command += probe->amplitude[MEASURED] * sqrt(0.5) * (sine + cosine);
    probe->sample++;

    // Fourier sums at the measured frequency, with exp(-i x) = cos x - i sin x
    const double complex turned_back = complex_of(cosine, -sine);
    probe->law_fourier += answer * turned_back;
    probe->command_fourier += out->command * turned_back;
    probe->force_fourier += in->force * turned_back;

    probe->command_sum += out->command;
    probe->force_sum += in->force;
    probe->force_square_sum += in->force * in->force;
}

static const char *tune_inner_law(void *memory, const controller_setup *setup)
{
    sine_probe *probe;
    memcpy(&probe, memory, sizeof probe);
    return probe->inner->law->tune(probe->inner->memory, setup);
}

// Runs the scenario to its end in a loop that can go on from there.
static status run_to_end(run_loop **loop, const scenario *s, const loop_options *options,
                         fault *f)
{
    scenario longer = *s; // borrows its script
    longer.parameters.run.duration = 1e4;
    TRY(loop_create(loop, &longer, options, f));
    return loop_until(*loop, s->parameters.run.duration, f);
}

// --- sines -----------------------------------------------------------------------------

// Lets the loop run for a window of samples. It is a fault if the arm does not press at
// the window's end or has lost the wall within it.
static status pass_window(run_loop *l, sine_probe *probe, double samples, fault *f)
{
    const double separations_before = loop_summary(l).separations;
    status code = STATUS_OK;
    probe->sample = 0;
    probe->law_fourier = probe->command_fourier = probe->force_fourier = 0;
    probe->command_sum = probe->force_sum = probe->force_square_sum = 0;

    while (probe->sample < (long)samples && code == STATUS_OK) {
        code = loop_step(l, f);
    }
    if (code == STATUS_OK &&
        !(loop_row(l).force > 0 && loop_summary(l).separations <= separations_before)) {
        code = fault_set(f, STATUS_UNSTABLE,
                         "at t = %.4g s the arm does not press on the wall: what happens "
                         "about rest cannot be measured",
                         loop_time(l));
    }
    return code;
}

// Chooses the swing of force to aim at and the first amplitude, from a window without a
// sine. The swing is the geometric mean of the reading's noise and the force that holds
// the contact, from a tenth of that force (laws may sleep where less moves) to half of
// it. The first amplitude exceeds the steps of the D/A converter.
static status size_sine(run_loop *l, sine_probe *probe, fault *f)
{
    const double samples = ceil(LEAST_WINDOW / probe->inner->period);
    const status code = pass_window(l, probe, samples, f);

    const double force = probe->force_sum / samples;
    const double variance = probe->force_square_sum / samples - force * force;
    const double noise = sqrt(fmax(0, variance));
    probe->wanted_swing = fmin(fmax(sqrt(noise * force), 0.1 * force), 0.5 * force);

    const double holding_command = fabs(probe->command_sum / samples);
    probe->first_amplitude =
        fmax(FIRST_SHARE * holding_command, 5 * probe->inner->dac.step);
    return code;
}

// Measures the loop gain, -(law's answer)/(command), at about *hertz, which becomes the
// nearest frequency that has whole cycles in whole samples.
static status measure_gain(run_loop *l, sine_probe *probe, double *hertz,
                           double complex *gain, fault *f)
{
    // the frequency of the measured sine, and nearly that of the last sine that kept the
    // law awake
    const double period = probe->inner->period;
    const double largest_amplitude = MOST_SINE * probe->inner->voltage_limit;
    const double cycles = fmax(LEAST_CYCLES, ceil(LEAST_WINDOW * *hertz));
    const double samples = round(cycles / (*hertz * period));
    *hertz = cycles / (samples * period);
    const double waking_cycles = fmax(1, round(probe->waking_hertz * samples * period));
    probe->phase_step[MEASURED] = 2 * M_PI * cycles / samples;
    probe->phase_step[WAKING] = 2 * M_PI * waking_cycles / samples;
    probe->amplitude[MEASURED] = probe->first_amplitude;
    probe->amplitude[WAKING] = 0;

    // window after window until three agree: the transient is gone
    double complex late_law = 0, late_command = 0, gain_before;
    status code = STATUS_OK;
    int agreements = 0;
    *gain = complex_of((double)NAN, 0);
    for (int w = 0; w < MOST_WINDOWS && agreements < 2 && code == STATUS_OK; w++) {
        code = pass_window(l, probe, samples, f);
        if (w >= MOST_WINDOWS / 2) {
            late_law += probe->law_fourier;
            late_command += probe->command_fourier;
        }
        gain_before = *gain;
        *gain = -probe->law_fourier / probe->command_fourier;

        // the amplitude that would give the wanted swing: at most 3 times this one, at
        // least a tenth of it
        const double swing = 2 * cabs(probe->force_fourier) / samples;
        const double factor =
            fmax(0.1, fmin(3, probe->wanted_swing / fmax(swing, 1e-12)));
        const double present = probe->amplitude[MEASURED];
        const double better = fmin(largest_amplitude, present * factor);
        const bool steady = fabs(better - present) < 0.2 * present;
        if (steady && cabs(*gain - gain_before) <= AGREEMENT * cabs(*gain)) {
            agreements++;
        } else {
            agreements = 0;
        }
        if (!steady) {
            probe->amplitude[MEASURED] = better;
        }

        // a law that does not answer is kept awake by the smallest sine that it did
        // answer; one that answers may show a smaller such sine
        const bool answers = cabs(*gain) > NO_ANSWER;
        const bool alone = probe->amplitude[WAKING] == 0;
        if (steady && !answers && alone && isfinite(probe->waking_amplitude)) {
            probe->amplitude[WAKING] = probe->waking_amplitude;
            agreements = 0;
        } else if (steady && answers && alone &&
                   probe->amplitude[MEASURED] < probe->waking_amplitude) {
            probe->waking_amplitude = probe->amplitude[MEASURED];
            probe->waking_hertz = *hertz;
        }
    }

    // noise kept the windows apart: the mean over the later half of them
    if (agreements < 2 && late_command != 0) {
        *gain = -late_law / late_command;
    }
    return code;
}

// Measures the gain at about a frequency and inserts the point where the frequencies keep
// rising.
static status insert_frequency(run_loop *l, sine_probe *probe, double hertz,
                               linear_response *r, fault *f)
{
    double complex gain;
    const status code = measure_gain(l, probe, &hertz, &gain, f);
    int place = r->count++;
    for (; place > 0 && r->frequency[place - 1] > 2 * M_PI * hertz; place--) {
        r->frequency[place] = r->frequency[place - 1];
        r->gain[place] = r->gain[place - 1];
    }
    r->frequency[place] = 2 * M_PI * hertz;
    r->gain[place] = gain;
    return code;
}

// Whether |L| = 1 or a negative real L, which margins are read from, lies between two
// neighbouring loop gains.
static bool crosses_between(double complex gain, double complex next)
{
    const bool crosses_negative_axis =
        cimag(gain) * cimag(next) < 0 && creal(gain + next) < 0;
    return crosses_negative_axis || (cabs(gain) - 1) * (cabs(next) - 1) < 0;
}

// Measures at frequencies in equal ratios up to half the sampling rate, then several
// times in the middle of every interval with a crossing.
static status measure_all(run_loop *l, sine_probe *probe, linear_response *r, fault *f)
{
    const double highest = 1 / (2 * probe->inner->period);
    const double lowest = fmin(LOWEST_FREQUENCY, highest / 10);
    TRY(size_sine(l, probe, f));
    for (int k = 0; k < FIRST_FREQUENCIES; k++) {
        const double share = k / (FIRST_FREQUENCIES - 1.0);
        const double hertz = lowest * plain_pow(highest / lowest, share);
        TRY(insert_frequency(l, probe, hertz, r, f));
    }

    for (int pass = 0; pass < REFINING_PASSES; pass++) {
        double middles[MOST_POINTS]; // geometric means of two neighbours [Hz]
        int count = 0;
        for (int k = 0; k + 1 < r->count && r->count + count < MOST_POINTS; k++) {
            if (crosses_between(r->gain[k], r->gain[k + 1])) {
                middles[count++] =
                    sqrt(r->frequency[k] * r->frequency[k + 1]) / (2 * M_PI);
            }
        }
        for (int k = 0; k < count; k++) {
            TRY(insert_frequency(l, probe, middles[k], r, f));
        }
    }
    return STATUS_OK;
}

status linear_inject(const scenario *s, linear_response *r, fault *f)
{
    assert(s->parameters.control.law != LAW_NONE);
    *r = (linear_response){0};
    sine_probe probe = {.waking_amplitude = (double)INFINITY};
    run_loop *l = NULL;

    // frequencies and complex gains in one block, and a rig with the measured law
    double *block = calloc(3 * MOST_POINTS, sizeof *block);
    status code;
    if (block != NULL) {
        code = rig_create(&probe.inner, &s->parameters, NULL, f);
    } else {
        code = fault_no_memory(f);
    }
    if (code == STATUS_OK && probe.inner->withheld) {
        code = fault_set(f, STATUS_NOT_ALLOWED,
                         "the loop of a program or plug-in needs --allow-code");
    }

    if (code == STATUS_OK) {
        // the run's law is the measured one with another `sample`, whose memory is the
        // probe's address
        controller law = *probe.inner->law;
        law.memory_size = sizeof(sine_probe *);
        law.start = controller_takes_anything; // the inner law was started with its rig
        law.sample = sample_with_sine;
        if (law.tune != NULL) {
            law.tune = tune_inner_law;
        }
        const loop_options options = {.law = {&law, &probe}};
        *r = (linear_response){0, block, (double complex *)(block + MOST_POINTS)};
        code = run_to_end(&l, s, &options, f);
        if (code == STATUS_OK) {
            code = measure_all(l, &probe, r, f);
        }
        loop_destroy(l);
    }

    rig_destroy(probe.inner);
    if (code != STATUS_OK) {
        free(block);
        *r = (linear_response){0};
    }
    return code;
}

// --- pushes ----------------------------------------------------------------------------

// Whether the arm loses contact after an impulse [N s] at its tip, from the saved state
// on.
static status push_loses_contact(run_loop *l, const void *saved, double impulse,
                                 bool *lost, fault *f)
{
    *lost = false;
    TRY(loop_restore(l, saved, loop_saved_size(l), f));
    const double before = loop_summary(l).separations;
    TRY(loop_push(l, impulse, f));
    TRY(loop_until(l, loop_time(l) + FOLLOWED, f));
    *lost = loop_summary(l).separations > before;
    return STATUS_OK;
}

// The least impulse in one direction (1 or -1) that loses contact, by bisection of its
// logarithm; NaN if not even the largest one does.
static status least_push(run_loop *l, const void *saved, double direction, double *least,
                         fault *f)
{
    double low = plain_log(1e-9), high = plain_log(MOST_PUSHED);
    bool largest_loses, middle_loses;
    *least = (double)NAN;
    TRY(push_loses_contact(l, saved, direction * MOST_PUSHED, &largest_loses, f));
    for (int i = 0; i < PUSH_HALVINGS && largest_loses; i++) {
        const double middle = (low + high) / 2;
        const double impulse = direction * plain_exp(middle);
        TRY(push_loses_contact(l, saved, impulse, &middle_loses, f));
        if (middle_loses) {
            high = middle;
        } else {
            low = middle;
        }
        *least = plain_exp(high);
    }
    return STATUS_OK;
}

status linear_contact_margin(const scenario *s, double *impulse, fault *f)
{
    run_loop *l = NULL;
    *impulse = (double)NAN;
    if (s->parameters.control.law == LAW_PROCESS) {
        return STATUS_OK;
    }
    status code = run_to_end(&l, s, &(loop_options){.keep_trace = false}, f);
    if (code == STATUS_OK && loop_row(l).force > 0) {
        void *saved = malloc(loop_saved_size(l));
        double away = (double)NAN, against = (double)NAN;
        if (saved == NULL) {
            code = fault_no_memory(f);
        } else {
            loop_save(l, saved);
            code = least_push(l, saved, -1, &away, f);
        }
        if (code == STATUS_OK) {
            code = least_push(l, saved, 1, &against, f);
        }
        if (code == STATUS_OK) {
            *impulse = fmin(away, against); // the other one if one is NaN
        }
        free(saved);
    }
    loop_destroy(l);
    return code;
}

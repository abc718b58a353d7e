// What a run says of its loop: answers to sines in the command, and to pushes.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/rig/controller_values.h"
#include "src/run/run_loop.h"
#include "src/study/linear/linear.h"

// Frequencies of the first pass, and passes that halve the intervals with a crossing.
enum { FIRST = 28, PASSES = 4, MOST_POINTS = 160, MOST_WINDOWS = 40, PUSHES = 28 };

#define LOWEST      0.5  // [Hz]
#define WINDOW      0.5  // in which a sine is measured, at least [s]
#define CYCLES      3    // at least
#define AGREE       1e-4 // of one window with the two before
#define SHARE       0.02 // of the holding command that a sine begins with
#define MOST_SINE   0.2  // of the largest command
#define NOTHING     1e-9 // of the command: the law does not answer
#define FOLLOWED    0.5  // after a push [s]
#define MOST_PUSHED 10.0 // [N s]

// The law with sines behind it: the one that is measured, and another that keeps the law
// awake. `inner` holds the law itself, its memory and, of a process, the program.
typedef struct injector {
    rig *inner;
    double amplitude[2], turn[2]; // [V], [rad] from sample to sample
    double first, wanted;      // amplitude that one begins with [V], swing of force [N]
    double awake, awake_hertz; // the smallest that a law answered [V]
    long sample;               // since the window began
    double complex law, command,
        force;      // sums over the window, with the sine that is measured
    double mean[3]; // sums of command, force and its square
} injector;

static void sample_with_sine(void *memory, const controller_input *in,
                             controller_output *out)
{
    injector *i;
    double s, c;
    memcpy(&i, memory, sizeof i);
    i->inner->law->sample(i->inner->memory, in, out);
    const double answer = out->command;
    for (int k = 1; k >= 0; k--) { // the one that is measured last; begun at 45 degrees
        inline_sincos(i->turn[k] * (double)i->sample, &s, &c);
        out->command += i->amplitude[k] * sqrt(0.5) * (s + c);
    }
    i->sample++;
    i->law += answer * complex_of(c, -s);
    i->command += out->command * complex_of(c, -s);
    i->force += in->force * complex_of(c, -s);
    i->mean[0] += out->command;
    i->mean[1] += in->force;
    i->mean[2] += in->force * in->force;
}

static const char *tune_inner_law(void *memory, const controller_setup *setup)
{
    injector *i;
    memcpy(&i, memory, sizeof i);
    return i->inner->law->tune(i->inner->memory, setup);
}

// A run that has come to the scenario's end and goes on from there.
static status run_to_end(run_loop **loop, const scenario *s, const loop_options *options,
                         fault *f)
{
    scenario longer = *s; // borrows its script
    longer.parameters.run.duration = 1e4;
    TRY(loop_create(loop, &longer, options, f));
    return loop_until(*loop, s->parameters.run.duration, f);
}

// --- sines -----------------------------------------------------------------------------

// A window of samples, in which the arm has to press and not to let go.
static status pass_window(run_loop *l, injector *i, double samples, fault *f)
{
    const double separations = loop_summary(l).separations;
    status code = STATUS_OK;
    i->sample = 0;
    i->law = i->command = i->force = i->mean[0] = i->mean[1] = i->mean[2] = 0;
    while (i->sample < (long)samples && code == STATUS_OK) {
        code = loop_step(l, f);
    }
    if (code == STATUS_OK &&
        !(loop_row(l).force > 0 && loop_summary(l).separations <= separations)) {
        code = fault_set(f, STATUS_UNSTABLE,
                         "at t = %.4g s the arm does not press on the wall: what happens "
                         "about rest cannot be measured",
                         loop_time(l));
    }
    return code;
}

// How large a sine may be: its force swings as far above the noise of the reading as it
// stays below the force that holds the contact, in equal ratios, from a tenth of that
// force (laws may sleep where less moves) to half of it. It begins larger than the steps
// of the D/A converter.
static status size_sine(run_loop *l, injector *i, fault *f)
{
    const double samples = ceil(WINDOW / i->inner->period);
    const status code = pass_window(l, i, samples, f);
    const double force = i->mean[1] / samples,
                 noise = sqrt(fmax(0, i->mean[2] / samples - force * force));
    i->wanted = fmin(fmax(sqrt(noise * force), 0.1 * force), 0.5 * force);
    i->first = fmax(SHARE * fabs(i->mean[0] / samples), 5 * i->inner->dac.step);
    return code;
}

// The loop gain at about *hertz, which becomes the frequency with whole cycles in whole
// samples.
static status measure_gain(run_loop *l, injector *i, double *hertz, double complex *gain,
                           fault *f)
{
    const double period = i->inner->period, most = MOST_SINE * i->inner->voltage_limit;
    const double cycles = fmax(CYCLES, ceil(WINDOW * *hertz));
    const double samples = round(cycles / (*hertz * period));
    double complex law = 0, command = 0, before;
    status code = STATUS_OK;
    *hertz = cycles / (samples * period);
    i->turn[0] = 2 * M_PI * cycles / samples;
    i->turn[1] = 2 * M_PI * fmax(1, round(i->awake_hertz * samples * period)) / samples;
    i->amplitude[0] = i->first;
    i->amplitude[1] = 0;
    *gain = complex_of((double)NAN, 0);

    // window after window until the transient is gone; of a noisy one the mean of the
    // later half
    int agreed = 0;
    for (int w = 0; w < MOST_WINDOWS && agreed < 2 && code == STATUS_OK; w++) {
        code = pass_window(l, i, samples, f);
        if (w >= MOST_WINDOWS / 2) {
            law += i->law;
            command += i->command;
        }
        before = *gain;
        *gain = -i->law / i->command;

        // the sine grows until the force swings enough, or shrinks at once
        const double swing = 2 * cabs(i->force) / samples;
        const double factor = fmax(0.1, fmin(3, i->wanted / fmax(swing, 1e-12)));
        const double amplitude = fmin(most, i->amplitude[0] * factor);
        const bool steady = fabs(amplitude - i->amplitude[0]) < 0.2 * i->amplitude[0];
        const bool answers = cabs(*gain) > NOTHING;
        if (steady && cabs(*gain - before) <= AGREE * cabs(*gain)) {
            agreed++;
        } else {
            agreed = 0;
        }
        if (!steady) {
            i->amplitude[0] = amplitude;
        }
        if (steady && !answers && i->amplitude[1] == 0 && isfinite(i->awake)) {
            i->amplitude[1] = i->awake;
            agreed = 0;
        } else if (steady && answers && i->amplitude[1] == 0 &&
                   i->amplitude[0] < i->awake) {
            i->awake = i->amplitude[0];
            i->awake_hertz = *hertz;
        }
    }
    if (agreed < 2 && command != 0) {
        *gain = -law / command;
    }
    return code;
}

// Measures at about a frequency, and puts the point in its place.
static status insert_frequency(run_loop *l, injector *i, double hertz, linear_response *r,
                               fault *f)
{
    double complex gain;
    const status code = measure_gain(l, i, &hertz, &gain, f);
    int at = r->count++;
    for (; at > 0 && r->frequency[at - 1] > 2 * M_PI * hertz; at--) {
        r->frequency[at] = r->frequency[at - 1];
        r->gain[at] = r->gain[at - 1];
    }
    r->frequency[at] = 2 * M_PI * hertz;
    r->gain[at] = gain;
    return code;
}

static status measure_all(run_loop *l, injector *i, linear_response *r, fault *f)
{
    const double highest = 1 / (2 * i->inner->period),
                 lowest = fmin(LOWEST, highest / 10);
    TRY(size_sine(l, i, f));
    for (int k = 0; k < FIRST; k++) {
        TRY(insert_frequency(l, i,
                             lowest * plain_pow(highest / lowest, k / (FIRST - 1.0)), r,
                             f));
    }

    // where size one or a negative real gain lies between two, between
    for (int pass = 0; pass < PASSES; pass++) {
        double middles[MOST_POINTS];
        int wanted = 0;
        for (int k = 0; k + 1 < r->count && r->count + wanted < MOST_POINTS; k++) {
            const double complex a = r->gain[k], b = r->gain[k + 1];
            const bool turns = cimag(a) * cimag(b) < 0 && creal(a + b) < 0;
            if (turns || (cabs(a) - 1) * (cabs(b) - 1) < 0) {
                middles[wanted++] =
                    sqrt(r->frequency[k] * r->frequency[k + 1]) / (2 * M_PI);
            }
        }
        for (int k = 0; k < wanted; k++) {
            TRY(insert_frequency(l, i, middles[k], r, f));
        }
    }
    return STATUS_OK;
}

status linear_inject(const scenario *s, linear_response *r, fault *f)
{
    assert(s->parameters.control.law != LAW_NONE);
    *r = (linear_response){0};
    injector i = {.awake = (double)INFINITY};
    run_loop *l = NULL;
    double *block = calloc(3 * MOST_POINTS, sizeof *block);
    status code;
    if (block != NULL) {
        code = rig_create(&i.inner, &s->parameters, NULL, f);
    } else {
        code = fault_no_memory(f);
    }
    if (code == STATUS_OK && i.inner->withheld) {
        code = fault_set(f, STATUS_NOT_ALLOWED,
                         "the loop of a program or plug-in needs --allow-code");
    }
    if (code == STATUS_OK) {
        // the law as it is called and tuned, but for what goes out
        controller law = *i.inner->law;
        law.memory_size = sizeof(injector *);
        law.start = controller_takes_anything; // the inner one was started with its rig
        law.sample = sample_with_sine;
        if (law.tune != NULL) {
            law.tune = tune_inner_law;
        }
        const loop_options options = {.law = {&law, &i}};
        *r = (linear_response){0, block, (double complex *)(block + MOST_POINTS)};
        code = run_to_end(&l, s, &options, f);
        if (code == STATUS_OK) {
            code = measure_all(l, &i, r, f);
        }
        loop_destroy(l);
    }
    rig_destroy(i.inner);
    if (code != STATUS_OK) {
        free(block);
        *r = (linear_response){0};
    }
    return code;
}

// --- pushes ----------------------------------------------------------------------------

// Whether an impulse at the tip of the kept state loses contact.
static status loses(run_loop *l, const void *kept, double impulse, bool *lost, fault *f)
{
    *lost = false;
    TRY(loop_restore(l, kept, loop_saved_size(l), f));
    const double before = loop_summary(l).separations;
    TRY(loop_push(l, impulse, f));
    TRY(loop_until(l, loop_time(l) + FOLLOWED, f));
    *lost = loop_summary(l).separations > before;
    return STATUS_OK;
}

// The least in one direction, by halves in the logarithm; NaN: none.
static status least_push(run_loop *l, const void *kept, double direction, double *least,
                         fault *f)
{
    double low = plain_log(1e-9), high = plain_log(MOST_PUSHED);
    bool lost, there;
    *least = (double)NAN;
    TRY(loses(l, kept, direction * MOST_PUSHED, &lost, f));
    for (int i = 0; i < PUSHES && lost; i++) {
        const double middle = (low + high) / 2;
        TRY(loses(l, kept, direction * plain_exp(middle), &there, f));
        if (there) {
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
        void *kept = malloc(loop_saved_size(l));
        double away = (double)NAN, against = (double)NAN;
        if (kept == NULL) {
            code = fault_no_memory(f);
        } else {
            loop_save(l, kept);
            code = least_push(l, kept, -1, &away, f);
        }
        if (code == STATUS_OK) {
            code = least_push(l, kept, 1, &against, f);
        }
        if (code == STATUS_OK) {
            *impulse = fmin(away, against); // the other one if one is NaN
        }
        free(kept);
    }
    loop_destroy(l);
    return code;
}

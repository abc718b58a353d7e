// What a run says of its loop: answers to sines in the command, and to pushes.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/run/loop.h"
#include "src/study/linear/linear.h"

// Frequencies of the first pass, and passes that halve the intervals with a crossing.
enum { FIRST = 28, PASSES = 4, MOST_POINTS = 160 };

#define LOWEST      0.5  // [Hz]
#define OF_NYQUIST  0.98 // the highest
#define WINDOW      0.5  // in which a sine is measured, at least [s]
#define CYCLES      3    // at least
#define AGREE       1e-4 // of one window with the two before
#define SHARE       0.02 // of the holding command that the sine begins with
#define SWING       0.1  // of the force that it is to make: laws may sleep where less moves
#define MOST_SINE   0.2  // of the largest command
#define NOTHING     1e-9 // of the command: the law does not answer
#define FOLLOWED    0.5  // after a push [s]
#define MOST_PUSHED 10.0 // [N s]

enum { MOST_WINDOWS = 40, PUSHES = 28 };

static const double pi = 3.14159265358979323846;

// The law with a sine behind it. `inner` holds the law itself, its memory and, of a process, the
// program.
typedef struct injector {
    rig *inner;
    double first, amplitude;            // of the sine, at each frequency first and at present [V]
    double turn;                        // of the sine from sample to sample [rad]
    long sample;                        // since the window began
    double complex law, command, force; // sums over the window
} injector;

static void sample_with_sine(void *memory, const controller_input *in, controller_output *out)
{
    injector *i;
    double s, c;
    memcpy(&i, memory, sizeof i);
    i->inner->law->sample(i->inner->memory, in, out);
    const double answer = out->command;
    inline_sincos(i->turn * (double)i->sample++, &s, &c);
    out->command += i->amplitude * s;
    i->law += answer * complex_of(c, -s);
    i->command += out->command * complex_of(c, -s);
    i->force += in->force * complex_of(c, -s);
}

// The inner law was started with its rig, which was told the same.
static const char *start(void *memory, const controller_setup *setup)
{
    (void)memory;
    (void)setup;
    return NULL;
}

static const char *tune(void *memory, const controller_setup *setup)
{
    injector *i;
    memcpy(&i, memory, sizeof i);
    return i->inner->law->tune(i->inner->memory, setup);
}

// A run that has come to the scenario's end and goes on from there.
static status begin(run_loop **loop, const scenario *s, const loop_options *options, fault *f)
{
    scenario longer = *s; // borrows its script
    longer.parameters.run.duration = 1e4;
    const status code = loop_create(loop, &longer, options, f);
    return code == STATUS_OK ? loop_until(*loop, s->parameters.run.duration, f) : code;
}

// Whether the arm presses, and has not let go since there were so many separations.
static status presses(run_loop *l, double separations, fault *f)
{
    if (loop_row(l).force > 0 && loop_summary(l).separations <= separations) {
        return STATUS_OK;
    }
    return fault_set(f, STATUS_UNSTABLE,
                     "at t = %.4g s the arm does not press on the wall: what happens about rest "
                     "cannot be measured",
                     loop_time(l));
}

// --- sines ------------------------------------------------------------------------------------

// The loop gain at about `*hertz`, which becomes the frequency with whole cycles in whole samples.
static status measure(run_loop *l, injector *i, double *hertz, double complex *gain, double wanted,
                      fault *f)
{
    const double period = i->inner->period, separations = loop_summary(l).separations;
    const double cycles = fmax(CYCLES, ceil(WINDOW * *hertz));
    const double samples = round(cycles / (*hertz * period));
    *hertz = cycles / (samples * period);
    i->turn = 2 * pi * cycles / samples;
    i->amplitude = i->first;
    *gain = complex_of((double)NAN, 0);

    // window after window until the transient is gone
    status code = STATUS_OK;
    double complex before;
    int agreed = 0;
    for (int w = 0; w < MOST_WINDOWS && code == STATUS_OK; w++) {
        i->sample = 0;
        i->law = i->command = i->force = 0;
        while (i->sample < (long)samples && code == STATUS_OK) {
            code = loop_step(l, f);
        }
        code = code == STATUS_OK ? presses(l, separations, f) : code;
        before = *gain;
        *gain = cabs(i->law) > NOTHING * cabs(i->command) ? -i->law / i->command : 0;

        // the sine grows until the force swings enough, or shrinks at once
        const double swing = 2 * cabs(i->force) / samples,
                     most = MOST_SINE * i->inner->voltage_limit;
        const double factor = fmax(0.1, fmin(3, wanted / fmax(swing, 1e-12)));
        const double amplitude = fmin(most, i->amplitude * factor);
        const bool steady = fabs(amplitude - i->amplitude) < 0.2 * i->amplitude;
        agreed = steady && cabs(*gain - before) <= AGREE * cabs(*gain) ? agreed + 1 : 0;
        if (agreed == 2) {
            break;
        }
        i->amplitude = steady ? i->amplitude : amplitude;
    }
    return code;
}

// Puts a point in its place.
static void insert(linear_response *r, double w, double complex gain)
{
    int at = r->count++;
    for (; at > 0 && r->frequency[at - 1] > w; at--) {
        r->frequency[at] = r->frequency[at - 1];
        r->gain[at] = r->gain[at - 1];
    }
    r->frequency[at] = w;
    r->gain[at] = gain;
}

// Whether size one or a negative real gain lies between two points.
static bool crosses(double complex a, double complex b)
{
    return (cabs(a) - 1) * (cabs(b) - 1) < 0 || (cimag(a) * cimag(b) < 0 && creal(a + b) < 0);
}

static status measure_all(run_loop *l, injector *i, double force, linear_response *r, fault *f)
{
    const double highest = OF_NYQUIST / (2 * i->inner->period);
    const double lowest = fmin(LOWEST, highest / 10);
    status code = STATUS_OK;
    for (int k = 0; k < FIRST && code == STATUS_OK; k++) {
        double complex gain;
        double hertz = lowest * plain_pow(highest / lowest, k / (FIRST - 1.0));
        code = measure(l, i, &hertz, &gain, SWING * force, f);
        insert(r, 2 * pi * hertz, gain);
    }

    // where something crosses, between
    for (int pass = 0; pass < PASSES; pass++) {
        const int count = r->count;
        double middles[MOST_POINTS];
        int wanted = 0;
        for (int k = 0; k + 1 < count; k++) {
            if (crosses(r->gain[k], r->gain[k + 1]) && count + wanted < MOST_POINTS) {
                middles[wanted++] = sqrt(r->frequency[k] * r->frequency[k + 1]) / (2 * pi);
            }
        }
        for (int k = 0; k < wanted && code == STATUS_OK; k++) {
            double complex gain;
            code = measure(l, i, &middles[k], &gain, SWING * force, f);
            insert(r, 2 * pi * middles[k], gain);
        }
    }
    return code;
}

status linear_inject(const scenario *s, const linear_arm *arm, linear_response *r, fault *f)
{
    assert(s != NULL && arm != NULL && r != NULL && s->parameters.control.law != LAW_NONE);
    *r = (linear_response){0};
    injector i = {.inner = NULL};
    run_loop *l = NULL;
    double *block = calloc(3 * MOST_POINTS, sizeof *block);
    status code =
        block != NULL ? rig_create(&i.inner, &s->parameters, NULL, f) : fault_no_memory(f);
    if (code == STATUS_OK && i.inner->withheld) {
        code =
            fault_set(f, STATUS_NOT_ALLOWED, "the loop of a program or plug-in needs --allow-code");
    }
    if (code == STATUS_OK) {
        // the law as it is called and tuned, but for what goes out
        controller law = *i.inner->law;
        law.memory_size = sizeof(injector *);
        law.start = start;
        law.sample = sample_with_sine;
        law.tune = law.tune != NULL ? tune : NULL;
        const loop_options options = {.law = {&law, &i}};
        code = begin(&l, s, &options, f);
        code = code == STATUS_OK ? presses(l, HUGE_VAL, f) : code;

        // larger than the steps of the D/A converter
        i.first = fmax(SHARE * fabs(arm->voltage), 5 * i.inner->dac.step);
        *r = (linear_response){0, block, (double complex *)(block + MOST_POINTS)};
        code = code == STATUS_OK ? measure_all(l, &i, arm->force, r, f) : code;
        loop_destroy(l);
    }
    rig_destroy(i.inner);
    if (code != STATUS_OK) {
        free(block);
        *r = (linear_response){0};
    }
    return code;
}

// --- pushes -----------------------------------------------------------------------------------

// Whether an impulse at the tip of the kept state loses contact.
static status loses(run_loop *l, const void *kept, double impulse, bool *lost, fault *f)
{
    status code = loop_restore(l, kept, loop_saved_size(l), f);
    const double before = loop_summary(l).separations;
    code = code == STATUS_OK ? loop_push(l, impulse, f) : code;
    code = code == STATUS_OK ? loop_until(l, loop_time(l) + FOLLOWED, f) : code;
    *lost = code == STATUS_OK && loop_summary(l).separations > before;
    return code;
}

// The least in one direction, by halves in the logarithm; NaN: none.
static status least_push(run_loop *l, const void *kept, double direction, double *least, fault *f)
{
    double low = plain_log(1e-9), high = plain_log(MOST_PUSHED);
    bool lost;
    status code = loses(l, kept, direction * MOST_PUSHED, &lost, f);
    *least = (double)NAN;
    for (int i = 0; i < PUSHES && lost && code == STATUS_OK; i++) {
        bool there;
        const double middle = (low + high) / 2;
        code = loses(l, kept, direction * plain_exp(middle), &there, f);
        *(there ? &high : &low) = middle;
        *least = plain_exp(high);
    }
    return code;
}

status linear_contact_margin(const scenario *s, double *impulse, fault *f)
{
    assert(s != NULL && impulse != NULL);
    run_loop *l = NULL;
    *impulse = (double)NAN;
    status code = begin(&l, s, &(loop_options){.keep_trace = false}, f);
    if (code == STATUS_OK && loop_row(l).force > 0) {
        void *kept = malloc(loop_saved_size(l));
        double away = (double)NAN, against = (double)NAN;
        code = kept != NULL ? STATUS_OK : fault_no_memory(f);
        if (code == STATUS_OK) {
            loop_save(l, kept);
            code = least_push(l, kept, -1, &away, f);
            code = code == STATUS_OK ? least_push(l, kept, 1, &against, f) : code;
            *impulse = fmin(away, against); // the other one if one is NaN
        }
        free(kept);
    }
    loop_destroy(l);
    return code;
}

#include "src/study/follow.h"

#include <complex.h>
#include <math.h>

#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/run/run.h"

const double follow_frequencies[FOLLOW_FREQUENCIES] = {0.2, 0.5, 1, 2, 4, 8, 15, 25};
const char *const follow_laws[FOLLOW_LAWS] = {"hybrid",     "force-pd", "impedance",
                                              "admittance", "touch",    "observer"};

#define SETTLED 3.0 // instant at which impact and transients are over [s]
#define WATCHED 2.0 // least time from then on that is evaluated, in whole periods [s]

// exp(i angle).
static double complex unit_phasor(double angle)
{
    return inline_cos(angle) + (double complex)I * inline_sin(angle);
}

// The complex amplitude of the force at a frequency [Hz], referred to sin(w t): 2 i times
// the mean of force(t) exp(-i w t) over whole periods, by the trapezoidal rule.
static double complex amplitude_of(const trace *t, double frequency, double until)
{
    const double w = 2 * M_PI * frequency;
    double complex sum = 0;
    for (size_t i = 1; i < t->row_count; i++) {
        const sample *a = &t->rows[i - 1], *b = &t->rows[i];
        if (a->time >= SETTLED && b->time <= until) {
            const double complex both = a->force * unit_phasor(-w * a->time) +
                                        b->force * unit_phasor(-w * b->time);
            sum += (b->time - a->time) / 2 * both;
        }
    }
    const double complex twice_i = 2 * unit_phasor(M_PI / 2);
    return twice_i * sum / (until - SETTLED);
}

// Runs a law with a sine in the wall's place or, without `wall`, in the commanded force,
// and finds the force's complex amplitude at its frequency; NaN if the run fails.
static status measure_amplitude(const scenario *s, const char *law, double frequency,
                                bool wall, run_monitor *monitor,
                                double complex *amplitude, fault *f)
{
    const double until = SETTLED + ceil(WATCHED * frequency) / frequency;
    const double force = s->parameters.control.force;
    scenario changed;
    *amplitude = (double)NAN;

    // either the wall moves or the set-point does
    const double wave = wall ? 0 : FOLLOW_WAVE * force;
    const double shaking = wall ? MOTION_SINE : MOTION_NONE;
    const parameter_change changes[] = {
        {PARAMETER_INDEX(control.law), .text = law},
        {PARAMETER_INDEX(run.duration), until},
        {PARAMETER_INDEX(control.force_amplitude), wave},
        {PARAMETER_INDEX(control.force_frequency), frequency},
        {PARAMETER_INDEX(wall.motion), shaking},
        {PARAMETER_INDEX(wall.motion_amplitude), FOLLOW_WALL},
        {PARAMETER_INDEX(wall.motion_frequency), frequency},
    };
    TRY(scenario_with(s, changes, sizeof changes / sizeof *changes, &changed, f));

    // a law that fails here says nothing of the others
    SCOPED(run_finish) run_result result;
    const run_options options = {.keep_trace = true, .monitor = monitor};
    const status code = run_scenario_with(&changed, &options, &result);
    if (code == STATUS_OK) {
        *amplitude = amplitude_of(&result.trace, frequency, until);
    }
    if (code == STATUS_STOPPED || code == STATUS_NO_MEMORY) {
        return fault_set(f, code, "%s", status_text(code));
    }
    return STATUS_OK;
}

// The answer to a wave of the set-point as gain, phase and error.
static follow_point point_of(double frequency, double complex answer)
{
    double phase = (double)NAN;
    if (!isnan(creal(answer))) {
        phase = plain_atan2(cimag(answer), creal(answer));
    }
    return (follow_point){.frequency = frequency,
                          .gain = cabs(answer),
                          .phase = phase * 180 / M_PI,
                          .error = cabs(1 - answer),
                          .shaken = (double)NAN};
}

status follow_study_compute(const scenario *s, run_monitor *monitor, follow_study *study,
                            fault *f)
{
    *study = (follow_study){0};
    const parameters *p = &s->parameters;
    const char *lacks = NULL;
    if (p->control.law == LAW_NONE) {
        lacks = "control law";
    } else if (p->wall.kind == WALL_NONE) {
        lacks = "wall";
    } else if (!(p->control.force > 0)) {
        lacks = "commanded force";
    }
    FAULT_IF(
        lacks != NULL, f, STATUS_BAD_SCENARIO,
        "%s has no %s: expected a control law that presses on a wall with control.force",
        s->name, lacks);
    study->later = p->control.delay + (0.5 + p->control.delay_periods) / p->control.rate;
    for (int i = 0; i < FOLLOW_LAWS * FOLLOW_FREQUENCIES; i++) {
        const int k = i % FOLLOW_FREQUENCIES;
        study->points[i / FOLLOW_FREQUENCIES][k] =
            point_of(follow_frequencies[k], (double)NAN);
    }

    // two runs for each law and frequency: with a wave of the commanded force, then with
    // a wall that moves
    double phase_before = 0;
    for (; study->done < FOLLOW_RUNS; study->done++) {
        const int law = study->done / 2 / FOLLOW_FREQUENCIES,
                  k = study->done / 2 % FOLLOW_FREQUENCIES;
        const bool wall = study->done % 2 != 0;
        const double frequency = follow_frequencies[k];
        follow_point *point = &study->points[law][k];
        double complex amplitude;
        TRY(measure_amplitude(s, follow_laws[law], frequency, wall, monitor, &amplitude,
                              f));
        if (wall) {
            point->shaken = cabs(amplitude) / FOLLOW_WALL;
        } else {
            *point = point_of(frequency, amplitude / (FOLLOW_WAVE * p->control.force));
        }

        // the phase falls with frequency: one that jumps up has passed -180 degrees
        if (k > 0 && point->phase > phase_before + 180) {
            point->phase -= 360;
        }
        phase_before = point->phase;
        run_monitor_count(monitor);
    }
    return STATUS_OK;
}

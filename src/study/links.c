#include "src/study/links.h"

#include <math.h>
#include <stdlib.h>

#include "src/arm/modes.h"
#include "src/base/plain_math.h"
#include "src/run/run.h"
#include "src/study/convergence.h"

const int links_numbers[LINKS_LENGTHS] = {2, 4, 8, 16, 32, 64};

// time after first contact in which the largest values are looked for [s]
#define SENSOR_WINDOW 0.02
#define MOMENTUM_WINDOW                                                                  \
    0.002          // time after first contact over which momentum is summed [s]
#define PIECE 1e-5 // longest piece of a step whose ends give the force [s]

enum { SENSORS = 3 };
static const double sensor_constants[SENSORS] = {0.5e-3, 1e-3, 2e-3}; // [s]

enum row_index {
    IMPULSE,
    PEAK,
    MOMENTUM,
    SENSED,
    CONTACT_TIME = SENSED + SENSORS,
    STEADY_FORCE,
    FREE,
    PINNED,
    COMPLIANCE
};

static const links_row blank_rows[LINKS_QUANTITIES] = {
    [IMPULSE] = {.key = "first_impulse_Ns", .label = "first impulse", .unit = "N s"},
    [PEAK] = {.key = "peak_20ms_N", .label = "largest force", .unit = "N"},
    [MOMENTUM] = {.key = "momentum_2ms_Ns", .label = "momentum of 2 ms", .unit = "N s"},
    [SENSED] = {.key = "sensed_500us_N", .label = "sensor of 0.5 ms", .unit = "N"},
    [SENSED + 1] = {.key = "sensed_1ms_N", .label = "sensor of 1 ms", .unit = "N"},
    [SENSED + 2] = {.key = "sensed_2ms_N", .label = "sensor of 2 ms", .unit = "N"},
    [CONTACT_TIME] = {.key = "first_pulse_s", .label = "contact time", .unit = "s"},
    [STEADY_FORCE] = {.key = "steady_force_N", .label = "steady force", .unit = "N"},
    [FREE] = {.key = "frequency_tip_free_Hz",
              .label = "frequency, tip free",
              .unit = "Hz"},
    [PINNED] = {.key = "frequency_tip_pinned_Hz",
                .label = "frequency, tip pinned",
                .unit = "Hz"},
    [COMPLIANCE] = {.key = "tip_compliance_m_per_N",
                    .label = "compliance",
                    .unit = "m/N"},
};

// --- the blow --------------------------------------------------------------------------

// The first milliseconds of a contact, and what force sensors read of them.
typedef struct blow {
    double touch;           // first contact [s]
    double speed, impulse;  // of the first impact [m/s], [N s]
    double momentum;        // impulses and forces over MOMENTUM_WINDOW [N s]
    double peak;            // largest force, impulses excluded [N]
    double sensed[SENSORS]; // largest values [N]
} blow;

// Adds an impact: its impulse counts in the momentum unless the steps' forces contain it.
static void take_impulse(blow *b, const event *e)
{
    const double impulse = e->delivered_by_step ? 0 : e->impulse;
    if (e->time == b->touch) {
        b->speed = e->speed;
        b->impulse = e->impulse;
    }
    if (e->time <= b->touch + MOMENTUM_WINDOW) {
        b->momentum += impulse;
    }
}

// Adds the force over a step, from the touch to the end of the window, piece by piece.
// Within the step the force is the parabola first + slope s + curve s^2, s from 0 to 1,
// whose mean from s to u is first + slope (s + u)/2 + curve (s^2 + s u + u^2)/3.
static void add_force(blow *b, const force_step *step)
{
    const step_parabola p = step_parabola_of(step);
    const double length = step->end - step->start;
    const double momentum_end = b->touch + MOMENTUM_WINDOW;
    const double end = fmin(step->end, b->touch + SENSOR_WINDOW);
    double from = fmax(step->start, b->touch), to;
    for (; from < end; from = to) {
        to = fmin(from + PIECE, end);
        if (from < momentum_end) {
            to = fmin(to, momentum_end);
        }
        const double s = (from - step->start) / length, u = (to - step->start) / length;
        const double first = p.first + s * (p.slope + s * p.curve);
        const double last = p.first + u * (p.slope + u * p.curve);
        const double mean =
            p.first + p.slope * (s + u) / 2 + p.curve * (s * s + s * u + u * u) / 3;
        if (to <= momentum_end) {
            b->momentum += (to - from) * mean;
        }
        b->peak = fmax(b->peak, fmax(first, last));
    }
}

// Goes through the forces and impacts of a run from its first contact to the end of the
// window.
static blow blow_of(const run_result *result)
{
    const shared_array *h = &result->history.forces;
    const trace *t = &result->trace;
    blow b = {.touch = result->summary.first_contact_s};
    size_t next = 0;
    for (int k = 0; k < SENSORS; k++) {
        b.sensed[k] =
            force_largest_sensed(result, sensor_constants[k], b.touch + SENSOR_WINDOW);
    }
    for (size_t i = 0; i < h->count; i++) {
        const force_step *step = &force_steps(h)[i];
        if (step->start >= b.touch + SENSOR_WINDOW) {
            break;
        }
        for (; next < t->event_count && t->events[next].time <= step->start; next++) {
            if (t->events[next].kind == EVENT_IMPACT) {
                take_impulse(&b, &t->events[next]);
            }
        }
        add_force(&b, step);
    }
    return b;
}

// --- one number of links ---------------------------------------------------------------

// The lowest frequency of small vibrations with the hub held [Hz]; NaN if there is none.
static status first_frequency(const arm *a, tip_end tip, double *frequency, fault *f)
{
    const size_t dof = (size_t)a->dof;
    SCOPED(free_kept) double *work = malloc((dof + dof * dof) * sizeof *work);
    int count = 0;
    if (work == NULL) {
        return fault_no_memory(f);
    }
    const status code = modes_compute(a, HUB_LOCKED, tip, &count, work, work + dof);
    if (code == STATUS_OK && count > 0) {
        *frequency = work[0] / (2 * M_PI);
    } else {
        *frequency = (double)NAN;
    }
    if (code == STATUS_OK) {
        return code;
    }
    return fault_set(f, code, "%s", status_text(code));
}

// Deflection of the tip under a unit force, the hub held: every joint bends by the moment
// there, the distance to the tip, over its stiffness [m/N].
static double tip_compliance(const parameters *p)
{
    double lengths[PARAMETER_LINKS_MOST], stiffness[PARAMETER_LINKS_MOST], lever = 0,
                                                                           sum = 0;
    parameters_link_lengths(&p->arm, lengths);
    parameters_joint_stiffness(&p->arm, stiffness);
    for (int k = p->arm.links - 1; k >= 0; k--) {
        lever += lengths[k];
        // without stiffness the first joint is none: hub and first link are one body
        if (k > 0 || stiffness[0] > 0) {
            sum += lever * lever / stiffness[k];
        }
    }
    return sum;
}

// Computes column i of the study, the chain with links_numbers[i] links; *speed receives
// the tip's speed at the first impact [m/s].
static status compute_column(const scenario *s, int i, run_monitor *monitor,
                             links_study *study, double *speed, fault *f)
{
    links_row *rows = study->rows;
    scenario changed;
    const parameter_change links = {PARAMETER_INDEX(arm.links), links_numbers[i]};
    TRY(scenario_with(s, &links, 1, &changed, f));

    // the run, and the blow at its first contact
    SCOPED(run_finish) run_result result;
    const run_options options = {.monitor = monitor, .keep_forces = true};
    const status code = run_scenario_with(&changed, &options, &result);
    if (code != STATUS_OK) {
        return fault_set_at(f, code, result.summary.path, "with %d links: %.700s",
                            links_numbers[i], result.summary.message);
    }
    FAULT_IF(isnan(result.summary.first_contact_s), f, STATUS_BAD_SCENARIO,
             "%s: with %d links there is no contact within %g s", s->name,
             links_numbers[i], s->parameters.run.duration);
    const blow b = blow_of(&result);
    *speed = b.speed;
    rows[IMPULSE].value[i] = b.impulse;
    rows[PEAK].value[i] = b.peak;
    rows[MOMENTUM].value[i] = b.momentum;
    for (int k = 0; k < SENSORS; k++) {
        rows[SENSED + k].value[i] = b.sensed[k];
    }
    rows[CONTACT_TIME].value[i] = result.summary.first_pulse_s;
    rows[STEADY_FORCE].value[i] = result.summary.steady_force_N;

    // small vibrations and statics
    arm a;
    arm_init(&a, &changed.parameters);
    rows[COMPLIANCE].value[i] = tip_compliance(&changed.parameters);
    TRY(first_frequency(&a, TIP_FREE, &rows[FREE].value[i], f));
    return first_frequency(&a, TIP_PINNED, &rows[PINNED].value[i], f);
}

// --- the beam --------------------------------------------------------------------------

#define DAWSON_LARGEST 0.5410442246351817 // of Dawson's integral, at 0.9241388730

// The constant K of a beam whose tip is stopped at once: force K/sqrt(t), momentum 2 K
// sqrt(t) [N s^(1/2)].
static double beam_constant(const parameters *p, double speed)
{
    double bending = p->arm.k2 * p->arm.length / 2, density = p->arm.mass / p->arm.length;
    return speed * plain_pow(bending, 0.25) * plain_pow(density, 0.75) / sqrt(2 * M_PI);
}

double links_beam_momentum(const parameters *p, double speed, double time)
{
    return 2 * beam_constant(p, speed) * sqrt(time);
}

double links_beam_sensed(const parameters *p, double speed, double time_constant)
{
    return 2 * beam_constant(p, speed) / sqrt(time_constant) * DAWSON_LARGEST;
}

// --- limits ----------------------------------------------------------------------------

// Extrapolates to infinitely many links N by Richardson's method: the error falls as
// N^-p, and N doubles, so that the limit is the last value plus the last difference over
// 2^p - 1. The error of the limit is estimated by that correction.
static void extrapolate(links_row *row)
{
    const double coarse = row->value[LINKS_LENGTHS - 3],
                 middle = row->value[LINKS_LENGTHS - 2],
                 fine = row->value[LINKS_LENGTHS - 1];
    row->order = observed_order(coarse, middle, fine);
    row->limit = fine + (fine - middle) / (plain_pow(2, row->order) - 1);
    row->error = fabs(row->limit - fine);

    // a limit whose error is as large as itself is none
    if (!(row->error < fabs(row->limit))) {
        row->limit = row->error = (double)NAN;
    }

    // values that do not change have reached their limit
    if (fabs(fine - middle) <= 1e-9 * fabs(fine)) {
        row->limit = fine;
        row->error = fabs(fine - middle);
    }
}

// Fills in the numbers of the uniform beam with the arm's mass, length and bending
// stiffness, stopped at the tip from `speed` [m/s]. An arm with a tip mass or unlike
// links has none.
static void compute_beam(const parameters *p, double speed, links_row *rows)
{
    const double length = p->arm.length, bending = p->arm.k2 * length / 2;
    const double rate =
        sqrt(bending / (p->arm.mass * length * length * length)) / (2 * M_PI);
    if (p->arm.tip_mass > 0 || !parameters_even_links(&p->arm)) {
        return;
    }
    if (p->wall.contact == WALL_RIGID && p->arm.damping_ratio == 0 &&
        p->arm.joint_damping[0] == '\0') {
        // the blow's closed form is that of a beam without damping which the wall stops
        // at once
        rows[MOMENTUM].beam = links_beam_momentum(p, speed, MOMENTUM_WINDOW);
        for (int k = 0; k < SENSORS; k++) {
            rows[SENSED + k].beam = links_beam_sensed(p, speed, sensor_constants[k]);
        }
    }
    rows[FREE].beam = 1.8751040687119611 * 1.8751040687119611 * rate;
    rows[PINNED].beam = 3.9266023120479187 * 3.9266023120479187 * rate;
    rows[COMPLIANCE].beam = length * length * length / (3 * bending);
}

void links_judge(links_row *row)
{
    // values that have no limit told may agree with the last one: three at least
    const bool known = !isnan(row->beam) || !isnan(row->limit);
    int i = LINKS_LENGTHS - 1;
    if (known) {
        row->aim = row->limit;
    } else {
        row->aim = row->value[i];
    }
    if (!isnan(row->beam)) {
        row->aim = row->beam;
    }
    row->enough = 0;
    row->off = 0;
    for (; i >= 0; i--) {
        const double off = fabs(row->value[i] - row->aim) / fabs(row->aim);
        if (!(off <= LINKS_ENOUGH)) {
            break;
        }
        row->off = fmax(row->off, off);
        if (known || i <= LINKS_LENGTHS - 3) {
            row->enough = links_numbers[i];
        } else {
            row->enough = 0;
        }
    }
}

status links_study_compute(const scenario *s, run_monitor *monitor, links_study *study,
                           fault *f)
{
    double speed = (double)NAN;
    *study = (links_study){0};
    FAULT_IF(s->parameters.arm.model == ARM_PRINTED, f, STATUS_BAD_SCENARIO,
             "%s: the printed model has two links only, expected arm.model = corrected",
             s->name);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        study->rows[k] = blank_rows[k];
        study->rows[k].order = study->rows[k].limit = study->rows[k].error = (double)NAN;
        study->rows[k].beam = (double)NAN;
        for (int i = 0; i < LINKS_LENGTHS; i++) {
            study->rows[k].value[i] = (double)NAN;
        }
    }

    for (int i = 0; i < LINKS_LENGTHS; i++) {
        study->links[i] = links_numbers[i];
        TRY(compute_column(s, i, monitor, study, &speed, f));
        study->count++;
        run_monitor_count(monitor);
    }

    // the beam that is struck as fast as the chain with the most links
    compute_beam(&s->parameters, speed, study->rows);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        extrapolate(&study->rows[k]);
        links_judge(&study->rows[k]);
    }
    return STATUS_OK;
}

#include "src/study/links.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/plain_math.h"
#include "src/arm/modes.h"
#include "src/run/run.h"
#include "src/study/convergence.h"
#include "src/study/sensor_view.h"

const int links_numbers[LINKS_LENGTHS] = {2, 4, 8, 16, 32, 64};

enum row_index { MOMENTUM, SENSED, CONTACT_TIME, STEADY_FORCE, FREE, PINNED, COMPLIANCE };

static const links_row blank_rows[LINKS_QUANTITIES] = {
    [MOMENTUM] = {.key = "momentum_2ms_Ns", .label = "momentum of 2 ms", .unit = "N s"},
    [SENSED] = {.key = "sensed_1ms_N", .label = "sensor of 1 ms", .unit = "N"},
    [CONTACT_TIME] = {.key = "first_pulse_s", .label = "contact time", .unit = "s"},
    [STEADY_FORCE] = {.key = "steady_force_N", .label = "steady force", .unit = "N"},
    [FREE] = {.key = "frequency_tip_free_Hz", .label = "frequency, tip free", .unit = "Hz"},
    [PINNED] = {.key = "frequency_tip_pinned_Hz", .label = "frequency, tip pinned", .unit = "Hz"},
    [COMPLIANCE] = {.key = "tip_compliance_m_per_N", .label = "compliance", .unit = "m/N"},
};

// --- one number of links --------------------------------------------------------------------

// The first frequency with the hub held [Hz].
static status first_frequency(const arm *a, tip_end tip, double *frequency, fault *f)
{
    const size_t dof = (size_t)a->dof;
    double *work = malloc((dof + dof * dof) * sizeof *work);
    int count = 0;
    if (work == NULL) {
        return fault_no_memory(f);
    }
    status code = modes_compute(a, HUB_LOCKED, tip, &count, work, work + dof);
    *frequency = code == STATUS_OK && count > 0 ? work[0] / (2 * M_PI) : (double)NAN;
    free(work);
    return code == STATUS_OK ? code : fault_set(f, code, "%s", status_text(code));
}

// Deflection of the tip under a unit force, the hub held: every joint bends by the moment there,
// the distance to the tip, over its stiffness [m/N].
static double tip_compliance(const parameters *p)
{
    double lengths[PARAMETER_LINKS_MOST], stiffness[PARAMETER_LINKS_MOST], lever = 0, sum = 0;
    parameters_link_lengths(&p->arm, lengths);
    parameters_joint_stiffness(&p->arm, stiffness);
    for (int k = p->arm.links - 1; k >= 0; k--) {
        lever += lengths[k];
        // the first joint is none where hub and first link are one body
        sum += k > 0 || stiffness[0] > 0 ? lever * lever / stiffness[k] : 0;
    }
    return sum;
}

// The scenario with a number of links.
static status with_links(const scenario *s, int links, scenario *changed, fault *f)
{
    parameters p = s->parameters;
    *changed = *s;
    status code = parameter_set_number(&p, PARAMETER_INDEX(arm.links), links, f);
    return code == STATUS_OK ? scenario_take_parameters(changed, &p, f) : code;
}

// Column i of the study; *speed is that of the blow [m/s].
static status compute_column(const scenario *s, int i, run_monitor *monitor, links_study *study,
                             double *speed, fault *f)
{
    links_row *rows = study->rows;
    sensor_view view;
    scenario changed;
    status code = with_links(s, links_numbers[i], &changed, f);
    if (code == STATUS_OK) {
        code = sensor_view_compute(s, links_numbers[i], monitor, &view, f);
    }
    if (code != STATUS_OK) {
        return code;
    }
    *speed = view.speed;
    rows[MOMENTUM].value[i] = view.momentum;
    rows[SENSED].value[i] = view.sensed[1];

    // the whole run; one that failed has what it has until then, which is not its end
    run_result result;
    const run_options options = {.monitor = monitor};
    code = run_scenario_with(&changed, &options, &result);
    if (code == STATUS_OK) {
        rows[CONTACT_TIME].value[i] = result.summary.first_pulse_s;
        rows[STEADY_FORCE].value[i] = result.summary.steady_force_N;
    } else {
        fault_set_at(f, code, result.summary.path, "with %d links: %.700s", links_numbers[i],
                     result.summary.message);
    }
    run_finish(&result);
    if (code != STATUS_OK) {
        return code;
    }

    // small vibrations and statics
    arm a;
    arm_init(&a, &changed.parameters);
    code = first_frequency(&a, TIP_FREE, &rows[FREE].value[i], f);
    if (code == STATUS_OK) {
        code = first_frequency(&a, TIP_PINNED, &rows[PINNED].value[i], f);
    }
    rows[COMPLIANCE].value[i] = tip_compliance(&changed.parameters);
    return code;
}

// --- limits ---------------------------------------------------------------------------------

// Richardson's limit of values whose error falls as N^-p, N doubling: the last difference again
// over 2^p - 1. What it may be off is that step itself.
static void extrapolate(links_row *row)
{
    const double coarse = row->value[LINKS_LENGTHS - 3], middle = row->value[LINKS_LENGTHS - 2],
                 fine = row->value[LINKS_LENGTHS - 1];
    row->order = observed_order(coarse, middle, fine);
    row->limit = fine + (fine - middle) / (plain_pow(2, row->order) - 1);
    row->error = fabs(row->limit - fine);

    // one of which not even the sign is sure is none
    if (!(row->error < fabs(row->limit))) {
        row->limit = row->error = (double)NAN;
    }

    // values that no longer change have arrived
    if (fabs(fine - middle) <= 1e-9 * fabs(fine)) {
        row->limit = fine;
        row->error = fabs(fine - middle);
    }
}

// The beam with the arm's mass, length and bending stiffness, struck with `speed` [m/s].
static void compute_beam(const parameters *p, double speed, links_row *rows)
{
    const double length = p->arm.length, bending = p->arm.k2 * length / 2;
    const double rate = sqrt(bending / (p->arm.mass * length * length * length)) / (2 * M_PI);
    if (p->arm.tip_mass > 0 || !parameters_even_links(&p->arm)) {
        return;
    }
    rows[MOMENTUM].beam = sensor_beam_momentum(p, speed, MOMENTUM_WINDOW);
    rows[SENSED].beam = sensor_beam_peak(p, speed, sensor_constants[1]);
    rows[FREE].beam = 1.8751040687119611 * 1.8751040687119611 * rate;
    rows[PINNED].beam = 3.9266023120479187 * 3.9266023120479187 * rate;
    rows[COMPLIANCE].beam = length * length * length / (3 * bending);

    // the blow's closed form is that of a beam without damping which the wall stops at once
    if (p->wall.contact != WALL_RIGID || p->arm.damping_ratio > 0) {
        rows[MOMENTUM].beam = rows[SENSED].beam = (double)NAN;
    }
}

int links_enough(const links_row *row)
{
    assert(row != NULL);
    const double aim = isnan(row->beam) ? row->limit : row->beam;
    int enough = 0;
    for (int i = LINKS_LENGTHS - 1; i >= 0; i--) {
        if (!(fabs(row->value[i] - aim) <= LINKS_ENOUGH * fabs(aim))) {
            break;
        }
        enough = links_numbers[i];
    }
    return enough;
}

status links_study_compute(const scenario *s, run_monitor *monitor, links_study *study, fault *f)
{
    assert(s != NULL && study != NULL);
    double speed = (double)NAN;
    *study = (links_study){0};
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
        status code = compute_column(s, i, monitor, study, &speed, f);
        if (code != STATUS_OK) {
            return code;
        }
        study->count++;
        run_monitor_count(monitor);
    }

    // the beam that is struck as fast as the chain with the most links
    compute_beam(&s->parameters, speed, study->rows);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        extrapolate(&study->rows[k]);
        study->rows[k].enough = links_enough(&study->rows[k]);
    }
    return STATUS_OK;
}

#include "src/study/thesis_tables.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/run/run.h"
#include "src/predict/predict.h"
#include "src/thesis/printed_algorithm.h"
#include "src/base/instant.h"

// The simulation's row of the printed model is the largest force within this time of
// first contact, the first pulse and, with the nominal spring, the bounces that belong to
// it [s].
#define PRINTED_WINDOW 0.12
// Long enough for every cell's first pulse [s].
#define DURATION 1.5

enum { STIFFNESSES = 3, MODELS = 2, QUANTITIES = 5 };

enum quantity {
    FORCE_ENERGY,
    FORCE_DYNAMICS,
    FORCE_SIMULATION,
    DELAY_DYNAMICS,
    DELAY_SIMULATION
};

static const char *const quantity_names[QUANTITIES] = {"max_force_energy",
                                                       "max_force_dynamics",
                                                       "max_force_simulation",
                                                       "delay_dynamics",
                                                       "delay_simulation"};

static const double voltages[TABLE_VOLTAGES] = {1, 2, 5, 10};

typedef struct thesis_table {
    const char *name;
    double k2_factor;
    double printed[QUANTITIES][TABLE_VOLTAGES]; // forces [N], delays [s]
} thesis_table;

static const thesis_table thesis[STIFFNESSES] = {
    {"4.1",
     100,
     {{23.93, 35.87, 58.41, 82.92},
      {17.92, 27.36, 46.12, 67.76},
      {17.44, 26.63, 44.28, 65.36},
      {0.005, 0.005, 0.006, 0.006},
      {0.005, 0.005, 0.005, 0.005}}},
    {"4.2",
     10,
     {{7.26, 10.79, 17.32, 23.56},
      {5.82, 9.18, 16.46, 23.23},
      {5.63, 8.72, 14.73, 22.75},
      {0.018, 0.019, 0.018, 0.020},
      {0.016, 0.015, 0.015, 0.015}}},
    {"4.3",
     1,
     {{2.04, 2.95, 4.72, 4.73},
      {2.05, 3.45, 6.89, 8.57},
      {1.84, 2.95, 5.22, 7.43},
      {0.062, 0.063, 0.060, 0.109},
      {0.048, 0.047, 0.044, 0.033}}},
};

// Asserts that a call has succeeded which cannot fail with the thesis's numbers.
static void sure(status code)
{
    assert(code == STATUS_OK);
    (void)code;
}

// The results of the simulation of one cell.
typedef struct cell {
    bool touched;
    three_body_state at_touch; // just before contact
    double peak;               // [N], NaN where there is none
    double delay;              // of the peak after contact [s]
} cell;

// Runs the printed model until its first pulse is over, which it comes to in each cell:
// the state of the step before contact, and the largest force after it.
static void simulate_printed(const parameters *p, cell *c)
{
    printed_motion m;
    double first_contact = 0, since = 0; // [s]
    printed_motion_start(&m, p);
    while (!instant_after(since, PRINTED_WINDOW)) {
        const printed_row previous = m.row;
        sure(printed_motion_step(&m, NULL));
        assert(!printed_motion_ended(&m));

        // contact begins
        if (m.row.contact && !c->touched) {
            c->touched = true;
            first_contact = m.row.time;
            memcpy(c->at_touch.angle, previous.angle, sizeof c->at_touch.angle);
            memcpy(c->at_touch.velocity, previous.velocity, sizeof c->at_touch.velocity);
        }
        if (!c->touched) {
            continue;
        }

        // the first pulse
        since = m.row.time - first_contact;
        if (!instant_after(since, PRINTED_WINDOW) && m.row.force > 0 &&
            !(m.row.force <= c->peak)) {
            c->peak = m.row.force;
            c->delay = since;
        }
    }
}

// Runs the corrected model: the state just before the first impact, and the first pulse.
static status simulate_corrected(const parameters *p, cell *c, fault *f)
{
    char name[] = "tables";
    scenario s = {
        .name = name, .file = name, .title = name, .description = name, .parameters = *p};
    SCOPED(run_finish) run_result result;
    if (run_scenario(&s, true, &result) != STATUS_OK) {
        return summary_fault(&result.summary, f);
    }
    c->touched = true;
    c->at_touch = row_bodies(row_before_landing(&result));
    c->peak = result.summary.first_pulse_peak_N;
    c->delay = result.summary.first_pulse_time_to_peak_s;
    return STATUS_OK;
}

// Computes the five quantities of one cell; NaN where one does not occur.
static status compute_cell(const parameters *p, double value[QUANTITIES], fault *f)
{
    cell c = {.touched = false, .peak = (double)NAN, .delay = (double)NAN};
    prediction energy, dynamics;
    for (int i = 0; i < QUANTITIES; i++) {
        value[i] = (double)NAN;
    }

    // the simulation, and where it met the wall
    if (p->arm.model == ARM_PRINTED) {
        simulate_printed(p, &c);
    } else {
        TRY(simulate_corrected(p, &c, f));
    }
    assert(c.touched);
    value[FORCE_SIMULATION] = c.peak;
    value[DELAY_SIMULATION] = c.delay;

    // the predictors at the same state, for which they have an answer
    sure(predict_energy(p, &c.at_touch, &energy, NULL));
    sure(predict_impact_dynamics(p, &c.at_touch, &dynamics, NULL));
    if (energy.holds) {
        value[FORCE_ENERGY] = energy.force;
    }
    if (dynamics.holds) {
        value[FORCE_DYNAMICS] = dynamics.force;
        value[DELAY_DYNAMICS] = dynamics.delay;
    }
    return STATUS_OK;
}

// Computes one table with one model: a row for each quantity.
static status compute_table(const parameters *defaults, const thesis_table *source,
                            const char *model, table_row *rows, fault *f)
{
    for (int i = 0; i < QUANTITIES; i++) {
        rows[i] = (table_row){.table = source->name,
                              .k2_factor = source->k2_factor,
                              .model = model,
                              .quantity = quantity_names[i]};
        memcpy(rows[i].printed, source->printed[i], sizeof rows[i].printed);
        for (int v = 0; v < TABLE_VOLTAGES; v++) {
            rows[i].computed[v] = (double)NAN;
        }
    }

    // a cell for each voltage
    for (int v = 0; v < TABLE_VOLTAGES; v++) {
        parameters p = *defaults;
        double value[QUANTITIES];
        p.arm.k2 *= source->k2_factor;
        p.motor.voltage = voltages[v];
        p.run.duration = DURATION;

        fault why = {.text = ""};
        status result = compute_cell(&p, value, &why);
        if (result != STATUS_OK) {
            return fault_set_at(f, result, why.path, "Table %s, %s model, %g V: %.900s",
                                source->name, model, voltages[v], why.text);
        }
        for (int i = 0; i < QUANTITIES; i++) {
            rows[i].computed[v] = value[i];
        }
    }
    return STATUS_OK;
}

// The defaults of a model, which resolve.
static void take_defaults(parameters *p, arm_model_kind kind)
{
    parameters_defaults(p, kind);
    sure(parameters_resolve(p, NULL));
}

status tables_compute(thesis_tables *t, fault *f)
{
    static const struct {
        arm_model_kind kind;
        const char *name;
    } models[MODELS] = {{ARM_PRINTED, "printed"}, {ARM_CORRECTED, "corrected"}};
    memset(t, 0, sizeof *t);
    memcpy(t->voltage, voltages, sizeof t->voltage);

    // printed and corrected model side by side for each stiffness
    for (int k = 0; k < STIFFNESSES; k++) {
        for (int m = 0; m < MODELS; m++) {
            parameters p;
            take_defaults(&p, models[m].kind);
            t->row_count += QUANTITIES;
            TRY(compute_table(&p, &thesis[k], models[m].name,
                              t->rows + t->row_count - QUANTITIES, f));
        }
    }
    return STATUS_OK;
}

// Adds a row like `from` to the fitted table, with the computed values times `scale` plus
// `shift`.
static void add_fitted_row(thesis_tables *t, const table_row *from, double scale,
                           double shift)
{
    table_row *row = &t->rows[t->row_count++];
    *row = *from;
    row->model = "fitted";
    for (int v = 0; v < TABLE_VOLTAGES; v++) {
        row->computed[v] = scale * from->computed[v] + shift;
    }
}

void tables_compute_fitted(thesis_tables *t)
{
    // a random search over 700 sets ended here
    static const struct {
        const char *path, *value;
    } fitted[] = {
        {"arm.k1", "82.36"},
        {"arm.link_inertia", "4.2e-7"},
        {"arm.hub_inertia", "1.078e-3"},
        {"motor.stiction", "0.031"},
        {"motor.back_emf", "2.107"},
        {"printed.feed_newmark_acceleration", "true"},
        {"printed.newton_iterations", "3"},
    };
    memset(t, 0, sizeof *t);
    memcpy(t->voltage, voltages, sizeof t->voltage);

    // the model as it is, and with the set
    parameters printed, set;
    take_defaults(&printed, ARM_PRINTED);
    parameters_defaults(&set, ARM_PRINTED);
    for (size_t i = 0; i < sizeof fitted / sizeof fitted[0]; i++) {
        sure(parameter_set_text(&set, parameter_index(fitted[i].path), fitted[i].value,
                                NULL));
    }
    sure(parameters_resolve(&set, NULL));

    for (int k = 0; k < STIFFNESSES; k++) {
        table_row as_printed[QUANTITIES], with_set[QUANTITIES];
        sure(compute_table(&printed, &thesis[k], "printed", as_printed, NULL));
        sure(compute_table(&set, &thesis[k], "fitted", with_set, NULL));
        add_fitted_row(t, &with_set[FORCE_SIMULATION], 1, 0);
        add_fitted_row(t, &as_printed[DELAY_DYNAMICS], sqrt(3) / 2, 0);
        add_fitted_row(t, &with_set[DELAY_SIMULATION], 1, set.method.step);
    }
}

bool tables_printed(const char *table, const char *quantity, double *values)
{
    for (int t = 0; t < STIFFNESSES; t++) {
        for (int q = 0; q < QUANTITIES; q++) {
            if (strcmp(thesis[t].name, table) == 0 &&
                strcmp(quantity_names[q], quantity) == 0) {
                memcpy(values, thesis[t].printed[q], sizeof thesis[t].printed[q]);
                return true;
            }
        }
    }
    return false;
}

double tables_mean_error(const thesis_tables *t, const char *model, const char *quantity)
{
    double sum = 0;
    int count = 0;
    for (int r = 0; r < t->row_count; r++) {
        const table_row *row = &t->rows[r];
        if (strcmp(row->model, model) != 0 || strcmp(row->quantity, quantity) != 0) {
            continue;
        }

        for (int v = 0; v < TABLE_VOLTAGES; v++) {
            if (isfinite(row->computed[v])) {
                sum += fabs(row->computed[v] / row->printed[v] - 1);
                count++;
            }
        }
    }
    if (count > 0) {
        return sum / count;
    }
    return (double)NAN;
}

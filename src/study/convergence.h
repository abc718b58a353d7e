// How results depend on the time step or on the tolerance: the convergence panel of a
// scenario, and error against cost of the methods of time integration.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

enum { PANEL_STEPS = 3, PANEL_ROWS = 16 };

// A quantity of the summary at steps h, h/2, h/4 or at tolerances t, t/10, t/100.
typedef struct convergence_row {
    const char *key; // of summary_table, "first_contact_s"
    double value[PANEL_STEPS];
    double order;  // observed, of steps; NaN where it cannot be told
    double digits; // shared by the first and the last value, of tolerances; NaN else
} convergence_row;

typedef struct convergence_panel {
    bool of_tolerance;           // what differs: method.tolerance, else method.step
    double setting[PANEL_STEPS]; // its values [-] or [s]
    convergence_row rows[PANEL_ROWS];
    int row_count;
    int done; // settings that were run to their end, the first ones
} convergence_panel;

// log2 of the ratio of two differences: p if the error is C h^p and the steps are halved.
// NaN if the differences are not above rounding (1e-13 of the value), not of one sign, or
// do not shrink.
double observed_order(double coarse, double middle, double fine);

// How many decimal digits two numbers share: -log10 of their distance as a share of the
// larger one, 0 to 15; NaN if one of them is.
double shared_digits(double a, double b);

// Runs the scenario at its own method.step, at a half and at a quarter of it; where the
// stiff engine integrates, whose steps follow their error, at its own method.tolerance,
// at a tenth and at a hundredth of it, which must be in the parameter's range. Fails as
// the runs do; STATUS_STOPPED if `monitor` (NULL: nobody looks on) asked for it. The
// panel then has the values of the settings before, NaN for the others and for orders and
// digits.
// `kept` (NULL: nobody wants them) are PANEL_STEPS runs of zeroes, which become those
// with their rows, to be finished in any case.
status convergence_compute(const scenario *s, run_monitor *monitor, run_result *kept,
                           convergence_panel *panel, fault *f);

// The force of a run less that of a more exact one, at the instants both have: x
// [s] and y [N] have room for as many values as `coarse` has rows. Returns their number.
// Rows of one instant, which stand before and after an event, are taken in their order.
size_t convergence_difference(const trace *coarse, const trace *fine, double *x,
                              double *y);

enum { STUDY_METHODS = 3, STUDY_STEPS = 13, STUDY_QUANTITIES = 3 };

typedef struct study_point {
    double step;                    // h [s]
    double cost;                    // computing time of the run [s]
    double error[STUDY_QUANTITIES]; // distance from the reference in the quantity's unit,
                                    // NaN if the run failed or the quantity did not occur
} study_point;

typedef struct method_study {
    double reference_step;              // of the event method [s]
    double reference[STUDY_QUANTITIES]; // its values
    // the least error of a method that is not the reference's: nothing confirms the
    // reference to less; NaN before one was run
    double resolved[STUDY_QUANTITIES];
    study_point points[STUDY_METHODS][STUDY_STEPS];
} method_study;

// Names of the methods as method.name has them, and keys of the quantities.
extern const char *const study_methods[STUDY_METHODS];
extern const char *const study_keys[STUDY_QUANTITIES];

// Runs the scenario with every method at steps from 1e-2 s down to 1e-6 s, and with the
// event method at 2e-5 s for reference: its error comes from rounding there, not from the
// step. Takes some seconds for two links and 1 s. STATUS_STOPPED if `monitor` (NULL:
// nobody looks on) asked for it: cost and errors of the points that were not reached are
// NaN.
status method_study_compute(const scenario *s, run_monitor *monitor, method_study *study,
                            fault *f);

// Runs that method_study_compute counts in its monitor: the reference and each point.
enum { STUDY_RUNS = 1 + STUDY_METHODS * STUDY_STEPS };

// The least cost of a method's points whose error in quantity `k` is at most `error`, all
// shorter steps included [s]; NaN if there is none. *step is the point's step.
double method_study_cost(const method_study *study, int method, int k, double error,
                         double *step);

// Parameters of an arm from recorded traces, with their errors.
//
// Each trace is simulated with the command that was recorded, and its readings are
// compared with the recorded ones, each by its own standard deviation: noise of its
// channel and step of its converter. The sum of squares is minimised by Levenberg and
// Marquardt's method (MINPACK's lmder), the Jacobian by central differences, all its runs
// in one batch. Readings within IDENTIFY_GUARD of a touch or release are left out; the
// instants of touches are residuals of their own. Every trace has a time shift and an
// encoder offset of its own and the state that it starts with; they are fitted too, and
// what they explain is nothing that the parameters are judged by.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/base/csv_table.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"
#include "src/study/sweep_axis.h"

#define IDENTIFY_GUARD    0.01 // [s]
#define IDENTIFY_NEAR     5.0  // standard deviations from zero or an end of a range
#define IDENTIFY_QUANTILE 1.959963984540054 // normal deviate that 95 % are within
// standard normal deviate that white residuals exceed once in 4000
#define IDENTIFY_WHITE 3.5
#define IDENTIFY_BLOCK 0.05 // time over which residuals of noise may be correlated [s]
#define LACK_STRETCH   0.01 // in which an unrecorded command is constant, at least [s]
// of a direction: smaller ones do not make a parameter undetermined
#define IDENTIFY_PART 1e-6

enum {
    IDENTIFY_PATHS = 12,    // that are fitted, at most
    IDENTIFY_TRACES = 12,   // at most
    IDENTIFY_STARTS = 40,   // from which is searched at most, unless it is told
    IDENTIFY_SCREENED = 16, // sets that are drawn for a start
    IDENTIFY_CONFIRMED = 3, // drawn starts that settle a search
    IDENTIFY_CASES = 200,   // of a set drawn from the covariance
    IDENTIFY_LAGS = 20      // of the autocorrelation
};

// The signals that a trace may have besides time and command.
enum {
    CHANNEL_ENCODER,
    CHANNEL_TACHOMETER,
    CHANNEL_FSR,
    CHANNEL_PIEZO,
    CHANNEL_FILM,
    CHANNEL_ACCELEROMETER,
    CHANNEL_TIP_DEFLECTION,
    CHANNEL_ROOT_STRAIN,
    CHANNELS
};
extern const int identify_signals[CHANNELS]; // indices in signal_table

// What a trace has of its own, besides the parameters.
enum { OWN_SHIFT, OWN_OFFSET, OWN_ANGLE, OWN_VELOCITY, OWNS };

enum { IDENTIFY_UNKNOWNS = IDENTIFY_PATHS + IDENTIFY_TRACES * OWNS };

enum { IDENTIFY_COLUMNS = 400 }; // room for the headings of a trace

// What becomes of a reading.
typedef enum reading_use {
    READING_COMPARED,
    READING_MISSING,         // its field is empty
    READING_REPEATED,        // of a sensor that has not looked again
    READING_NEAR_TOUCH,      // within IDENTIFY_GUARD of a touch or a release
    READING_WITHOUT_CONTACT, // of the FSR, which reads nothing then
    READING_AT_RANGE,        // near the end of the converter's range
    READING_USES
} reading_use;
extern const char *const identify_uses[READING_USES]; // in words, but for the first

typedef struct recorded_trace {
    char *file;
    size_t table_rows;                // of its table
    char left_out[CSV_TOLD];          // rows that are not among those, in words, or ""
    char taken[IDENTIFY_COLUMNS];     // headings of its columns
    char not_taken[IDENTIFY_COLUMNS]; // and of others
    sample_clock clock;               // of its samples
    bool is_held;                     // rows between samples repeat these
    double rate;                      // at which its samples are taken to have come [1/s]
    size_t uses[CHANNELS][READING_USES]; // how many readings of each
    size_t rows;                         // one for each sample of the rig
    double begin;                        // of its clock [s]
    double *time;                        // since then [s]
    double *command;                     // [V]
    double *reading[CHANNELS];           // in the signal's unit, NULL: not recorded
    double *deviation[CHANNELS];  // standard deviation of each in its residual's unit, 0:
                                  // left out
    double independent[CHANNELS]; // readings that are compared, where samples that repeat
                                  // one count once
    double *contacts; // instants of touches after a flight of at least IDENTIFY_GUARD [s]
    double *contact_width; // between the readings before and after each [s]
    int contact_count;
    size_t residuals;     // how many it has
    double own[OWNS];     // shift [s], offset [rad], angle [rad], velocity [rad/s]
    bool fits_velocity;   // it does not start from rest
    double contact_error; // largest, of the fitted arm [s]; NaN without a touch
    double peak_error;    // of the largest force reading, as a share; NaN without one
    double rms[CHANNELS]; // of the residuals, in standard deviations; NaN where there are
                          // none, and so are the next two
    double rms_unit[CHANNELS];  // the same in the readings' unit
    double explained[CHANNELS]; // share of the readings' variance that the run explains
    double whiteness[CHANNELS]; // Ljung and Box's statistic as a normal number; NaN where
                                // none
} recorded_trace;

typedef struct fitted_parameter {
    sweep_axis axis;                         // its path, and the range if one was given
    double start;                            // of the scenario
    double low_most, high_most;              // between which it is searched
    double scale;                            // in which it is about 1
    double value, standard_error, low, high; // 95 % interval; NaN if it is not determined
    bool determined;
    bool one_sided; // the value is the least or largest that there is: the interval has
                    // it as one of its ends
} fitted_parameter;

// An unknown: a parameter, or what a trace has of its own.
typedef struct unknown {
    int trace;     // -1 of a parameter
    int index;     // among the parameters, or of what a trace has
    double scale;  // in which it is about 1
    double *value; // where it is kept
} unknown;

// What a model lacks. Where it explains the readings least, a stretch of a channel of a
// trace, and what would explain them.
typedef struct unexplained {
    int trace, channel; // trace -1: there is none
    double from, to;    // in the trace's own time [s]
    double rms;         // of the residuals, in standard deviations
    double rms_unit;    // the same in the readings' unit
    double command; // standard deviation of a command that nobody recorded [V]; NaN where
                    // no reading tells, or beyond what the amplifier takes
    double stretch; // in which it is constant [s]
    double hub_spring;  // stiffness k1 [N m/rad] of the softest hub that explains them no
                        // less than a rigid one, but for chance; NaN where none does
    double hub_damping; // of it [N m s/rad]
    double chi_square;  // with it
    double with_spring[IDENTIFY_PATHS]; // values of the parameters with it
} unexplained;

typedef struct identification {
    const scenario *base; // borrowed
    fitted_parameter fit[IDENTIFY_PATHS];
    int count;
    recorded_trace traces[IDENTIFY_TRACES];
    int trace_count;
    int starts, jobs;
    unsigned long seed;
    bool noise_from_residuals; // the noise of each channel is what the fit leaves of it
    run_monitor *monitor;      // NULL: nobody looks on

    // what comes out
    double *residual; // of all traces one behind the other, in standard deviations
    size_t residuals; //
    int unknowns;     // of them, the parameters first
    unknown unknown[IDENTIFY_UNKNOWNS];
    double part;       // of each trace that is compared while it is searched
    int searches;      // starts that were tried
    int reached;       // of those that were drawn, how many led to the result
    int runs;          // in all
    double chi_square; // their sum of squares
    double aic;        // Akaike's criterion, chi_square + 2 unknowns
    bool white;        // no channel's residuals are correlated
    unexplained lack;  // what the model lacks, where the residuals are not white
    double covariance[IDENTIFY_PATHS *
                      IDENTIFY_PATHS]; // this and what follows in their scales
    double singular[IDENTIFY_PATHS];   // values of the Jacobian, rising
    double direction[IDENTIFY_PATHS * IDENTIFY_PATHS]; // row k belongs to singular[k]
    int undetermined;                                  // the first so many directions are
} identification;

// Whether this program was built with MINPACK; else a sentence in f.
status identify_available(fault *f);

// Reads PATH or PATH=a:b and adds it. STATUS_BAD_ARGUMENT with a sentence: no such
// parameter, one that has no real value, a range that is none, a value of 0 without a
// range.
status identify_add_path(identification *id, const char *text, fault *f);

// Reads a trace: `time`, `command` and at least one reading, headed as in signal_table or
// as columns[] say ("SIGNAL=HEADER[unit]"), at the rate of its own clock. Rows that
// repeat a sample until the next one are one. Fails as csv_table_read does, where
// columns[] name no signal, and where the times do not tell samples apart.
status identify_add_trace(identification *id, const char *file, char *const *columns,
                          int count, fault *f);
void identify_finish(identification *id);

// Fits parameters and what the traces have of their own. Without parameters only the
// latter, which is a validation. STATUS_STOPPED where the monitor asks for it: chi_square
// is 0 if nothing was tried until then, else the values are the best so far, and aic and
// their errors are NaN; what stopped the run if there is none with the scenario's values;
// STATUS_NO_MEMORY.
status identify_fit(identification *id, fault *f);

// The parameters of the scenario with the fitted values, only those that are determined
// if so asked for.
status identify_parameters(const identification *id, bool determined, parameters *p,
                           fault *f);

// What the fit leaves open of the parameters that are determined, but for elements of
// lists. Of no parameters where none has an error.
scenario_fit identify_left_open(const identification *id);

// The scenario whose run is compared with a trace: with the fitted values and what the
// trace has of its own, it plays the recorded command back. It borrows from the base what
// the base owns; its sensors are the base's. Of a trace whose columns have the signals'
// names.
status identify_scenario(const identification *id, int index, scenario *made, fault *f);

// A combination that the data do not determine, in words, k < undetermined. Returns text.
const char *identify_words(const identification *id, int k, char *text, size_t size);

// Whether the search ended at an end of its range: then the value is a limit, no
// estimate, unless it is one_sided.
bool identify_at_end(const fitted_parameter *fit);

// Whether the search reached its result from as many drawn starts as settle it. One with
// the scenario's parameters alone, which draws none, has nothing to settle.
bool identify_settled(const identification *id);

// Chi square per degree of freedom: about 1 where what the model leaves is the noise of
// its channels. Above *most it leaves more than noise twice as large as it is said to be:
// five standard deviations above the mean of that.
double identify_misfit(const identification *id, double *most);

// Whether what the model leaves is noise: residuals that are white, and no larger than
// *most of identify_misfit. If not, `lack` says where it lacks something.
bool identify_explained(const identification *id);

// {"scenario", "fit": [{"path", "value", "standard_error", "low", "high", "determined",
// "at_end_of_range", "one_sided"}], "correlation", "singular_values", "undetermined",
// "chi_square", "residuals", "aic", "white", "lack": null or {"file", "signal", "from_s",
// "to_s", "rms", "rms_over_deviation", "command_V", "stretch_s", "hub_spring": null or
// {"k1_N_m_rad", "damping_N_m_s_rad", "chi_square", "values"}}, "search": {"starts",
// "reached", "runs"}, "traces"}. NULL without memory.
json_t *identify_json(const identification *id);
// Of traces that are read only: {"scenario", "traces"}.
json_t *identify_preview_json(const identification *id);
json_t *identify_traces_json(const identification *id);

// A set of IDENTIFY_CASES arms drawn from the covariance, for robust and tune --over. The
// law is told the fitted values: belief.*_factor go with the parameters.
void identify_write_set(FILE *stream, const identification *id);

// --- for the parts of identify

// The sensor that says when the arm touches: the FSR, else the piezoelectric one.
int identify_force_channel(const recorded_trace *t);
// The quantity whose differences are residuals: the FSR's volts, in which its noise does
// not depend on the force, else the reading itself.
double identify_compared_value(const sensor_parameters *s, int channel, double reading);
// The standard deviation of a reading by noise and by the converter's steps,
//
//     sqrt(noise^2 + step^2/12),
//
// in the unit of identify_compared_value. *range receives the largest magnitude that can
// be read, in that unit, and *dithered whether the noise covers the steps.
double identify_deviation(const sensor_parameters *s, int channel, double *range,
                          bool *dithered);
// Finds the touches in the recorded force and weighs the readings of all channels: sets
// the trace's contacts, deviations, uses and number of residuals. STATUS_NO_MEMORY.
status identify_weigh(recorded_trace *t, const parameters *p, fault *f);

// The sum of a[i] b[i].
double identify_dot(const double *a, const double *b, size_t count);
// Adds factor times a to `to`.
void identify_add_scaled(double *to, double factor, const double *a, size_t count);
// The value of the range to search that is nearest to another.
double identify_within_range(const fitted_parameter *fit, double value);

// Lists the unknowns of the fit: the parameters, then those of each trace.
void identify_list_unknowns(identification *id);
// The value of unknown n at x, x being in units of its scale; a parameter's value is
// limited to its range.
double identify_unknown_value(const identification *id, int n, double x);
// Computes the residuals of `sets` sets of unknowns x[sets * unknowns], in their scales:
// out[sets * residuals], of each set those of all traces, then the penalties of the
// parameters. Of set s only trace only[s] is run; with only[s] = -1, or without `only`
// (NULL), every trace is. With `judge` the traces' errors of contacts and peaks are
// filled in. `why` (may be NULL) receives the fault of the first run that failed.
status identify_evaluate(identification *id, const double *x, int sets, const int *only,
                         bool judge, double *out, fault *why, fault *f);
// The result's unknowns x[unknowns], in their scales.
void identify_result(const identification *id, double *x);
// The Jacobian of the residuals by the unknowns at x, jacobian[unknowns * residuals],
// column by column, by central differences. Fails as identify_evaluate does.
status identify_jacobian(identification *id, const double *x, double *jacobian, fault *f);
// Minimises the sum of squares over all unknowns from x[unknowns] on; *squares receives
// it. Fails as identify_evaluate does.
status identify_minimise(identification *id, double *x, double *squares, fault *f);
// The same over all unknowns but one, `held`.
status identify_minimise_held(identification *id, int held, double *x, double *squares,
                              fault *f);
// Widens the intervals of a fit that was judged where the sum of squares is no
// paraboloid, at the result x[unknowns] with its Jacobian. Fails as identify_evaluate
// does.
status identify_profile(identification *id, const double *x, const double *jacobian,
                        fault *f);
// Searches the unknowns x[unknowns] with the least sum of squares, *least: NaN if nothing
// was tried. Fails as identify_fit does; x are then the best so far.
status identify_search(identification *id, double *x, double *least, fault *f);
// Residuals of a trace (its own number of them) under parameters p and what it has of its
// own. Returns what stopped the run, with a sentence in f, and residuals of 1e3 each.
status identify_residuals(const identification *id, recorded_trace *t,
                          const parameters *p, const double own[OWNS], bool judge,
                          double *residual, fault *f);
// Finds sizes and whiteness of the residuals of every channel, and where they are
// largest.
status identify_explain(identification *id, fault *f);
// Takes out of columns[count * residuals] what the traces' own unknowns could explain as
// well: the projections on the space of their columns of the Jacobian. False if these
// have no eigenvectors, or without memory.
bool identify_leave_own(const identification *id, const double *jacobian, double *columns,
                        int count);
// Judges the result: Jacobian column by column, jacobian[unknowns * residuals].
status identify_judge(identification *id, const double *jacobian, fault *f);

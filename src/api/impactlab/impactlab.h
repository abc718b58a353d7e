// libimpactlab: runs of a flexible robot arm that hits a wall, for programs in C and C++.
//
//     impactlab_error error;
//     impactlab_scenario *scenario;
//     impactlab_run *run;
//     double peak;
//     if (impactlab_scenario_open(&scenario, "corrected/first-impact", &error) ==
//     IMPACTLAB_OK &&
//         impactlab_scenario_set(scenario, "motor.voltage", "2 V", &error) ==
//         IMPACTLAB_OK && impactlab_run_create(&run, scenario, IMPACTLAB_KEEP_ROWS,
//         &error) == IMPACTLAB_OK && impactlab_run_quantity(run, "peak_force_N", &peak,
//         &error) == IMPACTLAB_OK) { printf("%.17g N\n", peak);
//     }
//
// Everything is SI; names and paths are those of scenario files and of the program's
// results. Functions that can fail return a status and fill in `error`, which may be
// NULL. Nothing here prints, ends the program or looks at the locale. Handles are
// independent of one another: several threads may use the library at once, each with
// handles of its own, and several may read one handle. A handle that was not created is
// NULL; destroying NULL does nothing.
//
// What stays: a name that is once in impactlab.map keeps its meaning, under the version
// node IMPACTLAB_1 and the soname libimpactlab.so.1; new functions get a new node.
// Structures that the library hands out may grow at their end. Those that the caller owns
// (impactlab_error, impactlab_reading, impactlab_prediction, impactlab_event) do not
// change, and codes of a status keep their numbers. Anything else is a new soname. The
// header of controllers has a version of its own, CONTROLLER_INTERFACE. In the program's
// version the second number grows when results differ beyond rounding, the third
// otherwise.
#ifndef IMPACTLAB_IMPACTLAB_H
#define IMPACTLAB_IMPACTLAB_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined __GNUC__
#define IMPACTLAB_EXPORT __attribute__((visibility("default")))
#else
#define IMPACTLAB_EXPORT
#endif

// --- errors ----------------------------------------------------------------------------

typedef enum impactlab_status {
    IMPACTLAB_OK = 0,
    IMPACTLAB_BAD_ARGUMENT = 1,  // of the call, or a name that is not known
    IMPACTLAB_BAD_SCENARIO = 2,  // a file or a combination of parameters that is wrong
    IMPACTLAB_NOT_FINITE = 3,    // a state or command became infinite or not a number
    IMPACTLAB_UNSTABLE = 4,      // the energy ledger does not close
    IMPACTLAB_NEWTON_FAILED = 5, // an iteration did not converge
    IMPACTLAB_NO_PROGRESS = 6, // events or strides follow each other without time passing
    IMPACTLAB_SINGULAR = 7,    // equations without a single solution
    IMPACTLAB_NO_MEMORY = 8,   // an allocation failed
    IMPACTLAB_CANNOT_WRITE = 9,        // a file or stream cannot be written
    IMPACTLAB_CANNOT_READ = 10,        // a file does not exist or cannot be read
    IMPACTLAB_EXPECTATION_FAILED = 11, // the result is not what the scenario expects
    IMPACTLAB_STOPPED = 12,            // stopped before its end
    IMPACTLAB_FOLDED = 13, // the arm is folded across the hub's axis on a flat wall
    IMPACTLAB_CONTROLLER_FAILED =
        14,                     // a controller process died, hung or broke the protocol
    IMPACTLAB_NOT_ALLOWED = 15, // a program or plug-in was not allowed to run
    IMPACTLAB_IMPOSSIBLE_MEAN = 16 // a mean of the force lies outside what the force is
} impactlab_status;

typedef struct impactlab_error {
    int status; // impactlab_status
    int line,
        column; // of the fault in the file that was read, from 1; 0 if there is none
    char parameter[64];  // path of the parameter at fault, "" if there is none
    char sentence[1024]; // for people: what was wrong, where, and what was expected
} impactlab_error;

// "0.2.0", of the library that runs.
IMPACTLAB_EXPORT const char *impactlab_version(void);

// The general text of a status, never NULL.
IMPACTLAB_EXPORT const char *impactlab_status_text(int status);

// --- tables of parameters, signals and quantities --------------------------------------

// A parameter of a scenario. Rows are constants of the library.
typedef struct impactlab_parameter {
    const char *path; // "arm.k2"
    const char *type; // "real", "integer", "boolean", "choice", "text" or "list" of reals
    const char *unit; // "N m/rad", "" for a pure number
    const char *choices;     // "rigid|spring|beam" of a choice, else ""
    const char *description; // one sentence without a full stop
    double initial;          // default under the corrected model; of a choice its index
    double minimum, maximum; // both included; 0, 0 of a text
    int timed;               // 1 if it may change during a run
} impactlab_parameter;

// A recorded signal.
typedef struct impactlab_signal {
    const char *name;        // "force"
    const char *symbol;      // in ASCII
    const char *unit;        // "N"
    const char *description; // one sentence without a full stop
} impactlab_signal;

// A number of the summary of a run.
typedef struct impactlab_quantity {
    const char *key;         // "peak_force_N"
    const char *label;       // "peak force"
    const char *unit;        // "N"
    const char *description; // one sentence without a full stop
    int timing;              // 1 if it depends on the machine, not on the scenario
} impactlab_quantity;

// The row at an index from 0 on; NULL past the last one.
IMPACTLAB_EXPORT const impactlab_parameter *impactlab_parameter_at(size_t index);
IMPACTLAB_EXPORT const impactlab_signal *impactlab_signal_at(size_t index);
IMPACTLAB_EXPORT const impactlab_quantity *impactlab_quantity_at(size_t index);

// --- scenarios -------------------------------------------------------------------------

typedef struct impactlab_scenario impactlab_scenario;

// The sorted names of all shipped scenarios and of those in the folders of
// IMPACTLAB_SCENARIOS; impactlab_names_free frees them.
IMPACTLAB_EXPORT int impactlab_scenario_names(char ***names, size_t *count,
                                              impactlab_error *error);
IMPACTLAB_EXPORT void impactlab_names_free(char **names, size_t count);

// Opens a scenario by its name or file; reads one from a text (`length` bytes of YAML),
// with a name of its own or, without, "text"; creates one with all defaults; copies one.
// The error describes the first fault found.
IMPACTLAB_EXPORT int impactlab_scenario_open(impactlab_scenario **scenario,
                                             const char *name_or_file,
                                             impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_parse(impactlab_scenario **scenario,
                                              const char *text, size_t length,
                                              impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_parse_named(impactlab_scenario **scenario,
                                                    const char *text, size_t length,
                                                    const char *name,
                                                    impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_create(impactlab_scenario **scenario,
                                               impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_copy(impactlab_scenario **scenario,
                                             const impactlab_scenario *from,
                                             impactlab_error *error);
IMPACTLAB_EXPORT void impactlab_scenario_destroy(impactlab_scenario *scenario);

// Name, title and description, valid until the scenario is destroyed; the title tells
// what was changed, and does until the next change.
IMPACTLAB_EXPORT const char *impactlab_scenario_name(const impactlab_scenario *scenario);
IMPACTLAB_EXPORT const char *impactlab_scenario_title(const impactlab_scenario *scenario);
IMPACTLAB_EXPORT const char *
impactlab_scenario_description(const impactlab_scenario *scenario);

// Sets a parameter, from a text ("2 V", "plane") or a number (for a choice, its index;
// for a boolean, 0 or 1). Parameters derived from it are updated; on failure nothing
// changes.
IMPACTLAB_EXPORT int impactlab_scenario_set(impactlab_scenario *scenario,
                                            const char *path, const char *text,
                                            impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_set_number(impactlab_scenario *scenario,
                                                   const char *path, double value,
                                                   impactlab_error *error);
// Sets several, each given as "PATH=VALUE"; only together, not one by one, do they have
// to be valid.
IMPACTLAB_EXPORT int impactlab_scenario_set_all(impactlab_scenario *scenario,
                                                const char *const *assignments,
                                                size_t count, impactlab_error *error);

// The value of a parameter, as a number (NaN for an optional one without a value, 0 for a
// text) or as a text of at most `size` bytes including the terminating null.
IMPACTLAB_EXPORT int impactlab_scenario_number(const impactlab_scenario *scenario,
                                               const char *path, double *value,
                                               impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_text(const impactlab_scenario *scenario,
                                             const char *path, char *text, size_t size,
                                             impactlab_error *error);
// 1 if the parameter was given a value, 0 if it has its default.
IMPACTLAB_EXPORT int impactlab_scenario_is_set(const impactlab_scenario *scenario,
                                               const char *path);

// Adds an entry to the scenario's script: at `time` [s] the parameter gets another value,
// or the tip receives an impulse [N s].
IMPACTLAB_EXPORT int impactlab_scenario_add_change(impactlab_scenario *scenario,
                                                   double time, const char *path,
                                                   const char *text,
                                                   impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_scenario_add_push(impactlab_scenario *scenario,
                                                 double time, double impulse,
                                                 impactlab_error *error);

// Whether the scenario may start the program or load the plug-in that it names: 1 or 0
// (default).
IMPACTLAB_EXPORT void impactlab_scenario_allow_code(impactlab_scenario *scenario,
                                                    int allowed);

// Whether what the library computes is to end before its end: other than 0 if so.
typedef int (*impactlab_stop_question)(void *context);

// Lets runs, loops and batches that are made from this handle from here on ask `question`
// (NULL: nobody, as at first), on the thread that called the library, at least every 10
// ms or, of arms whose step takes longer, after each step. A run or batch that is stopped
// returns IMPACTLAB_STOPPED with what it has until then; so does a loop, which goes on
// from there when it is called again.
IMPACTLAB_EXPORT void impactlab_scenario_stop_when(impactlab_scenario *scenario,
                                                   impactlab_stop_question question,
                                                   void *context);

// The scenario as the text of a YAML file, without its expectations; impactlab_text_free
// frees it.
IMPACTLAB_EXPORT int impactlab_scenario_yaml(const impactlab_scenario *scenario,
                                             char **yaml, impactlab_error *error);
IMPACTLAB_EXPORT void impactlab_text_free(char *text);

// --- runs ------------------------------------------------------------------------------

typedef struct impactlab_run impactlab_run;
struct controller; // of <impactlab/controller.h>

enum {
    IMPACTLAB_KEEP_ROWS = 1, // rows of signals are kept, not only events and summary
    IMPACTLAB_COMMAND =
        2 // for a loop: the motor gets the command of impactlab_loop_command
};

// Numbers `stride` bytes apart, in memory owned by the handle that returned them.
typedef struct impactlab_series {
    const double *values;
    size_t count;
    size_t stride; // [bytes]
} impactlab_series;

// Rows of adjacent numbers, row after row, in memory owned by the handle that returned
// them.
typedef struct impactlab_table {
    const double *values;
    size_t rows, columns;
} impactlab_table;

typedef struct impactlab_event {
    double time;      // [s]
    const char *kind; // "impact", "contact", "release", "stick", "reversal", "slip",
                      // "change", "push" or "chatter"
    double impulse;   // of an impact or push [N s], else 0
    double speed;     // of approach at an impact [m/s], else 0
    double loss;      // of energy at an impact [J], else 0
} impactlab_event;

// Runs the scenario to its end. If the run is stopped before, the reason is returned and
// *run holds the results up to that instant; *run is NULL if the run could not be
// started.
IMPACTLAB_EXPORT int impactlab_run_create(impactlab_run **run,
                                          const impactlab_scenario *scenario, int flags,
                                          impactlab_error *error);
// The same with a controller instead of control.law. The rig gives the controller
// law->memory_size bytes of memory (at least the size of a pointer), which begin with the
// pointer `context`.
IMPACTLAB_EXPORT int impactlab_run_create_with(impactlab_run **run,
                                               const impactlab_scenario *scenario,
                                               int flags, const struct controller *law,
                                               void *context, impactlab_error *error);
IMPACTLAB_EXPORT void impactlab_run_destroy(impactlab_run *run);

// "ok", "inaccurate" (the energy balance is open by more than method.residual_bound
// allows) or "failed"; and the message: what stopped the run, or a remark on its results
// ("" if none).
IMPACTLAB_EXPORT const char *impactlab_run_status(const impactlab_run *run);
IMPACTLAB_EXPORT const char *impactlab_run_message(const impactlab_run *run);

// A number of the summary by its key, NaN if what it describes did not occur; or all of
// them, in the order of impactlab_quantity_at: at most `count` are written, and their
// number is returned.
IMPACTLAB_EXPORT int impactlab_run_quantity(const impactlab_run *run, const char *key,
                                            double *value, impactlab_error *error);
IMPACTLAB_EXPORT size_t impactlab_run_quantities(const impactlab_run *run, double *values,
                                                 size_t count);

// A recorded signal by its name ("time", "force"), not copied; NaN where it was not
// recorded. Angles [rad] and velocities [rad/s] of all degrees of freedom, the hub's
// first if it has one.
IMPACTLAB_EXPORT int impactlab_run_signal(const impactlab_run *run, const char *name,
                                          impactlab_series *series,
                                          impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_run_angles(const impactlab_run *run,
                                          impactlab_table *table, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_run_velocities(const impactlab_run *run,
                                              impactlab_table *table,
                                              impactlab_error *error);

// All signals on a uniform grid: one row at each of 0, every, 2 every ... [s] up to the
// run's end, of as many numbers as impactlab_signal_at has signals. Of several rows at
// one instant it has the last; between rows it is straight, but for states, which stay,
// and impulses, which act at their instant alone. At most `most` rows are written, *count
// says how many there are (values may be NULL for that).
IMPACTLAB_EXPORT int impactlab_run_grid(const impactlab_run *run, double every,
                                        double *values, size_t most, size_t *count,
                                        impactlab_error *error);

// The events of the run in the order of time: their number; and event `index`, which
// returns 1, or 0 if there is none.
IMPACTLAB_EXPORT size_t impactlab_run_event_count(const impactlab_run *run);
IMPACTLAB_EXPORT int impactlab_run_event(const impactlab_run *run, size_t index,
                                         impactlab_event *event);

// The whole run as a block of bytes: its size, saving it, and the same run again, given
// its scenario, in the same version on the same kind of machine. Bytes that are damaged
// or of another scenario are refused.
IMPACTLAB_EXPORT size_t impactlab_run_saved_size(const impactlab_run *run);
IMPACTLAB_EXPORT int impactlab_run_save(const impactlab_run *run, void *bytes,
                                        size_t size, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_run_restore(impactlab_run **run,
                                           const impactlab_scenario *scenario,
                                           const void *bytes, size_t size,
                                           impactlab_error *error);

// The texts that `impactlab run --json` and `--csv` write; impactlab_text_free frees
// them.
IMPACTLAB_EXPORT int impactlab_run_json(const impactlab_run *run, char **json,
                                        impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_run_csv(const impactlab_run *run, char **csv,
                                       impactlab_error *error);

// --- step by step ----------------------------------------------------------------------

typedef struct impactlab_loop impactlab_loop;

// Readings of the sensors, in the units of the recorded signals; NaN for a sensor not
// fitted.
typedef struct impactlab_reading {
    double time;          // of the present instant [s]
    double encoder;       // hub angle [rad]
    double tachometer;    // hub velocity [rad/s]
    double force;         // contact force, FSR [N]
    double piezo_force;   // contact force, piezoelectric sensor [N]
    double film;          // bending, piezo film [rad]
    double accelerometer; // hub acceleration [rad/s2]
} impactlab_reading;

// A run at its start, to be advanced step by step. With IMPACTLAB_COMMAND the caller is
// the controller; otherwise control.law is, or, if that is none, the bare arm moves under
// motor.voltage.
IMPACTLAB_EXPORT int impactlab_loop_create(impactlab_loop **loop,
                                           const impactlab_scenario *scenario, int flags,
                                           impactlab_error *error);
IMPACTLAB_EXPORT void impactlab_loop_destroy(impactlab_loop *loop);

// Advances to the next sample of the rig (without a rig, by method.step), or to an
// instant [s], but not beyond run.duration. The printed model has no states between its
// steps: it advances to the first step at or after the instant. An error that ended the
// run is returned by every further call.
IMPACTLAB_EXPORT int impactlab_loop_step(impactlab_loop *loop, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_loop_step_until(impactlab_loop *loop, double time,
                                               impactlab_error *error);

// The present instant of the run [s]; and whether it is at its end (1 or 0).
IMPACTLAB_EXPORT double impactlab_loop_time(const impactlab_loop *loop);
IMPACTLAB_EXPORT int impactlab_loop_ended(const impactlab_loop *loop);

// Sets the command [V] for the sample due now or, between samples, for the next; it is
// held until another one is set. IMPACTLAB_BAD_ARGUMENT without IMPACTLAB_COMMAND.
IMPACTLAB_EXPORT int impactlab_loop_command(impactlab_loop *loop, double volts,
                                            impactlab_error *error);
// Changes, now, a parameter that may change during a run: to a number (for a choice, its
// index) or to a text ("2 V", "impact" for control.lock); or gives the tip an impulse [N
// s], which the printed model refuses (IMPACTLAB_BAD_ARGUMENT). A call that fails changes
// nothing.
IMPACTLAB_EXPORT int impactlab_loop_set_input(impactlab_loop *loop, const char *path,
                                              double value, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_loop_set_text(impactlab_loop *loop, const char *path,
                                             const char *text, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_loop_push(impactlab_loop *loop, double impulse,
                                         impactlab_error *error);

// The readings of the sample due now or, between samples, of the last one.
// IMPACTLAB_BAD_ARGUMENT without a rig (control.law is none and IMPACTLAB_COMMAND is not
// set).
IMPACTLAB_EXPORT int impactlab_loop_read_sensors(impactlab_loop *loop,
                                                 impactlab_reading *reading,
                                                 impactlab_error *error);

// The true (unmeasured) value of a signal now; or of all of them, in the order of
// impactlab_signal_at, at the cost of about one: at most `count` are written, and their
// number is returned. And the state as a table of two rows, angles and velocities of all
// degrees of freedom, valid until the loop advances.
IMPACTLAB_EXPORT int impactlab_loop_signal(impactlab_loop *loop, const char *name,
                                           double *value, impactlab_error *error);
IMPACTLAB_EXPORT size_t impactlab_loop_signals(impactlab_loop *loop, double *values,
                                               size_t count);
IMPACTLAB_EXPORT int impactlab_loop_state(const impactlab_loop *loop,
                                          impactlab_table *table, impactlab_error *error);

// The whole state of the loop as a block of bytes: its size, saving it, and restoring it
// exactly (to the last bit). A block fits any loop of the same scenario and version on
// the same kind of machine. With a plug-in as the controller it fits only the loop that
// saved it; with a process as the controller none can be restored. Recorded rows are not
// part of the state: restoring drops those that are later. A block names its kind, layout
// and size, has a hash of its scenario and a checksum, and holds no address and nothing
// undefined: loops in one state save the same bytes. Bytes that are damaged are refused,
// and change nothing.
IMPACTLAB_EXPORT size_t impactlab_loop_state_size(const impactlab_loop *loop);
IMPACTLAB_EXPORT int impactlab_loop_save_state(const impactlab_loop *loop, void *bytes,
                                               size_t size, impactlab_error *error);
IMPACTLAB_EXPORT int impactlab_loop_restore_state(impactlab_loop *loop, const void *bytes,
                                                  size_t size, impactlab_error *error);

// The results of the loop so far, as a run of its own (rows are copied).
IMPACTLAB_EXPORT int impactlab_loop_run(impactlab_loop *loop, impactlab_run **run,
                                        impactlab_error *error);

// --- many runs -------------------------------------------------------------------------

// The outcome of one run of a batch, valid during the call.
typedef struct impactlab_outcome {
    size_t index;             // of the run
    int status;               // impactlab_status
    const char *word;         // "ok", "inaccurate" or "failed"
    const char *message;      // "" if there is nothing to say
    const double *quantities; // in the order of their table, NaN where one did not occur
    size_t quantity_count;
} impactlab_outcome;

// Receives each outcome, in the order of the runs, on the calling thread. A result other
// than 0 ends the batch.
typedef int (*impactlab_outcome_taker)(void *context, const impactlab_outcome *outcome);

// Runs the scenario `count` times on `jobs` threads (0: as many as there are processors):
// in run i parameter paths[k] has the value values[i * path_count + k]. Each outcome is
// the same to the last bit as that of a run by itself, whatever the number of threads.
// IMPACTLAB_STOPPED if `take` or the scenario's question ended it; `take` gets those that
// were done. All values are checked before the first run.
IMPACTLAB_EXPORT int impactlab_batch(const impactlab_scenario *scenario,
                                     const char *const *paths, size_t path_count,
                                     const double *values, size_t count, int jobs,
                                     impactlab_outcome_taker take, void *context,
                                     impactlab_error *error);

// --- predictors and modes --------------------------------------------------------------

// What a predictor says about the first impact, from the state just before it.
typedef struct impactlab_prediction {
    const char *method; // "energy", "impact_dynamics", "impact_quadratic" or "linearised"
    int known;          // 1 if it has an answer
    int holds;          // 1 if the tip would stay in contact
    double peak;        // of the first pulse [N], NaN if there is none
    double time_to_peak; // from contact on [s], NaN where the method gives none
    double impulse;      // of the impact [N s], NaN where the method gives none
    char message[1024];  // why there is no answer or no pulse, else ""
} impactlab_prediction;

// Asks all predictors about the run's state before its first contact after a free flight;
// the run must have rows. At most `count` are written, *written says how many.
// IMPACTLAB_BAD_ARGUMENT if there was no such contact.
IMPACTLAB_EXPORT int impactlab_run_predictions(const impactlab_run *run,
                                               impactlab_prediction *predictions,
                                               size_t count, size_t *written,
                                               impactlab_error *error);

// Natural frequencies [rad/s] and shapes of the straight arm without damping, with the
// hub locked (else free) and the tip pinned (else free). Room for `most` modes of
// impactlab_freedoms() angles each; *count says how many there are. `shapes` may be NULL.
IMPACTLAB_EXPORT size_t impactlab_freedoms(const impactlab_scenario *scenario);
IMPACTLAB_EXPORT int impactlab_modes(const impactlab_scenario *scenario, int hub_locked,
                                     int tip_pinned, double *frequencies, double *shapes,
                                     size_t most, size_t *count, impactlab_error *error);

#ifdef __cplusplus
}
#endif

#endif

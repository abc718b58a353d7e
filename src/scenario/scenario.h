// A scenario: parameters, scripted actions and expected results, read from a YAML file.
#pragma once

#include <stdbool.h>

#include "src/tables/parameters.h"
#include "src/rig/controller.h"

// --- a lesson ---

// A lesson: steps that a student goes through in the terminal lab, with answers that can
// be checked. It stands in a scenario file, under `lesson:`.
enum { LESSON_PARAMETERS = 6, LESSON_CHOICES = 6, LESSON_COMMANDS = 8 };
enum { LESSON_PINNED_RUNS = 7 }; // that the lab pins at most
enum { LESSON_TEXTS = 3 + LESSON_CHOICES + LESSON_COMMANDS };

// What has to be so before a step is done.
typedef enum lesson_check {
    LESSON_READ,   // nothing: it is read
    LESSON_NUMBER, // a number was answered, as near as `within` to a quantity of the run
    LESSON_CHOICE, // the right one of several answers was given
    LESSON_CURSOR, // the cursor is near an instant of the run
    LESSON_VALUE,  // a parameter has a value at the cursor
    LESSON_PINNED, // so many runs are pinned
    LESSON_RATIO   // a quantity of the run is in a range, as a share of the baseline's
} lesson_check;

typedef struct lesson_step {
    union {
        struct {
            char *say;  // what to do or to think about
            char *then; // said when it is done, "" for nothing
            char *hint; // said to who asks before, "" for none
            char *choices[LESSON_CHOICES];
            char *commands[LESSON_COMMANDS]; // of the lab, that do the step
        };
        char *texts[LESSON_TEXTS]; // all of these, NULL where there is none
    };
    lesson_check check;
    int quantity; // NUMBER, CURSOR, RATIO: index in summary_table
    double
        within; // NUMBER: share of the quantity; CURSOR: [s]; VALUE: share of the value
    double offset;           // CURSOR: after the quantity's instant [s]
    double low, high;        // RATIO
    int parameter;           // VALUE: index in parameter_table
    double value;            // VALUE, in the parameter's unit
    int choice_count, right; // CHOICE: the right one, from 0
    int pinned;              // PINNED
    int command_count;
} lesson_step;

typedef struct lesson {
    int parameters[LESSON_PARAMETERS]; // that matter, indices in parameter_table
    int parameter_count;
    lesson_step *steps;
    int step_count; // 0: there is no lesson
} lesson;

// --- a scenario ---

typedef enum action_kind { ACTION_SET, ACTION_PUSH } action_kind;

// Something the file asks for at an instant of the run.
typedef struct action {
    double time; // [s]
    action_kind kind;
    int parameter; // ACTION_SET: index in parameter_table
    double value;  // ACTION_SET: new value; ACTION_PUSH: impulse at the tip, across the
                   // last link, positive towards growing angle [N s]
    char text[PARAMETER_VALUE_SIZE]; // ACTION_SET of a parameter that is a text: its new
                                     // value; of one number of control.settings ".NAME"
    bool added;                      // not of the scenario's file
    int line;                        // in that file, from 1; 0: none
} action;

enum { ACTION_PATH = 192 }; // room for the path that an action sets

// A quantity of the run's summary that the file expects.
typedef struct expectation {
    int quantity;     // index in summary_table
    bool is_null;     // expected not to have occurred
    double value;     // in the quantity's unit
    double tolerance; // absolute, in the quantity's unit
    int line, column; // where it stands in the file, from 1
} expectation;

// Where a fault lies that was reported.
typedef struct fault_place {
    int line, column; // in the file, from 1; 0 if it is of none
    const char *path; // of the parameter, a literal; NULL if it is of none
} fault_place;

enum { SCENARIO_FIT = 12 }; // parameters of a fit, at most

// How far recordings leave open which arm it is: a scenario that was fitted to them has
// the standard errors of the fitted parameters, and their correlations.
typedef struct scenario_fit {
    int parameters[SCENARIO_FIT]; // indices in parameter_table
    double errors[SCENARIO_FIT];  // above 0, each in its parameter's unit
    double correlation[SCENARIO_FIT * SCENARIO_FIT]; // [count x count], row by row
    int count;
} scenario_fit;

// What a scenario's file gives of its parameters.
typedef struct written_parameters {
    parameters values;                         // resolved
    int lines[sizeof(((parameters *)0)->set)]; // that give them, from 1; 0: none
} written_parameters;

enum { SCENARIO_PANES = 6 }; // signals that a scenario is looked at by, at most

typedef struct scenario {
    char *name;                // "thesis/fig-3-4", or the path it was read from
    char *file;                // path of the file
    char *title;               // one line
    char *description;         // several sentences, "" if none
    int panes[SCENARIO_PANES]; // signals to look at first, indices in signal_table
    int pane_count;
    parameters parameters;       // resolved
    written_parameters *written; // NULL of a scenario that has no file
    action *actions;             // sorted by time
    int action_count;
    expectation *expectations;
    int expectation_count;
    lesson lesson;       // of no steps if it has none
    scenario_fit *fit;   // of its parameters to recordings; NULL: they were not fitted
    fault_place refused; // of the first fault that reading or overriding it reported
} scenario;

// Inserts an action behind those that are not later. s->actions has room for it.
void scenario_insert_action(scenario *s, action a);

// The ACTION_SET that gives a parameter the value it has in p. `text` gave it that value:
// where it is ".NAME=VALUE", the action sets that number of control.settings alone.
action action_of(double time, const parameters *p, int parameter, const char *text);
// The path that it sets, of one of control.settings with its NAME.
const char *action_path(const action *a, char path[ACTION_PATH]);
// Whether its value is a text, not a number.
bool action_is_text(const action *a);

// Gives the parameter of an ACTION_SET its value, in parameters that are yet to be
// resolved; other actions change none.
status action_give(const action *a, parameters *p, fault *f);

// The same in resolved parameters: what depends on the parameter follows it.
status action_apply(const action *a, parameters *p, fault *f);
// The value that an ACTION_SET gives, as a scenario file would have it.
void action_format_value(const action *a, char *text, size_t size);

// Whether a value of the expected quantity (NaN: it did not occur) is as expected.
bool expectation_is_met(const expectation *e, double value);

// The parameters as the script has set them until an instant, that included [s].
parameters scenario_parameters_at(const scenario *s, double time);

// parameters_check_timing at every instant of the script.
status scenario_check_timing(const scenario *s, fault *f);

// Whether the law has every mode that control.lock and the script hold it in; else a
// sentence in f. law: controller_of() before a run, which knows no plug-in; NULL says
// nothing.
status scenario_check_locks(const scenario *s, const controller *law, fault *f);

// Called once for each fault in a file, with a whole sentence "file:line:column: what,
// expected".
typedef void (*fault_handler)(void *context, const char *sentence);

// One that keeps the first sentence in a fault of zeroes, its context.
void keep_first_fault(void *context, const char *sentence);

// Reads and validates the file (layout: docs/reference/scenario.md). Every fault is
// reported through `report`; STATUS_BAD_SCENARIO if there was any (STATUS_CANNOT_READ if
// the file cannot be opened), and then nothing is to be freed; s->refused is the place of
// the first one. `name` is the scenario's name, NULL to use the path.
status scenario_read(scenario *s, const char *path, const char *name,
                     fault_handler report, void *context);

// The same from memory; `path` is used in messages only.
status scenario_parse(scenario *s, const char *text, size_t length, const char *path,
                      const char *name, fault_handler report, void *context);

void scenario_finish(scenario *s);

// A copy of one's own; STATUS_NO_MEMORY, and then nothing is to be freed.
status scenario_copy(scenario *copy, const scenario *s);

enum {
    SCENARIO_CHANGES = 512,
    SCENARIO_TITLE = 200
}; // SCENARIO_TITLE: most bytes of a title

// What is another than in the file, to stand after its title or name: ", with
// motor.voltage = 4 V, a push of 0.1 N s at 0.2 s", or "". What has no room is counted.
// Returns text.
#define scenario_changes(s, text) scenario_changes_within(s, text, SCENARIO_CHANGES)
// The title with these changes. Returns text.
enum { SCENARIO_TITLED = SCENARIO_TITLE + SCENARIO_CHANGES };
const char *scenario_titled(const scenario *s, char text[SCENARIO_TITLED]);
// The same in at most `room` bytes, its end included.
const char *scenario_changes_within(const scenario *s, char *text, size_t room);

// Writes a file that reads back with the same title (with what was changed since the
// scenario was read), description, parameters, script and lesson. What it expects is not
// written: with other parameters it would not hold. Errors stay in the stream.
void scenario_write(FILE *stream, const scenario *s);

// The same as a text, to be freed; NULL, noted (text_stream.h), without memory.
char *scenario_as_text(const scenario *s);

// Resolves the scenario's parameters, some of which were changed, and checks that its
// script goes with them. If that fails they are of no use, and f says why.
status scenario_resolve(scenario *s, fault *f);

// Gives the scenario other parameters, changed but not yet resolved, and resolves them.
// If that fails nothing changes and f says why.
status scenario_take_parameters(scenario *s, const parameters *changed, fault *f);

// One parameter that changes: to a text, or to a number where that is NULL.
typedef struct parameter_change {
    int parameter; // index in parameter_table
    double number;
    const char *text;
} parameter_change;

// A scenario with such changes; it borrows everything but its parameters from the base.
// Fails, with the reason in f, if a value does not go or they do not go together.
status scenario_with(const scenario *base, const parameter_change *changes, size_t count,
                     scenario *changed, fault *f);

// Applies "PATH=VALUE" (--set) and resolves the parameters anew. If that fails nothing
// changes and f says why, beginning with "--set PATH=VALUE: ". A run.duration that ends
// before an action of the script is allowed; the action then does not happen.
status scenario_override(scenario *s, const char *assignment, fault *f);

// Applies several of them, in any order that makes sense: what is wrong only until
// another one is set (arm.links=4 before arm.model=corrected) is right. Of several values
// for one parameter the last one counts. Each fault is reported as scenario_override says
// it, and then nothing is said of what the parameters are.
status scenario_override_all(scenario *s, char *const *assignments, int count,
                             fault_handler report, void *context);

// Whether a file is a scenario without a fault.
bool scenario_is(const char *path);

// Finds a scenario by the name `list` shows ("thesis/fig-3-4") or by file, as SCENARIO on
// the command line is meant, and reads it. A file may be given without its ".yaml".
// STATUS_BAD_ARGUMENT if there is neither; the sentence then names the nearest scenario.
status scenario_open(scenario *s, const char *name_or_file, fault_handler report,
                     void *context);

// Path of a file in the first scenario folder that has it, on the heap; NULL without
// memory.
char *scenario_folder_file(const char *name);

// The same for a name or a path: a file of that name, else the one in the scenario
// folders, else the name as it is.
char *scenario_file_or_folder_file(const char *name);

// The names of all scenarios in and below the scenario folder, sorted with numbers as
// numbers (fig-3-2 before fig-3-10); free each and the array. STATUS_CANNOT_READ if there
// is no folder. The folders are those of IMPACTLAB_SCENARIOS, separated by colons, of
// which the first that has a name counts, and that of the scenarios that ship: the source
// tree's for what was built there, else the one beside the installation, wherever that
// has moved.
status scenario_list(char ***names, int *count, fault *f);

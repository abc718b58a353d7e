// impactlab run: one run, its numbers, events and expectations.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>

#include "src/arm/arm.h"
#include "src/base/words.h"
#include "src/exchange/run_tables.h"
#include "src/run/export.h"
#include "src/scenario/effect.h"
#include "src/tables/parameters.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/interrupts.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

enum { EVENTS_SHOWN = 16, VALUE_TEXT = 128 };

// A run that is over, with its scenario.
typedef struct finished_run {
    const scenario *scenario;
    run_result result;
} finished_run;

// --- what is printed -------------------------------------------------------------------

// The value of a parameter as text.
static const char *value_text(const parameters *p, const char *path,
                              char text[VALUE_TEXT])
{
    parameter_format(p, parameter_index(path), text, VALUE_TEXT);
    return text;
}

// What is simulated, and how.
static void print_setup(const scenario *s)
{
    const parameters *p = &s->parameters;
    char model[VALUE_TEXT], joint[VALUE_TEXT], method[VALUE_TEXT];
    char wall[VALUE_TEXT] = "no", drive[64];

    // the wall, and what moves the arm
    if (p->wall.kind != WALL_NONE) {
        value_text(p, "wall.kind", wall);
    }
    if (p->control.law != LAW_NONE) {
        snprintf(drive, sizeof drive, "law %s", control_law_table[p->control.law].word);
    } else {
        snprintf(drive, sizeof drive, "%g V", p->motor.voltage);
    }

    say_title(s);
    printf("%s model, %d link%s, %s hub, %s wall, %s, method %s, h = %g s, %g s\n\n",
           value_text(p, "arm.model", model), p->arm.links,
           plural_ending((size_t)p->arm.links), value_text(p, "arm.hub_joint", joint),
           wall, drive, value_text(p, "method.name", method), p->method.step,
           p->run.duration);
}

// What has to be said of a number: a rigid contact stops the last link at once, the
// lighter the more links there are, and presses the harder after it.
static const char *remark_on(const parameters *p, int index)
{
    const bool is_peak = index == SUMMARY_INDEX(peak_force_N) ||
                         index == SUMMARY_INDEX(first_pulse_peak_N);
    const bool is_chain_on_rigid_wall = p->arm.links > 2 && p->wall.contact == WALL_RIGID;
    if (is_peak && is_chain_on_rigid_wall) {
        return ", no limit as the links grow";
    }
    return "";
}

// The numbers of the run; those that only some runs have are left out where they are
// missing.
static void print_quantities(const parameters *p, const summary *m)
{
    for (int i = 0; i < summary_count; i++) {
        const summary_info *quantity = &summary_table[i];
        const double value = summary_value(m, i);

        // one that did not occur, a count, or a number with a unit
        if (isnan(value)) {
            if (!quantity->special) {
                printf("  %-28s           -\n", quantity->label);
            }
        } else if (quantity->unit[0] == '\0') {
            printf("  %-28s  %10.0f\n", quantity->label, value);
        } else {
            printf("  %-28s  %10.5g %s%s\n", quantity->label, value, quantity->unit,
                   remark_on(p, i));
        }
    }
}

// What a scripted change did.
static void print_change(const scenario *s, const event *e)
{
    if (e->index < 0 || e->index >= s->action_count) {
        return;
    }
    const action *a = &s->actions[e->index];
    char value[VALUE_TEXT], path[ACTION_PATH];
    action_format_value(a, value, sizeof value);
    say("   %s = %s", action_path(a, path), value);
}

// One event with its instant.
static void print_event(const scenario *s, const event *e)
{
    printf("  %10.6f s  %s", e->time, event_name(e->kind));

    // what its name does not say
    switch (e->kind) {
    case EVENT_IMPACT:
        printf("   %.4g N s at %.4g m/s, %.4g J lost", e->impulse, e->speed, e->loss);
        break;
    case EVENT_PUSH:
        printf("     %.4g N s", e->impulse);
        break;
    case EVENT_CHANGE:
        print_change(s, e);
        break;
    default:
        break; // its name says it
    }
    printf("\n");
}

// The first events of a run.
static void print_events(const scenario *s, const trace *t)
{
    size_t shown = t->event_count;
    if (shown > EVENTS_SHOWN) {
        shown = EVENTS_SHOWN;
    }
    if (shown == 0) {
        return;
    }

    // the first ones
    printf("\nEvents:\n");
    for (size_t i = 0; i < shown; i++) {
        print_event(s, &t->events[i]);
    }
    if (shown < t->event_count) {
        printf("  ... and %zu more (--json lists all)\n", t->event_count - shown);
    }
}

// What stands before an expectation.
static const char *expectation_mark(bool is_met)
{
    if (terminal_has_utf8()) {
        return is_met ? "\u2713" : "\u2717";
    }
    return is_met ? "ok " : "NOT MET";
}

// What was expected of a quantity, and what it came to.
static void print_expectation(const expectation *e, double value)
{
    const summary_info *quantity = &summary_table[e->quantity];
    char found[64] = "none", wanted[64] = "none";
    if (!isnan(value)) {
        snprintf(found, sizeof found, "%.5g%s%s", value, blank_before(quantity->unit),
                 quantity->unit);
    }
    if (!e->is_null) {
        snprintf(wanted, sizeof wanted, "%g within %g", e->value, e->tolerance);
    }
    printf("  %s %s: %s (expected %s)\n", expectation_mark(expectation_is_met(e, value)),
           quantity->label, found, wanted);
}

// What the scenario expects, each met or not.
static void print_expectations(const scenario *s, const summary *m)
{
    if (s->expectation_count == 0) {
        return;
    }
    printf("\nExpected:\n");
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        print_expectation(e, summary_value(m, e->quantity));
    }
}

// A run as text: its setup, numbers, events and expectations.
static void print_run(const void *found)
{
    const finished_run *run = found;
    const scenario *s = run->scenario;
    const summary *m = &run->result.summary;
    print_setup(s);

    // what failed before its first step has no numbers: the sentence that follows says
    // why
    if (m->status != STATUS_OK && m->steps == 0) {
        return;
    }
    print_quantities(&s->parameters, m);
    print_events(s, &run->result.trace);
    print_expectations(s, m);
}

// --- files -----------------------------------------------------------------------------

static json_t *run_json(const void *found)
{
    const finished_run *run = found;
    return export_run(run->scenario, &run->result);
}

static int plot_signals(const arguments *a, const void *found)
{
    const finished_run *run = found;
    const trace_run shown = {.scenario = run->scenario,
                             .result = &run->result,
                             .name = run->scenario->name};
    return publish_runs(a, NULL, &shown, 1);
}

// Writes the picture of the arm, and what else is asked for. Returns the exit status.
static int write_run_results(const arguments *a, const finished_run *run, bool whole)
{
    static const command_results results = {.json = run_json,
                                            .text = print_run,
                                            .plot = plot_signals,
                                            .draws_part = true};
    int result = EXIT_DONE;
    if (a->scene != NULL) {
        result = write_scene(a, run->scenario, &run->result);
    }
    return worse(result, write_results(a, &results, run, whole));
}

// --- what is said of the run -----------------------------------------------------------

// Says how a run ended that did not go well. Returns the exit status.
static int report_ending(const finished_run *run, status code)
{
    const char *name = run->scenario->name;
    const summary *m = &run->result.summary;

    // it was ended before its time
    if (code == STATUS_STOPPED) {
        return run_stopped(run->scenario, "the results are those of this time");
    }

    // it failed
    if (code != STATUS_OK) {
        const char *why = m->message;
        if (why[0] == '\0') {
            why = status_text(code);
        }
        complain("%s failed: %s", name, why);
        if (code == STATUS_BAD_SCENARIO) {
            return EXIT_BAD_ARGUMENTS;
        }
        return EXIT_FAILED;
    }

    // it came to its end
    if (m->inaccurate) {
        complain("%s is inaccurate: %s", name, m->message);
        return EXIT_FAILED;
    }
    if (m->message[0] != '\0') {
        print_printable(stderr, "impactlab: note: %s\n", m->message);
    }
    return EXIT_DONE;
}

// Says that a long chain which nothing damps takes long: its fastest modes never die out,
// and each takes steps of its own.
static void note_undamped_chain(const parameters *p)
{
    enum { LONG = 32 };
    const bool is_damped = p->arm.damping_ratio > 0 || p->arm.modal_ratios[0] != '\0' ||
                           p->arm.joint_damping[0] != '\0';
    if (p->arm.links >= LONG && !is_damped && p->method.name == METHOD_EVENT) {
        fprintf(stderr,
                "impactlab: note: nothing damps the %d links: with arm.damping_ratio = "
                "1e-4 a run takes a quarter of the time with 32 links and a tenth with "
                "64, its impulse changes by less than 1 %%\n",
                p->arm.links);
    }
}

// Says which values had no effect, where the amplifier cut off the voltage, and what
// takes long.
static void print_notes(const scenario *s)
{
    note_undamped_chain(&s->parameters);
    idle_value idle;
    for (int place = 0; effect_next_idle(s, &place, &idle);) {
        print_printable(stderr, "impactlab: note: %s has no effect: %s\n", idle.path,
                        idle.why);
    }

    // what the amplifier makes of a voltage beyond its limit changes the run
    const motor_parameters *m = &s->parameters.motor;
    if (s->parameters.control.law == LAW_NONE && fabs(m->voltage) > m->voltage_limit) {
        fprintf(stderr,
                "impactlab: note: motor.voltage = %g V is beyond "
                "motor.voltage_limit: the amplifier gets %g V\n",
                m->voltage, motor_limited_voltage(m, m->voltage));
    }
}

// Opens the tables that are asked for. Returns the exit status.
static int open_tables(const arguments *a, const scenario *s, run_tables **tables)
{
    const run_tables_order order = {.csv = a->csv,
                                    .parquet = a->parquet,
                                    .mat = a->mat,
                                    .columns = a->columns,
                                    .every = a->every};
    fault f = {0};
    switch (run_tables_open(tables, s, &order, &f)) {
    case STATUS_OK:
        return EXIT_DONE;
    case STATUS_BAD_ARGUMENT:
        return complain("--columns %s: %s", a->columns, f.text);
    default:
        return complain_fault(&f);
    }
}

// Runs a scenario, writes its results and says what is to be said of it. Returns the exit
// status.
static int run_and_report(const arguments *a, scenario *s)
{
    // what the file expects is said of its own parameters, not of changed ones
    if (a->sets.count > 0) {
        s->expectation_count = 0;
    }

    // the tables, whose rows are written while they come; a pipe may wait for its reader
    interrupts_catch();
    run_tables *tables;
    int result = open_tables(a, s, &tables);
    if (result != EXIT_DONE) {
        return result;
    }
    finished_run run = {.scenario = s};
    run_options options = {.keep_trace = a->plot != NULL || a->scene != NULL};
    run_tables_observe(tables, &options);
    const status code = run_with_progress(a, s, options, &run.result);

    // results are written of a run that failed, too
    if (run_tables_close(tables, complain_sentence, NULL) != STATUS_OK) {
        result = EXIT_FAILED;
    }
    result = worse(result, write_run_results(a, &run, code != STATUS_STOPPED));
    result = worse(result, report_ending(&run, code));
    print_notes(s);
    if (code == STATUS_OK &&
        run_check_expectations(s, &run.result, report_to_stderr, NULL) > 0) {
        result = worse(result, EXIT_FAILED);
    }

    run_finish(&run.result);
    return result;
}

// Refuses what is asked of tables where there are none, and bytes on a screen. Returns
// the exit status.
static int check_tables(const arguments *a)
{
    const bool any = a->csv != NULL || a->parquet != NULL || a->mat != NULL;
    if (a->every > 0 && !any) {
        return complain("--every is for --csv, --parquet and --mat, and none of them is "
                        "asked for");
    }
    if (a->columns != NULL && !any) {
        return complain("--columns is for --csv, --parquet and --mat, and none of them "
                        "is asked for");
    }
    const int ended = refuse_bytes_on_screen("parquet", a->parquet);
    return worse(ended, refuse_bytes_on_screen("mat", a->mat));
}

// Checks what is asked for, before anything is simulated, and runs the scenario.
static int check_and_run(const arguments *a)
{
    figure_options pictures;
    int ended = check_tables(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = check_scene(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    ended = read_picture_options(a, &pictures);
    if (ended != EXIT_DONE) {
        return ended;
    }
    return with_scenario(a->operands[0], a, run_and_report);
}

static const option_row rows[] = {
    OPTION(RESULT, "csv", "FILE|-", "write the recorded signals, one row a step",
           PLACE(csv)),
    OPTION(RESULT, "parquet", "FILE.parquet",
           "write them for pandas, polars, DuckDB or Spark", PLACE(parquet)),
    OPTION(RESULT, "mat", "FILE.mat", "write them for MATLAB, Octave or scipy",
           PLACE(mat)),
    OPTION(NUMBER, "every", "DT",
           "one row every DT [s] in these tables, in the place of all that are recorded",
           PLACE(every), .low = 1e-9, .high = 1e5, .unit = "s"),
    OPTION(TEXT, "columns", "A,B", "only these signals in these tables, in this order",
           PLACE(columns)),
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}", "draw the recorded signals",
           PLACE(plot)),
    OPTION(PLACE, "scene", "FILE.png", "draw the arm", PLACE(scene)),
    OPTION(NUMBERS, "at", "T", "draw the arm at this instant [s] (may be repeated)",
           PLACE(instants), .high = 1e5),
};

const command run_command = {
    .name = "run",
    .group = GROUP_ONE_RUN,
    .summary = "Simulate a scenario and sum it up",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "SCENARIO is a name from impactlab list, or a file. What a scenario file expects "
        "is checked unless\n"
        "--set changed something. A run that fails still writes what it has until then, "
        "and so does one that ^C ends (exit status 130). On a terminal a run of more "
        "than a second\n"
        "shows its progress.\n"
        "The scene shows the arm at every --at, or from the start to the peak force of "
        "the first pulse.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options, &signal_options, &view_options},
    .run = check_and_run,
};

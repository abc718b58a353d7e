// impactlab calibrate: stiffness from presses against the wall, command by command.
#include "ui/commands/command.h"

#include <glib.h>
#include <math.h>
#include <stdio.h>

#include "src/base/numbers.h"
#include "src/study/calibrate.h"
#include "src/study/sweep.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

#define VOLTAGE_PATH     "control.approach_voltage"
#define NOTEWORTHY_DRIFT 0.01 // of K2 at the end of a press
enum { DEFAULT_PRESSES = 8 };

// --- the commands ----------------------------------------------------------------------

// The range of the commands, as --vary gives it; without it evenly spaced up to nine
// tenths of the largest there is. To be freed with g_free; complains and returns NULL if
// another path is varied.
static char *choose_range(const arguments *a, const scenario *s)
{
    if (a->varies.count == 0) {
        char range[128];
        const double most = 0.9 * s->parameters.motor.voltage_limit;
        decimal_print(range, sizeof range, VOLTAGE_PATH "=%.17g:%.17g:%d",
                      most / DEFAULT_PRESSES, most, DEFAULT_PRESSES);
        return g_strdup(range);
    }

    // the command, and nothing else
    const char *given = a->varies.items[0];
    if (a->varies.count > 1 || !g_str_has_prefix(given, VOLTAGE_PATH "=")) {
        complain("calibrate varies " VOLTAGE_PATH " and nothing else, once");
        return NULL;
    }
    return g_strdup(given);
}

// The commands of a range. Returns the exit status.
static int list_commands(const scenario *s, char *range, double commands[K2_TABLE_MOST],
                         int *count)
{
    SCOPED(sweep_finish) sweep series;
    const sweep_request request = {.vary = &range, .vary_count = 1};
    fault f = {0};
    if (sweep_init(&series, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // as many as a table holds
    if (series.run_count > K2_TABLE_MOST) {
        return complain("--vary %s: %zu commands are too many, expected at most %d",
                        range, series.run_count, K2_TABLE_MOST);
    }
    *count = (int)series.run_count;
    for (int i = 0; i < *count; i++) {
        commands[i] = sweep_value(&series, (size_t)i, 0);
    }
    return EXIT_DONE;
}

// --- results ---------------------------------------------------------------------------

// A calibration, its table as text, and the scenario with it.
typedef struct calibrated {
    const scenario *scenario;
    calibration points;
    char table[PARAMETER_TEXT_SIZE];
    scenario with_table;
} calibrated;

// A line of the table. Returns whether K2 still moves at its end.
static bool print_point(const calibration_point *p)
{
    const bool drifts = fabs(p->drift) > NOTEWORTHY_DRIFT;
    printf("  %9.4g  %9.4g  %11.5g  %11.4g  %9.4f  %9.2g  %9.2g", p->command, p->force,
           p->angle, p->k2, p->k2_over_arm, p->force_spread, p->angle_spread);
    if (drifts) {
        printf(" *");
    }
    printf("\n");
    return drifts;
}

// The table of all presses, and how to use it.
static void print_presses(const void *found)
{
    const calibrated *done = found;
    say_title(done->scenario);

    // one press a line
    printf("\n  %9s  %9s  %11s  %11s  %9s  %9s  %9s\n", "command/V", "force/N", "hub/rad",
           "K2/(Nm/rad)", "K2/arm.k2", "+-force/N", "+-hub/rad");
    bool any_drifts = false;
    for (int i = 0; i < done->points.count; i++) {
        const bool drifts = print_point(&done->points.points[i]);
        any_drifts = any_drifts || drifts;
    }

    if (any_drifts) {
        printf(
            "\n* K2 still moves by more than %g %%: a longer run.duration settles it\n",
            100 * NOTEWORTHY_DRIFT);
    }
    printf("\n  --set \"control.k2_table=%s\"\n", done->table);
}

static json_t *presses_json(const void *found)
{
    const calibrated *done = found;
    return calibration_json(&done->points, done->scenario->name, done->table);
}

static void write_presses_csv(FILE *stream, const void *found)
{
    const calibrated *done = found;
    calibration_csv(stream, &done->points);
}

static void write_scenario_with_table(FILE *stream, const void *found)
{
    const calibrated *done = found;
    scenario_write(stream, &done->with_table);
}

// --- the command -----------------------------------------------------------------------

// The table of the presses, as text and in the scenario.
static status make_table(calibrated *done, fault *f)
{
    k2_table by_force;
    TRY(calibration_table(&done->points, &by_force, f));
    FAULT_IF(!k2_table_write(&by_force, done->table, sizeof done->table), f,
             STATUS_BAD_ARGUMENT,
             "%d commands make a table of more than %d characters, expected fewer",
             done->points.count, PARAMETER_TEXT_SIZE - 1);
    return parameter_set_text(&done->with_table.parameters,
                              PARAMETER_INDEX(control.k2_table), done->table, f);
}

// The command: presses with each command and makes the table of stiffness.
static int press_and_report(const arguments *a, scenario *s)
{
    g_autofree char *range = choose_range(a, s);
    if (range == NULL) {
        return EXIT_BAD_ARGUMENTS;
    }
    double commands[K2_TABLE_MOST];
    int count = 0;
    const int ended = list_commands(s, range, commands, &count);
    if (ended != EXIT_DONE) {
        return ended;
    }

    static const char of_done[] = "their table is that of these commands only";
    static const command_results results = {.json = presses_json,
                                            .text = print_presses,
                                            .csv = write_presses_csv,
                                            .output = write_scenario_with_table,
                                            .kept = of_done,
                                            .none = of_done};
    calibrated done = {.scenario = s, .with_table = *s};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "presses", count);
    status code = calibrate(s, commands, count, monitor, &done.points, &f);

    // after an interrupt the table is that of the presses before it
    if (code == STATUS_OK || (code == STATUS_STOPPED && done.points.count > 0)) {
        const status made = make_table(&done, &f);
        if (made != STATUS_OK) {
            code = made;
        }
    }
    return work_finish(a, code, &f, &results, &done);
}

static const option_row rows[] = {
    OPTION(RESULT, "csv", "FILE|-", "write a row for each command", PLACE(csv)),
    OPTION(RESULT, "output", "FILE|-", "write the scenario with the table in it",
           PLACE(output), .letter = 'o', .replaces = scenario_is),
};

const command calibrate_command = {
    .name = "calibrate",
    .group = GROUP_CONTROL,
    .summary = "Measure the stiffness that a controller has to believe in, (5.26)",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help = "Presses the arm against the wall with constant commands, eight of them or "
            "those of\n"
            "--vary " VOLTAGE_PATH
            "=a:b:n, and computes K2 = f l / (2 (theta - theta_imp)) from what "
            "force\nsensor and encoder read at rest. -o FILE.yaml writes the "
            "scenario with the table in\ncontrol.k2_table, which every law then "
            "goes by. ^C ends it with what was measured until then (exit\nstatus "
            "130); -o writes only the whole table.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options},
    .use = press_and_report,
};

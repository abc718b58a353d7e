// impactlab calibrate: stiffness from presses against the wall, command by command.
#include "ui/commands/command.h"

#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/study/calibrate.h"
#include "src/study/sweep.h"
#include "ui/commands/progress.h"

#define VOLTAGE_PATH "control.approach_voltage"
enum { DEFAULT_PRESSES = 8 };
#define DRIFT_WORTH_A_WORD 0.01

// The commands: those of --vary, or evenly spaced up to nine tenths of the largest there
// is.
static int choose_commands(const arguments *a, const scenario *s, double *commands,
                           int *count)
{
    char standard[128], *given = standard;
    double most = 0.9 * s->parameters.motor.voltage_limit;

    // without --vary an even series up to nine tenths of the limit
    decimal_print(standard, sizeof standard, VOLTAGE_PATH "=%.17g:%.17g:%d",
                  most / DEFAULT_PRESSES, most, DEFAULT_PRESSES);
    if (a->varies.count > 0) {
        given = a->varies.items[0];
    }

    if (a->varies.count > 1 ||
        strncmp(given, VOLTAGE_PATH "=", strlen(VOLTAGE_PATH "=")) != 0) {
        return complain("calibrate varies " VOLTAGE_PATH " and nothing else, once");
    }

    SCOPED(sweep_finish) sweep series;
    const sweep_request request = {.vary = &given, .vary_count = 1};
    fault f = {0};
    if (sweep_init(&series, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // the values, as many as a table holds
    if (series.run_count > K2_TABLE_MOST) {
        return complain("--vary %s: %zu commands are too many, expected at most %d",
                        given, series.run_count, K2_TABLE_MOST);
    }
    *count = (int)series.run_count;
    for (int i = 0; i < *count; i++) {
        commands[i] = sweep_value(&series, (size_t)i, 0);
    }
    return EXIT_DONE;
}

// A calibration, its table as text, and the scenario with it.
typedef struct calibrated {
    calibration points;
    char table[PARAMETER_TEXT_SIZE];
    scenario with_table;
} calibrated;

static void print_points(const scenario *s, const void *found)
{
    const calibrated *done = found;
    const calibration *c = &done->points;
    say_title(s);
    printf("\n  %9s  %9s  %11s  %11s  %9s  %9s  %9s\n", "command/V", "force/N", "hub/rad",
           "K2/(Nm/rad)", "K2/arm.k2", "+-force/N", "+-hub/rad");

    bool drifts = false;
    for (int i = 0; i < c->count; i++) {
        const calibration_point *p = &c->points[i];
        bool moved = fabs(p->drift) > DRIFT_WORTH_A_WORD;
        printf("  %9.4g  %9.4g  %11.5g  %11.4g  %9.4f  %9.2g  %9.2g%s\n", p->command,
               p->force, p->angle, p->k2, p->k2_over_arm, p->force_spread,
               p->angle_spread, moved ? " *" : "");
        drifts |= moved;
    }

    if (drifts) {
        printf(
            "\n* K2 still moves by more than %g %%: a longer run.duration settles it\n",
            100 * DRIFT_WORTH_A_WORD);
    }

    printf("\n  --set \"control.k2_table=%s\"\n", done->table);
}

RESULT_GIVEN(json_t *, points_json, calibrated,
             return calibration_json(&found->points, s->name, found->table))
RESULT_WRITER(write_points, calibrated, calibration_csv(stream, &found->points))
RESULT_WRITER(write_scenario, calibrated, scenario_write(stream, &found->with_table))

// The table of the presses, as text and in the scenario.
static status make_table(calibrated *done, const scenario *s, fault *f)
{
    k2_table by_force;
    done->with_table = *s;
    TRY(calibration_table(&done->points, &by_force, f));
    FAULT_IF(!k2_table_write(&by_force, done->table, sizeof done->table), f,
             STATUS_BAD_ARGUMENT,
             "%d commands make a table of more than %d characters, expected fewer",
             done->points.count, PARAMETER_TEXT_SIZE - 1);
    return parameter_set_text(&done->with_table.parameters,
                              PARAMETER_INDEX(control.k2_table), done->table, f);
}

static int press_and_report(const arguments *a, scenario *s)
{
    static const char kept[] = "their table is that of these commands only";
    static const command_results r = {points_json,         print_points,
                                      .csv = write_points, .output = write_scenario,
                                      .kept = kept,        .none = kept};
    fault f = {0};
    calibrated done;
    double commands[K2_TABLE_MOST];
    int count = 0;
    int ended = choose_commands(a, s, commands, &count);
    if (ended != EXIT_DONE) {
        return ended;
    }

    run_monitor *monitor = work_begin(a, "presses", count);
    status code = calibrate(s, commands, count, monitor, &done.points, &f);
    if (code == STATUS_OK || (code == STATUS_STOPPED && done.points.count > 0)) {
        const status made = make_table(&done, s, &f);
        if (made != STATUS_OK) {
            code = made;
        }
    }
    return work_finish(a, code, &f, &r, s, &done);
}

static const option_row rows[] = {
    OPTION(RESULT, "csv", "FILE|-", "write a row for each command", PLACE(csv)),
    OPTION(RESULT, "output", "FILE|-", "write the scenario with the table in it",
           PLACE(output), .letter = 'o', .replaces = scenario_is),
};

const command calibrate_command = {
    CALLED("calibrate", CONTROL,
           "Measure the stiffness that a controller has to believe in, (5.26)"),
    ONE_SCENARIO,
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

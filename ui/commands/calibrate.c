#include "ui/commands/command.h"

#include <math.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/study/calibrate.h"
#include "src/study/sweep.h"
#include "ui/commands/run_progress.h"

#define VOLTAGE_PATH "control.approach_voltage"
enum { DEFAULT_PRESSES = 8 };
#define DRIFT_WORTH_A_WORD 0.01

// The commands: those of --vary, or evenly spaced up to nine tenths of the largest there is.
static int choose_commands(const arguments *a, const scenario *s, double *commands, int *count)
{
    char standard[128], *given = standard;
    double most = 0.9 * s->parameters.motor.voltage_limit;
    fault f = {0};
    sweep series;

    // without --vary an even series up to nine tenths of the limit
    decimal_print(standard, sizeof standard, VOLTAGE_PATH "=%.17g:%.17g:%d", most / DEFAULT_PRESSES,
                  most, DEFAULT_PRESSES);
    if (a->varies.count > 0) {
        given = a->varies.items[0];
    }

    if (a->varies.count > 1 || strncmp(given, VOLTAGE_PATH "=", strlen(VOLTAGE_PATH "=")) != 0) {
        return complain("calibrate varies " VOLTAGE_PATH " and nothing else, once");
    }

    sweep_request request = {.vary = &given, .vary_count = 1};
    if (sweep_init(&series, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // the values, as many as a table holds
    size_t wanted = series.run_count;
    for (size_t i = 0; i < wanted && i < K2_TABLE_MOST; i++) {
        commands[i] = sweep_value(&series, i, 0);
    }
    sweep_finish(&series);

    if (wanted > K2_TABLE_MOST) {
        return complain("--vary %s: %zu commands are too many, expected at most %d", given, wanted,
                        K2_TABLE_MOST);
    }
    *count = (int)wanted;
    return EXIT_DONE;
}

static void print_points(const calibration *c, const scenario *s, const char *table)
{
    say_title(s);
    printf("\n  %9s  %9s  %11s  %11s  %9s  %9s  %9s\n", "command/V", "force/N", "hub/rad",
           "K2/(Nm/rad)", "K2/arm.k2", "+-force/N", "+-hub/rad");

    bool drifts = false;
    for (int i = 0; i < c->count; i++) {
        const calibration_point *p = &c->points[i];
        bool moved = fabs(p->drift) > DRIFT_WORTH_A_WORD;
        printf("  %9.4g  %9.4g  %11.5g  %11.4g  %9.4f  %9.2g  %9.2g%s\n", p->command, p->force,
               p->angle, p->k2, p->k2 / s->parameters.arm.k2, p->force_spread, p->angle_spread,
               moved ? " *" : "");
        drifts |= moved;
    }

    if (drifts) {
        printf("\n* K2 still moves by more than %g %%: a longer run.duration settles it\n",
               100 * DRIFT_WORTH_A_WORD);
    }

    printf("\n  --set \"control.k2_table=%s\"\n", table);
}

static int write_table(const char *path, const calibration *c, const scenario *s)
{
    whole_file file;
    fault f = {0};
    status code = whole_file_open(&file, path, &f);
    if (code == STATUS_OK) {
        calibration_csv(file.stream, c, s);
        code = whole_file_commit(&file, &f);
    }
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

// The scenario as it was given, with the table in it.
static int write_scenario(const char *path, const scenario *s, const char *table)
{
    whole_file file;
    fault f = {0};
    scenario calibrated = *s;
    status code =
        parameter_set_text(&calibrated.parameters, PARAMETER_INDEX(control.k2_table), table, &f);
    code = code == STATUS_OK ? whole_file_open(&file, path, &f) : code;
    if (code == STATUS_OK) {
        scenario_write(file.stream, &calibrated);
        code = whole_file_commit(&file, &f);
    }
    return code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
}

static int report(const arguments *a, const scenario *s, const calibration *c, bool whole)
{
    char table[PARAMETER_TEXT_SIZE];
    fault f = {0};
    k2_table by_force;
    int result = EXIT_DONE;

    if (calibration_table(c, &by_force, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (!k2_table_write(&by_force, table, sizeof table)) {
        return complain("%d commands make a table of more than %d characters, expected fewer",
                        c->count, PARAMETER_TEXT_SIZE - 1);
    }

    // every result is tried even if another one fails; the scenario needs the whole table
    if (a->json != NULL && write_json(a->json, calibration_json(c, s, table)) != EXIT_DONE) {
        result = EXIT_FAILED;
    }
    if (a->csv != NULL && write_table(a->csv, c, s) != EXIT_DONE) {
        result = EXIT_FAILED;
    }
    if (a->output != NULL && whole && write_scenario(a->output, s, table) != EXIT_DONE) {
        result = EXIT_FAILED;
    }

    if (summary_wanted(a)) {
        print_points(c, s, table);
    }
    return result;
}

static int press_and_report(const arguments *a, scenario *s)
{
    fault f = {0};
    calibration c;
    double commands[K2_TABLE_MOST];
    int count = 0, result = choose_commands(a, s, commands, &count);
    if (result != EXIT_DONE) {
        return result;
    }

    status code = calibrate(s, commands, count, work_begin(a, "presses", count), &c, &f);
    work_end();
    if (code == STATUS_STOPPED) {
        if (c.count > 0) {
            report(a, s, &c, false);
        }
        work_leave(c.count, count, "presses", "their table is that of these commands only");
    }
    return code == STATUS_OK ? report(a, s, &c, true) : complain_fault(&f);
}

static int calibrate_command_run(const arguments *a)
{
    return with_scenario(a->operands[0], a, press_and_report);
}

static const option_row rows[] = {
    {.name = "csv",
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write a row for each command",
     PLACE(csv)},
    {.name = "output",
     .letter = 'o',
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write the scenario with the table in it",
     PLACE(output)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command calibrate_command = {
    .name = "calibrate",
    .group = GROUP_CONTROL,
    .operands = "SCENARIO",
    .summary = "Measure the stiffness that a controller has to believe in, (5.26)",
    .help =
        "Presses the arm against the wall with constant commands, eight of them or those of\n"
        "--vary " VOLTAGE_PATH "=a:b:n, and computes K2 = f l / (2 (theta - theta_imp)) from "
        "what force\nsensor and encoder read at rest. -o FILE.yaml writes the scenario with the "
        "table in\ncontrol.k2_table, which every law then goes by. ^C ends it with what was "
        "measured "
        "until then (exit\nstatus 130); -o writes only the whole table.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &vary_options, &json_options, &options, &quiet_options},
    .run = calibrate_command_run,
};

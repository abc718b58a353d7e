// impactlab run: one run, its numbers, events and expectations.
#include "ui/commands/command.h"

#include "render/page/picture_file.h"
#include "src/run/export.h"

#include <math.h>

#include "src/arm/arm.h"
#include "src/base/words.h"
#include "src/scenario/effect.h"
#include "src/tables/parameters.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

enum { EVENTS_SHOWN = 16 };

// The value of a parameter as text; text has 128 bytes.
static const char *value_text(const parameters *p, const char *path, char *text)
{
    parameter_format(p, parameter_index(path), text, 128);
    return text;
}

// What has to be said of a number: a rigid contact stops the last link at once, the
// lighter the more links there are, and presses the harder after it.
static const char *remark_on(const parameters *p, int index)
{
    const bool peak = index == SUMMARY_INDEX(peak_force_N) ||
                      index == SUMMARY_INDEX(first_pulse_peak_N);
    const bool chain = p->arm.links > 2 && p->wall.contact == WALL_RIGID;
    if (peak && chain) {
        return ", no limit as the links grow";
    }
    return "";
}

static void print_quantities(const parameters *p, const summary *m)
{
    for (int i = 0; i < summary_count; i++) {
        const char *label = summary_table[i].label, *unit = summary_table[i].unit;
        double value = summary_value(m, i);
        if (isnan(value) && summary_table[i].special) {
            continue;
        }
        if (isnan(value)) {
            printf("  %-28s           -\n", label);
        } else if (unit[0] == '\0') {
            printf("  %-28s  %10.0f\n", label, value);
        } else {
            printf("  %-28s  %10.5g %s%s\n", label, value, unit, remark_on(p, i));
        }
    }
}

static void print_event(const scenario *s, const event *e)
{
    printf("  %10.6f s  %s", e->time, event_name(e->kind));

    // what it changed, as far as its name does not say
    if (e->kind == EVENT_IMPACT) {
        printf("   %.4g N s at %.4g m/s, %.4g J lost", e->impulse, e->speed, e->loss);
    } else if (e->kind == EVENT_PUSH) {
        printf("     %.4g N s", e->impulse);
    } else if (e->kind == EVENT_CHANGE && e->index >= 0 && e->index < s->action_count) {
        char value[128], path[ACTION_PATH];
        const action *a = &s->actions[e->index];
        action_format_value(a, value, sizeof value);
        say("   %s = %s", action_path(a, path), value);
    }
    printf("\n");
}

static void print_events(const scenario *s, const trace *t)
{
    size_t shown = t->event_count > EVENTS_SHOWN ? EVENTS_SHOWN : t->event_count;
    if (shown == 0) {
        return;
    }
    printf("\nEvents:\n");
    for (size_t i = 0; i < shown; i++) {
        print_event(s, &t->events[i]);
    }
    if (shown < t->event_count) {
        printf("  ... and %zu more (--json lists all)\n", t->event_count - shown);
    }
}

static void print_expectations(const scenario *s, const summary *m)
{
    // of one that is not met, of one that is
    static const char *const words[] = {"NOT MET", "ok "};
    static const char *const ticks[] = {"\u2717", "\u2713"};
    const char *const *marks = words;
    if (s->expectation_count == 0) {
        return;
    }
    if (terminal_has_utf8()) {
        marks = ticks;
    }

    printf("\nExpected:\n");
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        char found[64], wanted[64];
        const char *label = summary_table[e->quantity].label;
        const char *unit = summary_table[e->quantity].unit, *space = blank_before(unit);

        double value = summary_value(m, e->quantity);
        bool met = expectation_is_met(e, value);

        snprintf(found, sizeof found, isnan(value) ? "none" : "%.5g%s%s", value, space,
                 unit);
        snprintf(wanted, sizeof wanted, e->is_null ? "none" : "%g within %g", e->value,
                 e->tolerance);

        printf("  %s %s: %s (expected %s)\n", marks[met], label, found, wanted);
    }
}

RESULT_GIVEN(json_t *, run_json, run_result, return export_run(s, found))
RESULT_WRITER(write_signals, run_result,
              export_csv(stream, &found->trace, s->parameters.arm.links))

static int plot_signals(const arguments *a, const scenario *s, const void *found)
{
    const trace_run shown = {.scenario = s, .result = found, .name = s->name};
    return publish_runs(a, NULL, &shown, 1);
}

static void print_run(const scenario *s, const void *found)
{
    const run_result *result = found;
    char model[128], joint[128], wall[128], method[128];
    const parameters *p = &s->parameters;
    char drive[64];
    snprintf(drive, sizeof drive, "%g V", p->motor.voltage);
    if (p->control.law != LAW_NONE) {
        snprintf(drive, sizeof drive, "law %s", control_law_table[p->control.law].word);
    }
    snprintf(wall, sizeof wall, "no");
    if (p->wall.kind != WALL_NONE) {
        value_text(p, "wall.kind", wall);
    }
    say_title(s);
    printf("%s model, %d link%s, %s hub, %s wall, %s, method %s, h = %g s, %g s\n\n",
           value_text(p, "arm.model", model), p->arm.links,
           plural_ending((size_t)p->arm.links), value_text(p, "arm.hub_joint", joint),
           wall, drive, value_text(p, "method.name", method), p->method.step,
           p->run.duration);

    // what failed before its first step has no numbers: the sentence that follows says
    // why
    if (result->summary.status != STATUS_OK && result->summary.steps == 0) {
        return;
    }
    print_quantities(&s->parameters, &result->summary);
    print_events(s, &result->trace);
    print_expectations(s, &result->summary);
}

static int run_and_report(const arguments *a, scenario *s)
{
    run_result result;
    bool keep_trace = a->csv != NULL || a->plot != NULL || a->scene != NULL;

    // what the file expects is said of its own parameters, not of changed ones
    if (a->sets.count > 0) {
        s->expectation_count = 0;
    }
    status code = run_with_progress(a, s, keep_trace, &result);

    // results are written of a run that failed, too
    static const command_results r = {run_json, print_run, plot_signals, write_signals,
                                      .draws_part = true};
    int exit_status = EXIT_DONE;
    if (a->scene != NULL) {
        exit_status = write_scene(a, s, &result);
    }
    exit_status =
        worse(exit_status, write_results(a, &r, s, &result, code != STATUS_STOPPED));

    if (code == STATUS_STOPPED) {
        exit_status = run_stopped(s, "the results are those of this time");
    } else if (code != STATUS_OK) {
        complain("%s failed: %s", s->name,
                 result.summary.message[0] ? result.summary.message : status_text(code));
        if (code == STATUS_BAD_SCENARIO) {
            exit_status = worse(exit_status, EXIT_BAD_ARGUMENTS);
        } else {
            exit_status = worse(exit_status, EXIT_FAILED);
        }
    } else if (result.summary.inaccurate) {
        complain("%s is inaccurate: %s", s->name, result.summary.message);
        exit_status = worse(exit_status, EXIT_FAILED);
    } else if (result.summary.message[0] != '\0') {
        print_printable(stderr, "impactlab: note: %s\n", result.summary.message);
    }

    idle_value idle;
    for (int place = 0; effect_next_idle(s, &place, &idle);) {
        print_printable(stderr, "impactlab: note: %s has no effect: %s\n", idle.path,
                        idle.why);
    }

    // what the amplifier makes of a voltage beyond its limit changes the run: say so
    const motor_parameters *m = &s->parameters.motor;
    if (s->parameters.control.law == LAW_NONE && fabs(m->voltage) > m->voltage_limit) {
        fprintf(stderr,
                "impactlab: note: motor.voltage = %g V is beyond "
                "motor.voltage_limit: the amplifier gets %g V\n",
                m->voltage, motor_limited_voltage(m, m->voltage));
    }
    if (code == STATUS_OK &&
        run_check_expectations(s, &result, report_to_stderr, NULL) > 0) {
        exit_status = worse(exit_status, EXIT_FAILED);
    }

    run_finish(&result);
    return exit_status;
}

static int run(const arguments *a)
{
    figure_options pictures;
    int ended = check_scene(a);
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
    OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}", "draw the recorded signals",
           PLACE(plot)),
    OPTION(PLACE, "scene", "FILE.png", "draw the arm", PLACE(scene)),
    OPTION(NUMBERS, "at", "T", "draw the arm at this instant [s] (may be repeated)",
           PLACE(instants), .high = 1e5),
};

const command run_command = {
    CALLED("run", ONE_RUN, "Simulate a scenario and sum it up"),
    ONE_SCENARIO,
    .help = "SCENARIO is a name from impactlab list, or a file. What a scenario "
            "file expects is checked unless\n--set changed something. A run that "
            "fails still writes what it has until then, and so does one that ^C "
            "ends (exit status 130). On a terminal a run of more than a "
            "second\ntells how far it is.\nThe scene shows the arm at every "
            "--at, or from the start to the peak force of the first pulse.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows), &quiet_options,
                &page_options, &view_options},
    .run = run,
};

// impactlab show: the resolved parameters of a scenario, its script and what it expects.
#include "ui/commands/command.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/export.h"
#include "src/tables/settings.h"
#include "src/tables/summary.h"
#include "ui/commands/answers.h"
#include "ui/commands/reference.h"
#include "ui/commands/results.h"

enum { DESCRIPTION_WIDTH = 96 };

// One line of the table of parameters.
typedef struct shown_parameter {
    const char *path;
    bool is_given; // by the scenario or --set
    const char *value, *unit, *range, *description;
} shown_parameter;

// Widths of the table's columns, and where each but the last ends.
enum { PATH_WIDTH = 33, VALUE_WIDTH = 20, UNIT_WIDTH = 9, RANGE_WIDTH = 32 };
enum {
    VALUE_END = PATH_WIDTH + 3 + VALUE_WIDTH,
    UNIT_END = VALUE_END + 1 + UNIT_WIDTH,
    RANGE_END = UNIT_END + 2 + RANGE_WIDTH,
};

// A cell, to the left where its width is negative. The column ends at `end`; behind a
// text that is longer the row goes on in the next line.
static void print_aligned(const char *text, int width, int end)
{
    say("%*s", width, text);
    if ((int)strlen(text) > abs(width)) {
        say("\n%*s", end, "");
    }
}

static void print_parameter_row(const char *mark, const shown_parameter *p)
{
    say("%-*s %s ", PATH_WIDTH, p->path, mark);
    print_aligned(p->value, VALUE_WIDTH, VALUE_END);
    say(" ");
    print_aligned(p->unit, -UNIT_WIDTH, UNIT_END);
    say("  ");
    print_aligned(p->range, -RANGE_WIDTH, RANGE_END);
    say("  %s\n", p->description);
}

// Prints a parameter, or with --quiet only one that was given.
static void print_parameter(const arguments *a, const shown_parameter *p)
{
    if (p->is_given) {
        print_parameter_row("=", p);
    } else if (!a->quiet) {
        print_parameter_row(" ", p);
    }
}

// --- numbers of the control law --------------------------------------------------------

// The i-th number of a law, under control.settings. One that is a parameter of its own
// stands in the table instead, unless the settings give it.
static void print_law_setting(const arguments *a, const scenario *s,
                              const controller *law, int i)
{
    const controller_parameter number = controller_parameter_at(law, i);
    char path[PARAMETER_TEXT_SIZE], value[NUMBER_TEXT], range[64];
    double shown = number.initial;
    const bool is_given = settings_get(&s->parameters, number.name, &shown);

    snprintf(path, sizeof path, "control.%s", number.name);
    if (!is_given && parameter_find(path) >= 0) {
        return;
    }

    // its own
    snprintf(path, sizeof path, "control.settings.%s", number.name);
    number_format_short(value, shown);
    snprintf(range, sizeof range, "%g to %g", number.minimum, number.maximum);
    print_parameter(a, &(shown_parameter){path, is_given, value, number.unit, range,
                                          number.description});
}

// The settings as they were given: all that is known of a controller that is loaded when
// the run starts.
static void print_given_settings(const arguments *a, const scenario *s)
{
    const char *rest = s->parameters.control.settings;
    setting given;
    while (settings_next(&rest, &given)) {
        char path[2 * PARAMETER_TEXT_SIZE];
        snprintf(path, sizeof path, "control.settings.%s", given.name);
        print_parameter(a, &(shown_parameter){path, true, given.value, "", "",
                                              setting_info.description});
    }
}

// The numbers of the control law, below the text of control.settings.
static void print_settings(const arguments *a, const scenario *s)
{
    const controller *law = controller_of(s->parameters.control.law);
    if (law == NULL) {
        print_given_settings(a, s);
        return;
    }
    for (int i = 0; i < law->parameter_count; i++) {
        print_law_setting(a, s, law, i);
    }
}

// --- the scenario ----------------------------------------------------------------------

// The table of all parameters, with those of control.settings where that stands.
static void print_parameters(const arguments *a, const scenario *s)
{
    if (!a->quiet) {
        printf("\n= was given, all else is a default\n\n");
        print_parameter_row(" ", &(shown_parameter){.path = "parameter",
                                                    .value = "value",
                                                    .unit = "unit",
                                                    .range = "range",
                                                    .description = "meaning"});
    }

    // the settings follow the text in which they are given
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        char value[128], range[RANGE_TEXT];
        parameter_format(&s->parameters, i, value, sizeof value);
        print_parameter(a, &(shown_parameter){info->path, s->parameters.set[i], value,
                                              info->unit, format_range(info, "|", range),
                                              info->description});
        if (i == PARAMETER_INDEX(control.settings)) {
            print_settings(a, s);
        }
    }
}

// What happens at which instant.
static void print_script(const scenario *s)
{
    printf("\nScript:\n");
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_PUSH) {
            printf("  at %g s: push the tip with %g N s\n", a->time, a->value);
        } else {
            char value[128], path[ACTION_PATH];
            action_format_value(a, value, sizeof value);
            say("  at %g s: %s = %s\n", a->time, action_path(a, path), value);
        }
    }
}

// The quantities that a run of the scenario is checked for.
static void print_expected_values(const scenario *s)
{
    printf("\nExpected:\n");
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        const char *key = summary_table[e->quantity].key;
        if (e->is_null) {
            printf("  %s does not occur\n", key);
        } else {
            printf("  %s = %g within %g\n", key, e->value, e->tolerance);
        }
    }
}

// All values by path, and the paths of those that were given.
static json_t *scenario_json(const scenario *s)
{
    json_t *given = json_array();
    char title[SCENARIO_TITLED];
    for (int i = 0; i < parameter_count; i++) {
        if (s->parameters.set[i]) {
            json_add(given, json_string(parameter_table[i].path));
        }
    }
    return json_of("scenario:t title:t description:t parameters:o given:o", s->name,
                   scenario_titled(s, title), s->description,
                   export_parameters(&s->parameters), given);
}

// Shows a scenario that is open, as text or as JSON. Returns the exit status.
static int show_scenario(const arguments *a, scenario *s)
{
    if (a->json != NULL) {
        return write_json_file(a->json, scenario_json(s));
    }

    if (!a->quiet) {
        say_title(s);
        print_indented(stdout, s->description, (int)strlen(s->description),
                       DESCRIPTION_WIDTH, 0);
    }
    print_parameters(a, s);

    // what else it has
    if (s->action_count > 0) {
        print_script(s);
    }
    if (s->expectation_count > 0) {
        print_expected_values(s);
    }
    return EXIT_DONE;
}

// The command: shows a scenario or, where there is none of that name, what has the name.
static int show_or_explain(const arguments *a)
{
    const int result = with_scenario(a->operands[0], a, show_scenario);

    // "show k2" asks for something that has no file
    if (result == EXIT_BAD_ARGUMENTS && strpbrk(a->operands[0], "/ ") == NULL) {
        print_meanings(stderr, a->commands, a->operands[0]);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(FLAG, "quiet", NULL, "print only what was given, without title and defaults",
           PLACE(quiet), .letter = 'q'),
};

const command show_command = {
    .name = "show",
    .group = GROUP_ONE_RUN,
    .summary = "The resolved parameters of a scenario, with units and ranges",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help = "A parameter marked with = was given by the scenario or by --set, the others "
            "have their defaults.\n",
    .options = {&set_options, &json_options, OWN_OPTIONS(rows)},
    .run = show_or_explain,
};

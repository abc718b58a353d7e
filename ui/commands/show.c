#include "ui/commands/answers.h"
#include "ui/commands/command.h"

#include <string.h>

#include "src/tables/summary.h"
#include "src/tables/parameters.h"
#include "src/base/json.h"
#include "src/run/export.h"

static void print_range(const parameter_info *info)
{
    char text[256];
    if (info->type == PARAMETER_CHOICE) {
        snprintf(text, sizeof text, "%s", info->choices);
    } else if (info->type == PARAMETER_BOOLEAN) {
        snprintf(text, sizeof text, "true|false");
    } else if (info->type == PARAMETER_TEXT) {
        snprintf(text, sizeof text, "text");
    } else if (info->type == PARAMETER_LIST) {
        snprintf(text, sizeof text, "list of %g to %g", info->minimum, info->maximum);
    } else {
        snprintf(text, sizeof text, "%g to %g", info->minimum, info->maximum);
    }
    say("  %-29s", text);
}

static void print_parameter(const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    char value[128];
    parameter_format(p, index, value, sizeof value);
    say("%-33s %c %18s %-9s", info->path, p->set[index] ? '=' : ' ', value, info->unit);
    print_range(info);
    printf("  %s\n", info->description);
}

static void print_actions(const scenario *s)
{
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_PUSH) {
            printf("  at %g s: push the tip with %g N s\n", a->time, a->value);
        } else {
            char value[128];
            action_format_value(a, value, sizeof value);
            say("  at %g s: %s = %s\n", a->time, parameter_table[a->parameter].path, value);
        }
    }
}

static void print_expectations(const scenario *s)
{
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        if (e->is_null) {
            printf("  %s does not occur\n", summary_table[e->quantity].key);
        } else {
            printf("  %s = %g within %g\n", summary_table[e->quantity].key, e->value, e->tolerance);
        }
    }
}

// The same for a program: values by path, and which of them were given.
static json_t *show_object(const scenario *s)
{
    json_t *object = json_object(), *given = json_array();
    char title[SCENARIO_TITLED];

    // defaults are not named
    for (int i = 0; i < parameter_count; i++) {
        if (s->parameters.set[i]) {
            json_add(given, json_string(parameter_table[i].path));
        }
    }

    // what describes it, and all values whether given or not
    json_put(object, "scenario", json_text(s->name));
    json_put(object, "title", json_text(scenario_titled(s, title)));
    json_put(object, "description", json_text(s->description));
    json_put(object, "parameters", export_parameters(&s->parameters));
    json_put(object, "given", given);
    return object;
}

static int print_scenario(const arguments *a, scenario *s)
{
    if (a->json != NULL) {
        return write_json(a->json, show_object(s));
    }
    say_title(s);
    print_wrapped(stdout, s->description, (int)strlen(s->description), 96);

    printf("\n= was given, all else is a default\n\n%-33s   %12s %-9s  %-18s\n", "parameter",
           "value", "unit", "range");
    for (int i = 0; i < parameter_count; i++) {
        print_parameter(&s->parameters, i);
    }

    if (s->action_count > 0) {
        printf("\nScript:\n");
        print_actions(s);
    }

    if (s->expectation_count > 0) {
        printf("\nExpected:\n");
        print_expectations(s);
    }

    return EXIT_DONE;
}

static int show(const arguments *a)
{
    const int result = with_scenario(a->operands[0], a, print_scenario);

    // "show k2" asks for something that has no file
    if (result == EXIT_BAD_ARGUMENTS && strpbrk(a->operands[0], "/ ") == NULL) {
        print_meanings(stderr, a->operands[0]);
    }
    return result;
}

const command show_command = {
    .name = "show",
    .group = GROUP_ONE_RUN,
    .operands = "SCENARIO",
    .summary = "The resolved parameters of a scenario, with units and ranges",
    .help =
        "A parameter marked with = was given by the scenario or by --set, the others have their "
        "defaults.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &json_options},
    .run = show,
};

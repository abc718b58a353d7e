#include "ui/commands/command.h"

#include <string.h>

#include "src/quantities/parameters.h"

static void print_range(const parameter_info *info)
{
    char text[256];
    if (info->type == PARAMETER_CHOICE) {
        snprintf(text, sizeof text, "%s", info->choices);
    } else if (info->type == PARAMETER_BOOLEAN) {
        snprintf(text, sizeof text, "true|false");
    } else if (info->type == PARAMETER_TEXT) {
        snprintf(text, sizeof text, "text");
    } else {
        snprintf(text, sizeof text, "%g to %g", info->minimum, info->maximum);
    }
    printf("  %-29s", text);
}

static void print_parameter(const parameters *p, int index)
{
    const parameter_info *info = &parameter_table[index];
    char value[128];
    parameter_format(p, index, value, sizeof value);
    printf("%-33s %c %18s %-9s", info->path, p->set[index] ? '=' : ' ', value, info->unit);
    print_range(info);
    printf("  %s\n", info->description);
}

// Prints words in lines of at most 96 characters.
static void print_wrapped(const char *text)
{
    int column = 0;
    while (*(text += strspn(text, " \n")) != '\0') {
        int length = (int)strcspn(text, " \n");
        char word[256];
        snprintf(word, sizeof word, "%.*s", length, text);
        int width = text_width(word);
        const char *gap = column == 0 ? "" : column + 1 + width > 96 ? "\n" : " ";
        column = gap[0] == ' ' ? column + 1 + width : width;
        printf("%s%.*s", gap, length, text);
        text += length;
    }
    printf("%s", column > 0 ? "\n" : "");
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
            printf("  at %g s: %s = %s\n", a->time, parameter_table[a->parameter].path, value);
        }
    }
}

static void print_expectations(const scenario *s)
{
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        if (e->is_null) {
            printf("  %s does not occur\n", e->quantity);
        } else {
            printf("  %s = %g within %g\n", e->quantity, e->value, e->tolerance);
        }
    }
}

static int show(const arguments *a)
{
    scenario s;
    int result = open_scenario(&s, a->operands[0], a);
    if (result != EXIT_DONE) {
        return result;
    }
    printf("%s: %s\n", s.name, s.title);
    print_wrapped(s.description);
    printf("\n= was given, all else is a default\n\n%-33s   %12s %-9s  %-18s\n", "parameter",
           "value", "unit", "range");
    for (int i = 0; i < parameter_count; i++) {
        print_parameter(&s.parameters, i);
    }
    if (s.action_count > 0) {
        printf("\nScript:\n");
        print_actions(&s);
    }
    if (s.expectation_count > 0) {
        printf("\nExpected:\n");
        print_expectations(&s);
    }
    scenario_finish(&s);
    return EXIT_DONE;
}

const command show_command = {
    .name = "show",
    .operands = "SCENARIO",
    .options = "s",
    .summary = "The resolved parameters of a scenario, with units and ranges",
    .help =
        "A parameter marked with = was given by the scenario or by --set, the others have their "
        "defaults.\n",
    .least = 1,
    .most = 1,
    .run = show,
};

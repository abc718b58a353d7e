#include "ui/commands/command.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"

// A scenario with faults is listed all the same, without a title.
static void ignore_fault(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

static void print_scenario(const char *name, int width)
{
    scenario s;
    if (scenario_open(&s, name, ignore_fault, NULL) != STATUS_OK) {
        say("%-*s  (has faults, see impactlab check %s)\n", width, name, name);
        return;
    }
    say("%-*s  %s\n", width, name, s.title ? s.title : "");
    scenario_finish(&s);
}

// An object of name and title; the title of one with faults is null.
static json_t *scenario_object(const char *name)
{
    scenario s;
    json_t *object = json_object();
    json_put(object, "name", json_text(name));
    if (scenario_open(&s, name, ignore_fault, NULL) != STATUS_OK) {
        json_put(object, "title", json_null());
        return object;
    }
    json_put(object, "title", json_text(s.title ? s.title : ""));
    scenario_finish(&s);
    return object;
}

static int list(const arguments *a)
{
    char **names;
    int count, width = 0;
    fault f = {0};

    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // for a program
    json_t *all = a->json != NULL ? json_array() : NULL;
    for (int i = 0; i < count && a->json != NULL; i++) {
        json_add(all, scenario_object(names[i]));
    }

    // or for people: titles stand in a column
    for (int i = 0; i < count; i++) {
        int length = (int)strlen(names[i]);
        width = length > width ? length : width;
    }

    for (int i = 0; i < count; i++) {
        if (a->json == NULL) {
            print_scenario(names[i], width);
        }
        free(names[i]);
    }

    free(names);
    return a->json != NULL ? write_json(a->json, all) : EXIT_DONE;
}

const command list_command = {
    .name = "list",
    .group = GROUP_ONE_RUN,
    .operands = "",
    .summary = "Name and title of every scenario",
    .help = "",
    .options = {&json_options},
    .run = list,
};

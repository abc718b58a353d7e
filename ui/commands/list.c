#include "ui/commands/command.h"

#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"

// Adds a line or, for a program, an object of name and title, which is null of one with faults.
// Returns the exit status.
static int list_one(const char *name, int width, json_t *all)
{
    scenario s;
    bool faulty;
    int result = open_listed(&s, name, &faulty);
    if (result != EXIT_DONE) {
        return result;
    }

    // the titles of all stand in a column
    const char *title = faulty || s.title == NULL ? "" : s.title;
    if (all != NULL) {
        json_t *object = json_object();
        json_put(object, "name", json_text(name));
        json_put(object, "title", faulty ? json_null() : json_text(title));
        json_add(all, object);
    } else if (faulty) {
        say("%-*s  (has faults, see impactlab check %s)\n", width, name, name);
    } else {
        say("%-*s  %s\n", width, name, title);
    }
    if (!faulty) {
        scenario_finish(&s);
    }
    return EXIT_DONE;
}

static int list(const arguments *a)
{
    char **names;
    int count, width = 0, result = EXIT_DONE;
    fault f = {0};

    // for a program or for people
    json_t *all = a->json != NULL ? json_array() : NULL;
    if (a->json != NULL && all == NULL) {
        fault_no_memory(&f);
        return complain_fault(&f);
    }
    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        json_decref(all);
        return complain_fault(&f);
    }

    for (int i = 0; i < count; i++) {
        int length = (int)strlen(names[i]);
        width = length > width ? length : width;
    }
    for (int i = 0; i < count; i++) {
        result = worse(result, list_one(names[i], width, all));
        free(names[i]);
    }

    free(names);
    return a->json != NULL ? worse(result, write_json(a->json, all)) : result;
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

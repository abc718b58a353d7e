#include "ui/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"

// A scenario with faults is not listed as a lesson; its faults are reported when it is opened.
static void ignore_fault(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

// Whether a scenario is a lesson; its title if so, "" if not.
static bool read_lesson(const char *name, char *title, size_t size)
{
    scenario s;
    if (scenario_open(&s, name, ignore_fault, NULL) != STATUS_OK) {
        return false;
    }
    const bool found = s.lesson.step_count > 0;
    snprintf(title, size, "%s", found && s.title != NULL ? s.title : "");
    scenario_finish(&s);
    return found;
}

// The last part of a scenario's name.
static const char *leaf_of(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash != NULL ? slash + 1 : name;
}

// Adds a lesson to those listed, as JSON or on the screen.
static void list_lesson(json_t *all, const char *name, const char *title)
{
    if (all == NULL) {
        say("%-20s %s\n", leaf_of(name), title);
        return;
    }
    json_t *object = json_object();
    json_put(object, "name", json_text(leaf_of(name)));
    json_put(object, "scenario", json_text(name));
    json_put(object, "title", json_text(title));
    json_add(all, object);
}

// Opens the lab on a lesson, as the lab command does on a scenario.
static int open_lesson(const arguments *a, char *name)
{
    arguments opened = *a;
    char *operands[] = {name};
    opened.operands = operands;
    opened.operand_count = 1;
    return command_find("lab")->run(&opened);
}

static int run_lesson(const arguments *a)
{
    char **names, title[256];
    int count, code = EXIT_DONE;
    bool found = false;
    fault f = {0};
    if (a->json != NULL && a->operand_count > 0) {
        return complain("--json lists the lessons, expected no name beside it");
    }
    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // without a name all of them, otherwise the one with that name
    const char *wanted = a->operand_count > 0 ? a->operands[0] : NULL;
    json_t *all = a->json != NULL ? json_array() : NULL;
    for (int i = 0; i < count && !found; i++) {
        const bool named = wanted != NULL && (strcmp(names[i], wanted) == 0 ||
                                              strcmp(leaf_of(names[i]), wanted) == 0);
        if ((wanted == NULL || named) && read_lesson(names[i], title, sizeof title)) {
            found = named;
            if (named) {
                code = open_lesson(a, names[i]);
            } else {
                list_lesson(all, names[i], title);
            }
        }
    }
    if (wanted != NULL && !found) {
        code = complain("there is no lesson '%s', 'impactlab lesson' lists them", wanted);
    }

    for (int i = 0; i < count; i++) {
        free(names[i]);
    }
    free(names);
    return wanted == NULL && a->json != NULL ? write_json(a->json, all) : code;
}

const command lesson_command = {
    .name = "lesson",
    .group = GROUP_ONE_RUN,
    .operands = "[NAME]",
    .summary = "Experiments step by step, on the terminal",
    .help = "Opens a lesson in the lab: steps with questions, checked by the run itself. Without a "
            "name it lists them.\nIn the lab y goes on and A answers; :lesson lists the lessons "
            "there.\n",
    .most = 1,
    .options = {&set_options, &json_options, &lab_options, &quiet_options},
    .draws = true,
    .run = run_lesson,
};

#include "ui/commands/command.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"

// Tells whether a scenario is a lesson, and its title if so. One with faults is none; they are
// reported when it is opened. Returns the exit status.
static int read_lesson(const char *name, bool *is_lesson, char *title, size_t size)
{
    scenario s;
    bool faulty;
    int code = open_listed(&s, name, &faulty);
    *is_lesson = code == EXIT_DONE && !faulty && s.lesson.step_count > 0;
    if (*is_lesson) {
        snprintf(title, size, "%s", s.title != NULL ? s.title : "");
    }
    if (code == EXIT_DONE && !faulty) {
        scenario_finish(&s);
    }
    return code;
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
    json_t *all = a->json != NULL ? json_array() : NULL;
    if (a->json != NULL && all == NULL) {
        fault_no_memory(&f);
        return complain_fault(&f);
    }
    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        json_decref(all);
        return complain_fault(&f);
    }

    // without a name all of them, otherwise the one with that name
    const char *wanted = a->operand_count > 0 ? a->operands[0] : NULL;
    for (int i = 0; i < count && !found; i++) {
        const bool named = wanted != NULL && (strcmp(names[i], wanted) == 0 ||
                                              strcmp(leaf_of(names[i]), wanted) == 0);
        bool is_lesson = false;
        if (wanted == NULL || named) {
            code = worse(code, read_lesson(names[i], &is_lesson, title, sizeof title));
        }
        found = is_lesson && named;
        if (found) {
            code = open_lesson(a, names[i]);
        } else if (is_lesson) {
            list_lesson(all, names[i], title);
        }
    }
    if (wanted != NULL && !found && code == EXIT_DONE) {
        code = complain("there is no lesson '%s', 'impactlab lesson' lists them", wanted);
    }

    for (int i = 0; i < count; i++) {
        free(names[i]);
    }
    free(names);
    return a->json != NULL ? worse(code, write_json(a->json, all)) : code;
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
    .run = run_lesson,
};

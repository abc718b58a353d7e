// impactlab lesson: the lessons, or one of them opened in the lab.
#include "ui/commands/scenario_listing.h"

#include <string.h>

#include "src/base/json.h"

// A lesson's short name: that of its scenario without the folder.
static const char *lesson_name(const char *scenario_name)
{
    const char *slash = strrchr(scenario_name, '/');
    if (slash == NULL) {
        return scenario_name;
    }
    return slash + 1;
}

// Prints a line for each lesson, or writes an object for each. Returns the exit status.
static int list_lessons(const arguments *a)
{
    scenario_listing l;
    int result = scenario_listing_open(&l, a);
    if (result != EXIT_DONE) {
        return result;
    }

    // scenarios that are lessons, in the order of their names
    for (int i = 0; i < l.count; i++) {
        scenario_heading heading;
        const char *name = lesson_name(l.names[i]);
        result = worse(result, scenario_heading_read(l.names[i], &heading));
        if (!heading.is_lesson) {
            continue;
        }
        if (l.entries != NULL) {
            json_add(l.entries, json_of("name:t scenario:t title:t", name, l.names[i],
                                        heading.title));
        } else {
            say("%-20s %s\n", name, heading.title);
        }
    }
    return scenario_listing_close(&l, a, result);
}

// Opens a scenario as the lab command does. Returns the exit status.
static int open_in_lab(const arguments *a, char *scenario_name)
{
    arguments opened = *a;
    opened.operands = &scenario_name;
    opened.operand_count = 1;
    return command_find(a->commands, "lab")->run(&opened);
}

// Opens the lesson of that name, with its folder or without. Returns the exit status.
static int open_lesson(const arguments *a, const char *wanted)
{
    scenario_listing l;
    int result = scenario_listing_open(&l, a);
    if (result != EXIT_DONE) {
        return result;
    }

    // the first lesson of that name
    bool found = false;
    for (int i = 0; i < l.count && !found; i++) {
        scenario_heading heading;
        if (strcmp(l.names[i], wanted) != 0 &&
            strcmp(lesson_name(l.names[i]), wanted) != 0) {
            continue;
        }

        result = worse(result, scenario_heading_read(l.names[i], &heading));
        found = heading.is_lesson;
        if (found) {
            result = open_in_lab(a, l.names[i]);
        }
    }

    if (!found && result == EXIT_DONE) {
        result =
            complain("there is no lesson '%s', 'impactlab lesson' lists them", wanted);
    }
    return scenario_listing_close(&l, a, result);
}

// The command: opens the lesson that is named, else lists all.
static int list_or_open_lesson(const arguments *a)
{
    if (a->operand_count == 0) {
        return list_lessons(a);
    }
    if (a->json != NULL) {
        return complain("--json lists the lessons, expected no name beside it");
    }
    return open_lesson(a, a->operands[0]);
}

const command lesson_command = {
    .name = "lesson",
    .group = GROUP_ONE_RUN,
    .summary = "Experiments step by step, on the terminal",
    .operands = "[NAME]",
    .least = 0,
    .most = 1,
    .help = "Opens a lesson in the lab: steps with questions, checked by the run itself. "
            "Without a name it lists them.\n"
            "In the lab y goes on and A answers; :lesson lists the lessons there.\n",
    .options = {&set_options, &json_options, &lab_options, &quiet_options},
    .run = list_or_open_lesson,
};

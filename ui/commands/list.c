#include "ui/commands/command.h"

#include <stdlib.h>
#include <string.h>

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

static int list(const arguments *a)
{
    (void)a;
    char **names;
    int count, width = 0;
    fault f = {0};

    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // titles stand in a column
    for (int i = 0; i < count; i++) {
        int length = (int)strlen(names[i]);
        width = length > width ? length : width;
    }

    for (int i = 0; i < count; i++) {
        print_scenario(names[i], width);
        free(names[i]);
    }

    free(names);
    return EXIT_DONE;
}

const command list_command = {
    .name = "list",
    .group = GROUP_ONE_RUN,
    .operands = "",
    .summary = "Name and title of every scenario",
    .help = "",
    .run = list,
};

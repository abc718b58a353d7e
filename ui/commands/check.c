#include "ui/commands/command.h"

#include <unistd.h>

// Counts the faults it passes on.
static void report_and_count(void *context, const char *sentence)
{
    (*(int *)context)++;
    report_to_stderr(NULL, sentence);
}

// Reads one file (or a scenario by its name). True if it has no fault.
static bool check_one(const char *file)
{
    scenario s;
    int faults = 0;

    // a file under test, or the name of a scenario
    status code = access(file, F_OK) == 0 ? scenario_read(&s, file, NULL, report_and_count, &faults)
                                          : scenario_open(&s, file, report_and_count, &faults);

    if (code == STATUS_OK) {
        scenario_finish(&s);
        say("%s: no fault\n", file);
        return true;
    }

    if (faults == 0) {
        complain("'%s': %s", file, status_text(code));
    }
    return false;
}

static int check(const arguments *a)
{
    int result = EXIT_DONE;
    for (int i = 0; i < a->operand_count; i++) {
        if (!check_one(a->operands[i])) {
            result = EXIT_BAD_ARGUMENTS;
        }
    }
    return result;
}

const command check_command = {
    .name = "check",
    .group = GROUP_ONE_RUN,
    .operands = "FILE...",
    .summary = "Validate scenario files",
    .help = "Every fault is printed as FILE:LINE:COLUMN: what is wrong and what was expected.\n",
    .least = 1,
    .most = 1 << 20,
    .takes_scenarios = true,
    .run = check,
};

// impactlab check: validates scenario files.
#include "ui/commands/command.h"

#include <unistd.h>

#include "src/base/json.h"
#include "src/base/words.h"
#include "src/run/export.h"
#include "src/scenario/effect.h"
#include "ui/commands/results.h"

// A file that is being checked, with the faults found in it.
typedef struct checked_file {
    json_t *sentences; // of the faults, for --json
    opening_faults faults;
} checked_file;

// A fault_handler that prints the fault and keeps its sentence.
static void take_fault(void *context, const char *sentence)
{
    checked_file *c = context;
    report_opening_fault(&c->faults, sentence);
    json_add(c->sentences, json_text(sentence));
}

// Reads a file, or what is not there as one: the scenario of that name.
static status read_file_or_scenario(const char *file, checked_file *c, scenario *s)
{
    if (access(file, F_OK) == 0) {
        return scenario_read(s, file, NULL, take_fault, c);
    }
    return scenario_open(s, file, take_fault, c);
}

static void warn_of_values_without_effect(const scenario *s, const char *file)
{
    idle_value idle;
    for (int place = 0; effect_next_idle(s, &place, &idle);) {
        print_printable(stderr, "%s:%d: warning: %s has no effect: %s\n", file, idle.line,
                        idle.path, idle.why);
    }
}

// Checks one file and adds what was found to `files`. Returns the exit status.
static int check_file(const char *file, const arguments *a, json_t *files)
{
    scenario s;
    checked_file c = {.sentences = json_array()};
    json_t *without_effect;
    int result = EXIT_DONE;

    const status code = read_file_or_scenario(file, &c, &s);
    if (code == STATUS_OK) {
        warn_of_values_without_effect(&s, file);
        without_effect = export_without_effect(&s);
        scenario_finish(&s);
        report_first_fault(&c.faults);
        if (summary_wanted(a)) {
            say("%s: no fault\n", file);
        }
    } else {
        // what was not found in the file is a fault, too
        without_effect = json_array();
        if (c.faults.count == 0) {
            json_add(c.sentences, json_text(status_text(code)));
        }
        result = report_unopened(&c.faults, code, file);
    }

    json_add(files, json_of("file:t faults:o without_effect:o", file, c.sentences,
                            without_effect));
    return result;
}

// The command: checks each file, or scenario of that name.
static int check_files(const arguments *a)
{
    json_t *files = json_array();
    int result = EXIT_DONE;
    for (int i = 0; i < a->operand_count; i++) {
        result = worse(result, check_file(a->operands[i], a, files));
    }

    if (a->json != NULL) {
        return worse(result, write_json_file(a->json, files));
    }
    json_decref(files);
    return result;
}

const command check_command = {
    .name = "check",
    .group = GROUP_ONE_RUN,
    .summary = "Validate scenario files",
    .operands = "FILE...",
    .least = 1,
    .most = 1 << 20,
    .takes_scenarios = true,
    .help = "Every fault is printed as FILE:LINE:COLUMN: what is wrong and what was "
            "expected. A value that has\n"
            "no effect is warned of by FILE:LINE, and is no fault (exit status 0).\n",
    .options = {&json_options, &quiet_options},
    .run = check_files,
};

#include "ui/commands/command.h"

#include <unistd.h>

#include "src/base/json.h"

// What came of the files so far.
typedef struct checking {
    json_t *files;  // an object each
    json_t *faults; // the sentences of the file in hand
    int count;      // of them
} checking;

// Tells and keeps a fault.
static void take_fault(void *context, const char *sentence)
{
    checking *c = context;
    c->count++;
    report_to_stderr(NULL, sentence);
    json_add(c->faults, json_text(sentence));
}

// Reads one file (or a scenario by its name). True if it has no fault.
static bool check_one(const char *file, const arguments *a, checking *c)
{
    scenario s;
    c->count = 0;
    c->faults = json_array();

    // a file under test, or the name of a scenario
    status code = access(file, F_OK) == 0 ? scenario_read(&s, file, NULL, take_fault, c)
                                          : scenario_open(&s, file, take_fault, c);
    if (code == STATUS_OK) {
        scenario_finish(&s);
        if (summary_wanted(a)) {
            say("%s: no fault\n", file);
        }
    } else if (c->count == 0) {
        complain("'%s': %s", file, status_text(code));
        json_add(c->faults, json_text(status_text(code)));
    }

    json_t *object = json_object();
    json_put(object, "file", json_text(file));
    json_put(object, "faults", c->faults);
    json_add(c->files, object);
    return code == STATUS_OK;
}

static int check(const arguments *a)
{
    checking c = {.files = json_array()};
    int result = EXIT_DONE;
    for (int i = 0; i < a->operand_count; i++) {
        result = check_one(a->operands[i], a, &c) ? result : EXIT_BAD_ARGUMENTS;
    }
    if (a->json != NULL) {
        return worse(result, write_json(a->json, c.files));
    }
    json_decref(c.files);
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
    .options = {&json_options},
    .run = check,
};

#include "ui/commands/command.h"

#include <unistd.h>

#include "src/base/json.h"

// What came of the files so far.
typedef struct checking {
    json_t *files;  // an object each
    json_t *faults; // the sentences of the present file
    told_faults told;
} checking;

// Tells and keeps a fault.
static void take_fault(void *context, const char *sentence)
{
    checking *c = context;
    tell_fault(&c->told, sentence);
    json_add(c->faults, json_text(sentence));
}

// Reads one file (or a scenario by its name). Returns the exit status.
static int check_one(const char *file, const arguments *a, checking *c)
{
    scenario s;
    int result = EXIT_DONE;
    c->told = (told_faults){0};
    c->faults = json_array();

    // a file under test, or the name of a scenario
    status code = access(file, F_OK) == 0 ? scenario_read(&s, file, NULL, take_fault, c)
                                          : scenario_open(&s, file, take_fault, c);
    if (code == STATUS_OK) {
        scenario_finish(&s);
        tell_first_fault(&c->told);
        if (summary_wanted(a)) {
            say("%s: no fault\n", file);
        }
    } else {
        if (c->told.count == 0) {
            json_add(c->faults, json_text(status_text(code)));
        }
        result = tell_unopened(&c->told, code, file);
    }

    json_t *object = json_object();
    json_put(object, "file", json_text(file));
    json_put(object, "faults", c->faults);
    json_add(c->files, object);
    return result;
}

static int check(const arguments *a)
{
    checking c = {.files = json_array()};
    int result = EXIT_DONE;
    for (int i = 0; i < a->operand_count; i++) {
        result = worse(result, check_one(a->operands[i], a, &c));
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

#include "ui/commands/command.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "src/base/words.h"
#include "src/scenario/outside.h"
#include "ui/commands/interrupts.h"

// --- commands and their options --------------------------------------------------------

const command *command_find(const command_list *all, const char *name)
{
    for (int i = 0; i < all->count; i++) {
        if (strcmp(all->items[i]->name, name) == 0) {
            return all->items[i];
        }
    }
    return NULL;
}

const char *command_nearest(const command_list *all, const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < all->count; i++) {
        nearest_try(&near, all->items[i]->name);
    }
    return near.best;
}

int complain_command(const command_list *all, const char *name)
{
    const char *near = command_nearest(all, name);
    if (near != NULL) {
        return complain("there is no command '%s', did you mean '%s'?", name, near);
    }

    // where none is near, all of them are named
    char known[256] = "";
    size_t length = 0;
    for (int i = 0; i < all->count && length < sizeof known; i++) {
        const char *separator = i > 0 ? ", " : "";
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s",
                                   separator, all->items[i]->name);
    }
    return complain("there is no command '%s', only %s", name, known);
}

const option_table *command_options(const command *c, int i)
{
    assert(i >= 0 && i <= COMMAND_TABLES);

    // the table of --help comes behind those of its title
    int before_help = 0;
    while (c->options[before_help] != NULL &&
           strcmp(c->options[before_help]->title, help_options.title) == 0) {
        before_help++;
    }

    if (i < before_help) {
        return c->options[i];
    }
    if (i == before_help) {
        return &help_options;
    }
    return c->options[i - 1];
}

const option_row *command_option(const command *c, int i)
{
    const option_table *t;
    assert(i >= 0);
    for (int k = 0; (t = command_options(c, k)) != NULL; k++) {
        if (i < t->count) {
            return &t->rows[i];
        }
        i -= t->count;
    }
    return NULL;
}

int command_run(const arguments *a)
{
    const command *c = a->command;
    int result;
    if (c->use != NULL) {
        result = with_scenario(a->operands[0], a, c->use);
    } else {
        result = c->run(a);
    }
    return interrupts_end(result);
}

// --- scenarios -------------------------------------------------------------------------

// Allows and changes what the command line asks for. Returns the exit status.
static int apply_arguments(scenario *s, const arguments *a)
{
    s->parameters.code_allowed = a->allow_code;
    if (scenario_override_all(s, a->sets.items, a->sets.count, complain_sentence, NULL) !=
        STATUS_OK) {
        return EXIT_BAD_ARGUMENTS;
    }

    // no result is written over a file that the parameters name
    fault f = {0};
    if (outside_keep(&s->parameters, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

int command_scenario_open(scenario *s, const char *name_or_file, const arguments *a)
{
    opening_faults faults = {0};
    const status code = scenario_open(s, name_or_file, report_opening_fault, &faults);
    if (code != STATUS_OK) {
        return report_unopened(&faults, code, name_or_file);
    }
    report_first_fault(&faults);

    const int result = apply_arguments(s, a);
    if (result != EXIT_DONE) {
        scenario_finish(s);
    }
    return result;
}

int with_scenario(const char *name_or_file, const arguments *a,
                  int (*use)(const arguments *a, scenario *s))
{
    scenario s;
    int result = command_scenario_open(&s, name_or_file, a);
    if (result == EXIT_DONE) {
        result = use(a, &s);
        scenario_finish(&s);
    }
    return result;
}

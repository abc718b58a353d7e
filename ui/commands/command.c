// What the commands share: their options, scenarios and results.
#include "ui/commands/command.h"

#include <assert.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "src/scenario/outside.h"
#include "ui/commands/interrupts.h"

const command *command_find(const command_list *all, const char *name)
{
    for (int i = 0; i < all->count; i++) {
        if (strcmp(all->items[i]->name, name) == 0) {
            return all->items[i];
        }
    }
    return NULL;
}

int complain_command(const command_list *all, const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < all->count; i++) {
        nearest_try(&near, all->items[i]->name);
    }
    if (near.best != NULL) {
        return complain("there is no command '%s', did you mean '%s'?", name, near.best);
    }

    // nothing is near: all there are
    char known[256] = "";
    size_t length = 0;
    for (int i = 0; i < all->count && length < sizeof known; i++) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s",
                                   i ? ", " : "", all->items[i]->name);
    }
    return complain("there is no command '%s', only %s", name, known);
}

const option_table *command_options(const command *c, int i)
{
    int own = 0; // tables that come before --help
    assert(i >= 0 && i <= COMMAND_TABLES);
    while (c->options[own] != NULL &&
           strcmp(c->options[own]->title, help_options.title) == 0) {
        own++;
    }
    if (i < own) {
        return c->options[i];
    }
    if (i == own) {
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

// --- scenarios and results -------------------------------------------------------------

int open_scenario(scenario *s, const char *name_or_file, const arguments *a)
{
    opening_faults faults = {0};
    status code = scenario_open(s, name_or_file, report_opening_fault, &faults);
    if (code != STATUS_OK) {
        return report_unopened(&faults, code, name_or_file);
    }
    report_first_fault(&faults);

    // what the command line allows and changes
    s->parameters.code_allowed = a->allow_code;
    int result = EXIT_DONE;
    fault f = {0};
    if (scenario_override_all(s, a->sets.items, a->sets.count, complain_sentence, NULL) !=
        STATUS_OK) {
        result = EXIT_BAD_ARGUMENTS;
    } else if (outside_keep(&s->parameters, &f) != STATUS_OK) {
        result = complain_fault(&f);
    }

    if (result != EXIT_DONE) {
        scenario_finish(s);
    }
    return result;
}

int with_scenario(const char *name_or_file, const arguments *a,
                  int (*use)(const arguments *a, scenario *s))
{
    scenario s;
    int result = open_scenario(&s, name_or_file, a);
    if (result == EXIT_DONE) {
        result = use(a, &s);
        scenario_finish(&s);
    }
    return result;
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

RESULT_WRITER(write_value, json_t, json_write(stream, found))

int write_json(const char *path, json_t *value)
{
    // all of it or nothing
    int result;
    if (loss_noted() || value == NULL) {
        result = complain_fault(&(fault){.code = STATUS_NO_MEMORY});
    } else {
        result = write_file(path, write_value, NULL, value);
    }
    json_decref(value);
    return result;
}

int write_file(const char *path, result_writer *write, const scenario *s,
               const void *found)
{
    whole_file file;
    fault f = {0};
    if (path == NULL || write == NULL) {
        return EXIT_DONE;
    }
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    write(file.stream, s, found);
    if (whole_file_commit(&file, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

int write_results(const arguments *a, const command_results *r, const scenario *s,
                  const void *found, bool whole)
{
    const struct {
        const char *path;
        result_writer *write;
    } files[] = {{a->csv, r->csv},
                 {a->markdown, r->markdown},
                 {a->mat, r->mat},
                 {whole ? a->cases : NULL, r->cases},
                 {whole ? a->output : NULL, r->output}};
    int result = EXIT_DONE;
    interrupts_catch();
    if (a->json != NULL && r->json != NULL) {
        json_t *object = r->json(s, found);
        if (!whole && object != NULL) {
            json_put(object, "status", json_string("interrupted"));
        }
        result = write_json(a->json, object);
    }
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        result = worse(result, write_file(files[i].path, files[i].write, s, found));
    }
    if (a->plot != NULL && r->plot != NULL && (whole || r->draws_part)) {
        result = worse(result, r->plot(a, s, found));
    }
    if (r->text != NULL && summary_wanted(a)) {
        r->text(s, found);
    }
    return result;
}

int worse(int a, int b)
{
    if (a > b) {
        return a;
    }
    return b;
}

bool summary_wanted(const arguments *a)
{
    const option_row *o;
    bool alone = false;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const char *path = option_written(a, o);
        if (o->type == OPTION_RESULT && path != NULL && strcmp(path, "-") == 0) {
            alone = true;
        }
    }
    return !a->quiet && !alone;
}

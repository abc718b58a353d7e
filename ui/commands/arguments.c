// Reads the command line by the rows of a command's options.
#include "ui/commands/command.h"

#include <assert.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/picture_file.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "ui/commands/option_values.h"

// getopt_long's value of the option in row i is ROW_VALUE + i, apart from all letters
enum { ROW_VALUE = 256 };

const option_table *command_options(const command *c, int i)
{
    int own = 0; // tables that come before --help
    assert(c != NULL && i >= 0 && i <= COMMAND_TABLES);
    while (c->options[own] != NULL && strcmp(c->options[own]->title, help_options.title) == 0) {
        own++;
    }
    return i < own ? c->options[i] : i == own ? &help_options : c->options[i - 1];
}

const option_row *command_option(const command *c, int i)
{
    const option_table *t;
    assert(c != NULL && i >= 0);
    for (int k = 0; (t = command_options(c, k)) != NULL; k++) {
        if (i < t->count) {
            return &t->rows[i];
        }
        i -= t->count;
    }
    return NULL;
}

const char *option_text(const arguments *a, const option_row *o)
{
    assert(o->type >= OPTION_TEXT && o->type <= OPTION_QUANTITY);
    return *(const char **)option_place(a, o);
}

bool option_is_written(const option_row *o)
{
    assert(o != NULL);
    return o->type == OPTION_RESULT || o->type == OPTION_PICTURE || o->type == OPTION_PLACE;
}

// --- getopt ---------------------------------------------------------------------------------

// Another command that has an option of this name, without dashes; NULL if none has.
static const command *owner_of_option(const char *name)
{
    const option_row *o;
    for (int c = 0; c < command_count; c++) {
        for (int i = 0; (o = command_option(command_table[c], i)) != NULL; i++) {
            if (strcmp(o->name, name) == 0) {
                return command_table[c];
            }
        }
    }
    return NULL;
}

// What is said of an option getopt does not take.
static int complain_option(const command *self, int found, const char *text)
{
    char shown[96];
    const option_row *o;

    if (found == ':') {
        return complain("option %s needs a value (see impactlab %s --help)", text, self->name);
    }

    // one that is right elsewhere
    snprintf(shown, sizeof shown, "%.*s", (int)strcspn(text, "="), text);
    const command *owner = owner_of_option(shown + strspn(shown, "-"));
    if (owner != NULL) {
        return complain("%s has no option %s, that is one of %s (see impactlab %s --help)",
                        self->name, shown, owner->name, self->name);
    }

    // the nearest option is offered
    nearest_word near = nearest_begin(shown + strspn(shown, "-"));
    for (int i = 0; (o = command_option(self, i)) != NULL; i++) {
        nearest_try(&near, o->name);
    }

    if (near.best != NULL && near.distance > 0) {
        return complain("%s has no option %s, did you mean --%s?", self->name, shown, near.best);
    }
    return complain("%s has no option %s (see impactlab %s --help)", self->name, shown, self->name);
}

// Fills getopt's tables with the options of the command.
static void option_lists(const command *self, struct option *longs, char *shorts)
{
    const option_row *o;
    // the colon makes getopt tell a missing value from an unknown option
    *shorts++ = ':';

    for (int i = 0; (o = command_option(self, i)) != NULL; i++) {
        int takes_value = o->type != OPTION_FLAG;
        assert(i < COMMAND_OPTIONS && (o->value != NULL) == (takes_value != 0));

        *longs++ = (struct option){o->name, takes_value, NULL, ROW_VALUE + i};
        if (o->alias != NULL) {
            *longs++ = (struct option){o->alias, takes_value, NULL, ROW_VALUE + i};
        }

        if (o->letter != 0) {
            *shorts++ = o->letter;
            if (takes_value) {
                *shorts++ = ':';
            }
        }
    }
    *longs = (struct option){0};
    *shorts = '\0';
}

// The row of getopt's value.
static int row_of(const command *self, int found)
{
    int i = 0;
    if (found >= ROW_VALUE) {
        return found - ROW_VALUE;
    }
    while (command_option(self, i)->letter != found) {
        i++;
    }
    return i;
}

static bool is_repeated(const option_row *o)
{
    return o->type == OPTION_NUMBERS || o->type == OPTION_PARAMETERS;
}

// Adds a word to the command line that pictures remember, in quotes where a shell needs them.
static void remember(arguments *a, const char *before, const char *word)
{
    bool plain = word[0] != '\0' && word[strcspn(word, " \t\n'\"\\$&|;<>()*?[]{}#~`!")] == '\0';
    const char *quote = plain ? "" : "'", *so_far = a->command_line ? a->command_line : "";
    size_t size = strlen(so_far) + strlen(before) + strlen(word) + 4;
    char *longer = malloc(size);
    if (longer != NULL) {
        snprintf(longer, size, "%s%s%s%s%s", so_far, before, quote, word, quote);
        free(a->command_line);
        a->command_line = longer;
    }
}

// An option as given on the command line. Paths of results are left out, because they do not change
// the results.
static void remember_option(arguments *a, const option_row *o, const char *value)
{
    char name[64];
    if (option_is_written(o)) {
        return;
    }
    snprintf(name, sizeof name, "--%s", o->name);
    remember(a, " ", name);
    if (value != NULL) {
        remember(a, " ", value);
    }
}

// Takes every option in its turn. True if help was asked for; *exit_status says what went wrong.
static bool take_options(arguments *a, int argc, char **argv, int *exit_status)
{
    struct option longs[2 * COMMAND_OPTIONS + 1];
    char shorts[2 * COMMAND_OPTIONS + 2];
    bool given[COMMAND_OPTIONS] = {false};
    int found;

    option_lists(a->command, longs, shorts);
    opterr = 0;
    while (*exit_status == EXIT_DONE &&
           (found = getopt_long(argc, argv, shorts, longs, NULL)) != -1) {
        if (found == '?' || found == ':') {
            *exit_status = complain_option(a->command, found, argv[optind - 1]);
            break;
        }

        // a row of the command's or of every command's table
        int i = row_of(a->command, found);
        const option_row *o = command_option(a->command, i);

        if (o == help_options.rows) {
            return true;
        }

        *exit_status = given[i] && o->type != OPTION_FLAG && !is_repeated(o)
                           ? complain("option --%s was given twice", o->name)
                           : option_store(a, o, optarg);
        given[i] = true;
        remember_option(a, o, o->type == OPTION_FLAG ? NULL : optarg);
    }
    return false;
}

// --- the whole command line -----------------------------------------------------------------

// Two results must not end in one place.
static int check_places(const arguments *a)
{
    const option_row *o, *other;

    // each path against those of the options before it
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const char *path = option_is_written(o) ? option_text(a, o) : NULL;
        for (int j = 0; path != NULL && j < i; j++) {
            other = command_option(a->command, j);
            const char *before = option_is_written(other) ? option_text(a, other) : NULL;
            if (before != NULL && strcmp(path, before) == 0) {
                return complain("two results cannot both be written to %s",
                                strcmp(path, "-") == 0 ? "the standard output" : path);
            }
        }
    }
    return EXIT_DONE;
}

static int check_operands(const arguments *a)
{
    const command *self = a->command;
    if (a->operand_count < self->least) {
        return complain("%s needs %s (see impactlab %s --help)", self->name, self->operands,
                        self->name);
    }
    if (a->operand_count > self->most) {
        return complain("%s does not know what to do with '%s' (see impactlab %s --help)",
                        self->name, a->operands[self->most], self->name);
    }
    return check_places(a);
}

// Gives every list room for a whole command line, and numbers their initial values.
static bool prepare(arguments *a, int argc)
{
    const option_row *o;
    bool room = true;

    // lists have room for all that the command line could hold
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        void *place = option_place(a, o);
        if (o->type == OPTION_PARAMETERS) {
            text_list *list = place;
            list->items = calloc((size_t)argc + 1, sizeof *list->items);
            room = room && list->items != NULL;
        } else if (o->type == OPTION_NUMBERS) {
            number_list *list = place;
            list->items = calloc((size_t)argc + 1, sizeof *list->items);
            room = room && list->items != NULL;
        } else if (o->type == OPTION_NUMBER) {
            *(double *)place = o->initial;
        }
    }
    return room;
}

bool arguments_read(arguments *a, const command *self, int argc, char **argv, int *exit_status)
{
    assert(self != NULL && argc > 0 && exit_status != NULL);
    *a = (arguments){.command = self};
    *exit_status = EXIT_DONE;
    if (!prepare(a, argc)) {
        arguments_finish(a);
        complain("out of memory");
        *exit_status = EXIT_FAILED;
        return false;
    }
    remember(a, "impactlab ", self->name != NULL ? self->name : "");
    if (take_options(a, argc, argv, exit_status)) {
        print_help(stdout, self);
        arguments_finish(a);
        return false;
    }

    // getopt has moved all that is no option behind the options
    a->operands = argv + optind;
    a->operand_count = argc - optind;
    for (int i = 0; i < a->operand_count; i++) {
        remember(a, " ", a->operands[i]);
    }
    if (*exit_status == EXIT_DONE) {
        *exit_status = check_operands(a);
    }
    if (*exit_status != EXIT_DONE) {
        arguments_finish(a);
    }
    return *exit_status == EXIT_DONE;
}

void arguments_finish(arguments *a)
{
    const option_row *o;
    for (int i = 0; a->command != NULL && (o = command_option(a->command, i)) != NULL; i++) {
        if (o->type == OPTION_PARAMETERS) {
            free(((text_list *)option_place(a, o))->items);
        } else if (o->type == OPTION_NUMBERS) {
            free(((number_list *)option_place(a, o))->items);
        }
    }
    free(a->command_line);
    *a = (arguments){0};
}

int check_results(const arguments *a)
{
    assert(a != NULL);
    const option_row *o;
    int result = EXIT_DONE;

    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        fault f = {.code = STATUS_OK};
        const char *path = option_is_written(o) ? option_text(a, o) : NULL;

        if (path == NULL || o->type == OPTION_PLACE) {
            continue;
        }

        if (o->type == OPTION_PICTURE) {
            f.code = picture_check_path(path, &f);
        }
        if (f.code == STATUS_OK) {
            f.code = whole_file_check(path, &f);
        }
        result = f.code == STATUS_OK ? result : worse(result, complain_fault(&f));
    }
    return result;
}

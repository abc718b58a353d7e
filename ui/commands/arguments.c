// Reads the command line by the rows of a command's options.
#include "ui/commands/command.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/figures/artwork.h"
#include "render/page/picture_file.h"
#include "src/base/numbers.h"
#include "src/base/input_file.h"
#include "src/base/result_places.h"
#include "src/base/whole_file.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"

// --- values ----------------------------------------------------------------------------

static int read_number(const option_row *o, const char *text, double *value)
{
    const char *rest, *unit = o->unit != NULL ? o->unit : "";
    char limit[64] = "";
    if (decimal_read(text, value, &rest) && *rest == '\0' && *value >= o->low &&
        *value <= o->high) {
        return EXIT_DONE;
    }
    if (!isinf(o->high)) {
        snprintf(limit, sizeof limit, " to %g", o->high);
    }
    return complain("--%s %s: expected a number from %g%s%s%s", o->name, text, o->low,
                    limit, unit[0] != '\0' ? " " : "", unit);
}

// A length in millimetres; without a unit it is one already.
static int read_length(const option_row *o, const char *text, double *value)
{
    static const struct {
        const char *unit;
        double mm;
    } units[] = {{"", 1}, {"mm", 1}, {"cm", 10}, {"in", 25.4}, {"pt", 25.4 / 72}};
    const char *rest;
    double number;

    if (decimal_read(text, &number, &rest)) {
        for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
            double mm = number * units[i].mm;
            if (strcmp(rest, units[i].unit) == 0 && mm >= o->low && mm <= o->high) {
                *value = mm;
                return EXIT_DONE;
            }
        }
    }

    return complain(
        "--%s %s: expected a length from %gmm to %gmm, such as 85mm, 8.5cm or 3.35in",
        o->name, text, o->low, o->high);
}

static int read_whole(const option_row *o, const char *text, uint64_t *value)
{
    // 2^64 and what lies beyond stand for the largest number there is
    uint64_t low = (uint64_t)o->low,
             high = o->high < 0x1p64 ? (uint64_t)o->high : UINT64_MAX;

    // signs and spaces, which strtoull would take, are refused by the first character
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    if (!isdigit((unsigned char)text[0]) || *end != '\0' || errno != 0 || number < low ||
        number > high) {
        return complain("--%s %s: expected a whole number from %llu to %llu", o->name,
                        text, (unsigned long long)low, (unsigned long long)high);
    }
    *value = number;
    return EXIT_DONE;
}

static int read_size(const option_row *o, const char *text, grid_size *size)
{
    char *rest = NULL;
    long width = strtol(text, &rest, 10), height = 0;
    if (*rest == 'x') {
        height = strtol(rest + 1, &rest, 10);
    }
    if (*rest != '\0' || width < 1 || width > o->high || height < 1 || height > o->high) {
        return complain("--%s %s: expected width x height in %s, like 120x40, at most %g",
                        o->name, text, o->unit, o->high);
    }
    *size = (grid_size){(int)width, (int)height};
    return EXIT_DONE;
}

static int check_choice(const option_row *o, const char *text)
{
    char words[256] = "";
    size_t length = 0;
    for (const char *word = o->value, *end; *word != '\0'; word = end + (*end == '|')) {
        end = word + strcspn(word, "|");
        const int bytes = (int)(end - word);
        if (bytes > 0 && strlen(text) == (size_t)bytes &&
            memcmp(word, text, strlen(text)) == 0) {
            return EXIT_DONE;
        }

        // as people write them: "a, b or c"
        const char *joint = "";
        if (word != o->value) {
            if (*end == '|') {
                joint = ", ";
            } else {
                joint = " or ";
            }
        }
        length += (size_t)snprintf(words + length, sizeof words - length, "%s%.*s", joint,
                                   bytes, word);
        assert(length < sizeof words);
    }
    return complain("--%s %s: expected %s", o->name, text, words);
}

static int check_quantity(const option_row *o, const char *key)
{
    const char *near = summary_suggest(key);
    if (summary_find(key) >= 0) {
        return EXIT_DONE;
    }
    if (near != NULL) {
        return complain("--%s %s: there is no such quantity, did you mean %s?", o->name,
                        key, near);
    }
    return complain(
        "--%s %s: there is no such quantity (impactlab run --json lists them)", o->name,
        key);
}

// Checks a value by its row and stores it; lists have room for it. Returns the exit
// status.
static int option_store(arguments *a, const option_row *o, char *text)
{
    void *place = option_place(a, o);
    option_list *list = place; // of what may be given several times
    switch (o->type) {
    case OPTION_FLAG:
        *(bool *)place = true;
        return EXIT_DONE;
    case OPTION_NUMBER:
        return read_number(o, text, place);
    case OPTION_LENGTH:
        return read_length(o, text, place);
    case OPTION_WHOLE:
        return read_whole(o, text, place);
    case OPTION_SIZE:
        return read_size(o, text, place);
    case OPTION_NUMBERS:
        return read_number(o, text, &list->numbers[list->count++]);
    case OPTION_FILES:
    case OPTION_PARAMETERS:
        list->items[list->count++] = text;
        return EXIT_DONE;

    // texts are kept as they are, and checked where only some are known
    default:
        *(const char **)place = text;
        if (o->type == OPTION_CHOICE) {
            return check_choice(o, text);
        }
        if (o->type == OPTION_QUANTITY) {
            return check_quantity(o, text);
        }
        return EXIT_DONE;
    }
}

// getopt_long's value of the option in row i is ROW_VALUE + i, apart from all letters
enum { ROW_VALUE = 256 };

// --- getopt ----------------------------------------------------------------------------

// Another command that has an option of this name, without dashes; NULL if none has.
static const command *owner_of_option(const command_list *all, const char *name)
{
    const option_row *o;
    for (int c = 0; c < all->count; c++) {
        for (int i = 0; (o = command_option(all->items[c], i)) != NULL; i++) {
            if (strcmp(o->name, name) == 0) {
                return all->items[c];
            }
        }
    }
    return NULL;
}

// What is said of an option getopt does not take.
static int complain_option(const arguments *a, int found, const char *text)
{
    const command *self = a->command;
    char shown[96];
    const option_row *o;

    if (found == ':') {
        return complain("option %s needs a value (see impactlab %s --help)", text,
                        self->name);
    }

    // one that is right elsewhere
    snprintf(shown, sizeof shown, "%.*s", (int)strcspn(text, "="), text);
    const command *owner = owner_of_option(a->commands, shown + strspn(shown, "-"));
    if (owner != NULL) {
        return complain(
            "%s has no option %s, that is one of %s (see impactlab %s --help)",
            self->name, shown, owner->name, self->name);
    }

    // the nearest option is offered
    nearest_word near = nearest_begin(shown + strspn(shown, "-"));
    for (int i = 0; (o = command_option(self, i)) != NULL; i++) {
        nearest_try(&near, o->name);
    }

    if (near.best != NULL && near.distance > 0) {
        return complain("%s has no option %s, did you mean --%s?", self->name, shown,
                        near.best);
    }
    return complain("%s has no option %s (see impactlab %s --help)", self->name, shown,
                    self->name);
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

// Adds a word to the command line that pictures remember, in quotes where a shell needs
// them.
static void remember(arguments *a, const char *before, const char *word)
{
    bool plain =
        word[0] != '\0' && word[strcspn(word, " \t\n'\"\\$&|;<>()*?[]{}#~`!")] == '\0';
    const char *quote = plain ? "" : "'",
               *so_far = a->command_line ? a->command_line : "";
    size_t size = strlen(so_far) + strlen(before) + strlen(word) + 4;
    char *longer = malloc(size);
    loss_unless(longer != NULL);
    if (longer != NULL) {
        snprintf(longer, size, "%s%s%s%s%s", so_far, before, quote, word, quote);
        free(a->command_line);
        a->command_line = longer;
    }
}

// Takes every option in its turn. True if help was asked for; *exit_status says what went
// wrong.
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
            *exit_status = complain_option(a, found, argv[optind - 1]);
            break;
        }

        // a row of the command's or of every command's table
        int i = 0;
        const option_row *o;
        while ((o = command_option(a->command, i))->letter != found &&
               found != ROW_VALUE + i) {
            i++;
        }

        if (o == help_options.rows) {
            return true;
        }

        if (given[i] && o->type != OPTION_FLAG && !option_is_list(o->type)) {
            *exit_status = complain("option --%s was given twice", o->name);
        } else {
            *exit_status = option_store(a, o, optarg);
        }
        given[i] = true;
        // where results are written to does not change them
        if (!option_is_written(o)) {
            remember(a, " --", o->name);
        }
        if (!option_is_written(o) && o->type != OPTION_FLAG) {
            remember(a, " ", optarg);
        }
    }
    return false;
}

// --- the whole command line ------------------------------------------------------------

// What is read must stay, and have an end: FILE, or FILE.csv:COLUMN@SHIFT.
static int check_kept(const char *text)
{
    char file[PATH_MAX];
    fault why = {0};
    snprintf(file, sizeof file, "%s", text);
    status code = input_file_check_plain(file, &why);
    if (code == STATUS_OK) {
        code = input_file_check_kept(file, &why);
    }
    for (const char *mark = "@:"; *mark != '\0' && code == STATUS_OK; mark++) {
        char *end = strrchr(file, *mark);
        if (end != NULL) {
            *end = '\0';
            code = input_file_check_plain(file, &why);
        }
        if (end != NULL && code == STATUS_OK) {
            code = input_file_check_kept(file, &why);
        }
    }
    if (code != STATUS_OK) {
        return complain("'%s' %s", file, why.text);
    }
    return EXIT_DONE;
}

// Two results must not end in one place, nor one in the place of what is read.
static int check_places(const arguments *a)
{
    const option_row *o;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const char *path = option_written(a, o);
        struct stat there;
        if (path != NULL && o->replaces != NULL && stat(path, &there) == 0 &&
            S_ISREG(there.st_mode) && there.st_size > 0 && !o->replaces(path)) {
            return complain("--%s %s: a file of another kind is there and is kept, "
                            "expected another place",
                            o->name, path);
        }
        if (path != NULL && !result_places_add(path)) {
            return complain("two results cannot both be written to %s",
                            strcmp(path, "-") == 0 ? "the standard output" : path);
        }
    }

    // the text of a picture that has none of its own
    g_autofree char *text =
        a->bare && a->plot != NULL ? artwork_beside(a->plot, ".txt") : NULL;
    if (text != NULL && !result_places_add(text)) {
        return complain("two results cannot both be written to %s", text);
    }

    // what the command line names; what that names in its turn is looked at when it is
    // read
    for (int i = 0; i < a->operand_count; i++) {
        int ended = check_kept(a->operands[i]);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const option_list *list = option_place(a, o);
        for (int k = 0; o->type == OPTION_FILES && k < list->count; k++) {
            int ended = check_kept(list->items[k]);
            if (ended != EXIT_DONE) {
                return ended;
            }
        }
        const char *const *file = option_place(a, o);
        if (o->type == OPTION_FILE && *file != NULL) {
            int ended = check_kept(*file);
            if (ended != EXIT_DONE) {
                return ended;
            }
        }
    }
    return EXIT_DONE;
}

static int check_operands(const arguments *a)
{
    const command *self = a->command;
    if (a->operand_count < self->least) {
        return complain("%s needs %s (see impactlab %s --help)", self->name,
                        self->operands, self->name);
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
        if (option_is_list(o->type)) {
            option_list *list = place;
            list->items =
                calloc((size_t)argc + 1, sizeof *list->items + sizeof *list->numbers);
            room = room && list->items != NULL;
        } else if (o->type == OPTION_NUMBER) {
            *(double *)place = o->initial;
        }
    }
    return room;
}

bool arguments_read(arguments *a, int argc, char **argv, int *exit_status)
{
    assert(argc > 0 && a->command != NULL && a->commands != NULL);
    *exit_status = EXIT_DONE;
    if (!prepare(a, argc)) {
        arguments_finish(a);
        complain("out of memory");
        *exit_status = EXIT_FAILED;
        return false;
    }
    remember(a, "impactlab ", a->command->name);
    if (take_options(a, argc, argv, exit_status)) {
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
    for (int i = 0; a->command != NULL && (o = command_option(a->command, i)) != NULL;
         i++) {
        if (option_is_list(o->type)) {
            free(((option_list *)option_place(a, o))->items);
        }
    }
    free(a->command_line);
    result_places_forget();
    *a = (arguments){0};
}

int check_results(const arguments *a)
{
    const option_row *o;
    int result = EXIT_DONE;

    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        fault f = {.code = STATUS_OK};
        const char *path = option_written(a, o);
        if (path == NULL || o->type == OPTION_PLACE) {
            continue;
        }
        if (o->type == OPTION_PICTURE) {
            f.code = picture_check_path(path, &f);
        }
        if (f.code == STATUS_OK) {
            f.code = whole_file_check(path, &f);
        }
        if (f.code != STATUS_OK) {
            result = worse(result, complain_fault(&f));
        }
    }
    return result;
}

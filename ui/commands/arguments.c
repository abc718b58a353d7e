#include "ui/commands/arguments.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <glib.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/page/picture_path.h"
#include "src/base/input_file.h"
#include "src/base/numbers.h"
#include "src/base/result_places.h"
#include "src/base/words.h"
#include "src/tables/summary.h"
#include "ui/commands/command.h"

// --- values ----------------------------------------------------------------------------

// Reads a number within the range of its row. Returns the exit status.
static int read_option_number(const option_row *o, const char *text, double *value)
{
    const char *rest;
    if (decimal_read(text, value, &rest) && *rest == '\0' && *value >= o->low &&
        *value <= o->high) {
        return EXIT_DONE;
    }

    // what was expected: "from 0 to 90 degrees"
    char upper_end[64] = "";
    const char *unit = "";
    if (!isinf(o->high)) {
        snprintf(upper_end, sizeof upper_end, " to %g", o->high);
    }
    if (o->unit != NULL) {
        unit = o->unit;
    }
    return complain("--%s %s: expected a number from %g%s%s%s", o->name, text, o->low,
                    upper_end, blank_before(unit), unit);
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

    // a number, and one of the units behind it
    if (decimal_read(text, &number, &rest)) {
        for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
            const double mm = number * units[i].mm;
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

// Reads a whole number within the range of its row. Returns the exit status.
static int read_whole(const option_row *o, const char *text, uint64_t *value)
{
    // 2^64 and what lies beyond stand for the largest number there is
    const uint64_t low = (uint64_t)o->low;
    uint64_t high = UINT64_MAX;
    if (o->high < 0x1p64) {
        high = (uint64_t)o->high;
    }

    // signs and spaces, which strtoull would take, are refused by the first character
    char *end;
    errno = 0;
    const unsigned long long number = strtoull(text, &end, 10);
    const bool is_whole = isdigit((unsigned char)text[0]) && *end == '\0' && errno == 0;
    if (!is_whole || number < low || number > high) {
        return complain("--%s %s: expected a whole number from %llu to %llu", o->name,
                        text, (unsigned long long)low, (unsigned long long)high);
    }
    *value = number;
    return EXIT_DONE;
}

// Reads WIDTHxHEIGHT, each at least 1. Returns the exit status.
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

// Reports that a text is none of the words of an option, and names these as people write
// them: "a, b or c".
static int complain_choice(const option_row *o, const char *text)
{
    g_auto(GStrv) words = g_strsplit(o->value, "|", -1);
    const guint count = g_strv_length(words);
    g_autoptr(GString) listed = g_string_new(words[0]);
    for (guint i = 1; i < count; i++) {
        g_string_append(listed, i + 1 < count ? ", " : " or ");
        g_string_append(listed, words[i]);
    }
    return complain("--%s %s: expected %s", o->name, text, listed->str);
}

static int check_choice(const option_row *o, const char *text)
{
    g_auto(GStrv) words = g_strsplit(o->value, "|", -1);
    if (text[0] != '\0' && g_strv_contains((const char *const *)words, text)) {
        return EXIT_DONE;
    }
    return complain_choice(o, text);
}

// Checks that a text is the key of a summary's quantity. Returns the exit status.
static int check_quantity(const option_row *o, const char *key)
{
    if (summary_find(key) >= 0) {
        return EXIT_DONE;
    }
    const char *near = summary_suggest(key);
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
static int store_value(arguments *a, const option_row *o, char *text)
{
    void *place = option_place(a, o);
    option_list *list = place; // of an option that may be repeated
    switch (o->type) {
    case OPTION_FLAG:
        *(bool *)place = true;
        return EXIT_DONE;
    case OPTION_NUMBER:
        return read_option_number(o, text, place);
    case OPTION_LENGTH:
        return read_length(o, text, place);
    case OPTION_WHOLE:
        return read_whole(o, text, place);
    case OPTION_SIZE:
        return read_size(o, text, place);
    case OPTION_NUMBERS:
        return read_option_number(o, text, &list->numbers[list->count++]);
    case OPTION_FILES:
    case OPTION_PARAMETERS:
        list->items[list->count++] = text;
        return EXIT_DONE;

    case OPTION_CHOICE:
        *(const char **)place = text;
        return check_choice(o, text);
    case OPTION_QUANTITY:
        *(const char **)place = text;
        return check_quantity(o, text);
    default:
        *(const char **)place = text;
        return EXIT_DONE;
    }
}

// --- getopt ----------------------------------------------------------------------------

// getopt_long's value of the option in row i is ROW_VALUE + i, apart from all letters
enum { ROW_VALUE = 256 };

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

// Reports an option that the command does not have, with what may have been meant.
static int complain_unknown_option(const arguments *a, const char *text)
{
    const command *self = a->command;

    // the option without its value, and its name without dashes
    g_autofree char *shown = g_strndup(text, strcspn(text, "="));
    const char *name = shown + strspn(shown, "-");

    // one that is right elsewhere
    const command *owner = owner_of_option(a->commands, name);
    if (owner != NULL) {
        return complain(
            "%s has no option %s, that is one of %s (see impactlab %s --help)",
            self->name, shown, owner->name, self->name);
    }

    // the command's option with the nearest name
    nearest_word near = nearest_begin(name);
    const option_row *o;
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
static void list_for_getopt(const command *self, struct option *longs, char *shorts)
{
    // the colon makes getopt tell a missing value from an unknown option
    *shorts++ = ':';

    const option_row *o;
    for (int i = 0; (o = command_option(self, i)) != NULL; i++) {
        const bool takes_value = o->type != OPTION_FLAG;
        assert(i < COMMAND_OPTIONS && (o->value != NULL) == takes_value);

        *longs++ = (struct option){o->name, takes_value, NULL, ROW_VALUE + i};
        if (o->alias != NULL) {
            *longs++ = (struct option){o->alias, takes_value, NULL, ROW_VALUE + i};
        }
        if (o->letter != 0) {
            *shorts++ = o->letter;
        }
        if (o->letter != 0 && takes_value) {
            *shorts++ = ':';
        }
    }
    *longs = (struct option){0};
    *shorts = '\0';
}

// The row of the option that getopt found.
static int find_row(const command *self, int found)
{
    int i = 0;
    while (found != ROW_VALUE + i && command_option(self, i)->letter != found) {
        i++;
    }
    return i;
}

// Adds a word to the command line that pictures remember, in quotes where a shell needs
// them.
static void remember_word(arguments *a, const char *before, const char *word)
{
    static const char special[] = " \t\n'\"\\$&|;<>()*?[]{}#~`!";
    const char *quote = "'";
    if (word[0] != '\0' && strpbrk(word, special) == NULL) {
        quote = "";
    }

    // behind what is remembered
    const char *so_far = "";
    if (a->command_line != NULL) {
        so_far = a->command_line;
    }
    char *longer = g_strconcat(so_far, before, quote, word, quote, NULL);
    g_free(a->command_line);
    a->command_line = longer;
}

// Remembers an option, unless it only says where results are written to, which does not
// change them.
static void remember_option(arguments *a, const option_row *o, const char *value)
{
    if (option_is_written(o)) {
        return;
    }
    remember_word(a, " --", o->name);
    if (o->type != OPTION_FLAG) {
        remember_word(a, " ", value);
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

    // complaints are ours, not those of getopt
    list_for_getopt(a->command, longs, shorts);
    opterr = 0;
    while (*exit_status == EXIT_DONE &&
           (found = getopt_long(argc, argv, shorts, longs, NULL)) != -1) {
        const char *text = argv[optind - 1];
        if (found == ':') {
            *exit_status = complain("option %s needs a value (see impactlab %s --help)",
                                    text, a->command->name);
            break;
        }
        if (found == '?') {
            *exit_status = complain_unknown_option(a, text);
            break;
        }

        // the option; --help ends the reading
        const int i = find_row(a->command, found);
        const option_row *o = command_option(a->command, i);
        if (o == help_options.rows) {
            return true;
        }

        // its value
        const bool may_repeat = o->type == OPTION_FLAG || option_is_list(o->type);
        if (given[i] && !may_repeat) {
            *exit_status = complain("option --%s was given twice", o->name);
        } else {
            *exit_status = store_value(a, o, optarg);
        }
        given[i] = true;
        remember_option(a, o, optarg);
    }
    return false;
}

// --- the whole command line ------------------------------------------------------------

// Whether a file that is read has an end, and is not one of the results.
static status check_read(const char *file, fault *f)
{
    TRY(input_file_check_plain(file, f));
    return input_file_check_kept(file, f);
}

// Checks a file that the command line names: FILE, or FILE.csv:COLUMN@SHIFT. Returns the
// exit status.
static int check_named_file(const char *text)
{
    g_autofree char *file = g_strdup(text);
    fault f = {0};
    status code = check_read(file, &f);

    // the same without its ending from the last @, and then from the last : on
    for (const char *mark = "@:"; *mark != '\0' && code == STATUS_OK; mark++) {
        char *ending = strrchr(file, *mark);
        if (ending != NULL) {
            *ending = '\0';
            code = check_read(file, &f);
        }
    }

    if (code != STATUS_OK) {
        return complain("'%s' %s", file, f.text);
    }
    return EXIT_DONE;
}

// Checks the files that an option names. Returns the exit status.
static int check_option_files(const arguments *a, const option_row *o)
{
    // one file, or several
    if (o->type == OPTION_FILE) {
        const char *const *file = option_place(a, o);
        if (*file != NULL) {
            return check_named_file(*file);
        }
    }

    if (o->type == OPTION_FILES) {
        const option_list *list = option_place(a, o);
        for (int i = 0; i < list->count; i++) {
            const int ended = check_named_file(list->items[i]);
            if (ended != EXIT_DONE) {
                return ended;
            }
        }
    }
    return EXIT_DONE;
}

// Checks all files that are read. What these name in their turn is looked at when they
// are read. Returns the exit status.
static int check_inputs(const arguments *a)
{
    // operands, then values of options
    for (int i = 0; i < a->operand_count; i++) {
        const int ended = check_named_file(a->operands[i]);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }

    const option_row *o;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const int ended = check_option_files(a, o);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    return EXIT_DONE;
}

// Whether a file with a content is there, and none that the option's result may replace.
static bool is_foreign_file(const option_row *o, const char *path)
{
    struct stat there;
    return o->replaces != NULL && stat(path, &there) == 0 && S_ISREG(there.st_mode) &&
           there.st_size > 0 && !o->replaces(path);
}

// Claims the places of all results, of which no two may be the same. Returns the exit
// status.
static int claim_results(const arguments *a)
{
    const option_row *o;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        const char *path = option_written(a, o);
        if (path == NULL) {
            continue;
        }
        if (is_foreign_file(o, path)) {
            return complain("--%s %s: a file of another kind is there and is kept, "
                            "expected another place",
                            o->name, path);
        }
        if (!result_places_add(path)) {
            const char *place = path;
            if (strcmp(path, "-") == 0) {
                place = "the standard output";
            }
            return complain("two results cannot both be written to %s", place);
        }
    }

    // the text of a picture that has none of its own
    if (a->bare && a->plot != NULL) {
        g_autofree char *text = picture_beside(a->plot, ".txt");
        if (!result_places_add(text)) {
            return complain("two results cannot both be written to %s", text);
        }
    }

    // the PDF that LaTeX reads for an SVG
    if (a->latex != NULL && a->plot != NULL) {
        g_autofree char *read = picture_for_latex(a->plot);
        if (strcmp(read, a->plot) != 0 && !result_places_add(read)) {
            return complain("two results cannot both be written to %s", read);
        }
    }
    return EXIT_DONE;
}

// Checks the number of operands, and all places and files that are named. Returns the
// exit status.
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

    // what they and the options name
    const int ended = claim_results(a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    return check_inputs(a);
}

// Gives every list room for a whole command line, and numbers their initial values.
static void prepare_places(arguments *a, int argc)
{
    const option_row *o;
    for (int i = 0; (o = command_option(a->command, i)) != NULL; i++) {
        void *place = option_place(a, o);
        if (option_is_list(o->type)) {
            option_list *list = place;
            list->items = g_malloc0_n((size_t)argc + 1,
                                      MAX(sizeof *list->items, sizeof *list->numbers));
        } else if (o->type == OPTION_NUMBER) {
            *(double *)place = o->initial;
        }
    }
}

bool arguments_read(arguments *a, int argc, char **argv, int *exit_status)
{
    assert(argc > 0 && a->command != NULL && a->commands != NULL);
    *exit_status = EXIT_DONE;
    prepare_places(a, argc);
    remember_word(a, "impactlab ", a->command->name);

    if (take_options(a, argc, argv, exit_status)) {
        arguments_finish(a);
        return false;
    }

    // getopt has moved all that is no option behind the options
    a->operands = argv + optind;
    a->operand_count = argc - optind;
    for (int i = 0; i < a->operand_count; i++) {
        remember_word(a, " ", a->operands[i]);
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
            g_free(((option_list *)option_place(a, o))->items);
        }
    }
    g_free(a->command_line);
    result_places_forget();
    *a = (arguments){0};
}

#include "ui/commands/command.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"

// Every option of every command, by a letter that is also its short form where `is_short` says so.
typedef struct option_info {
    char letter;
    bool is_short;
    const char *name;
    const char *value; // what it takes, NULL if nothing
    const char *help;
} option_info;

static const option_info option_table[] = {
    {'s', false, "set", "PATH=VALUE", "give a parameter another value (may be repeated)"},
    {'j', false, "json", "FILE|-", "write the results as JSON; - is the standard output"},
    {'c', false, "csv", "FILE|-", "write the recorded signals, one row a step"},
    {'p', false, "plot", "FILE.{png,pdf,svg}", "draw the recorded signals"},
    {'S', false, "scene", "FILE.png", "draw the arm"},
    {'v', false, "vary", "PATH=a:b:n", "vary a parameter: n values from a to b (may be repeated)"},
    {'m', false, "sample", "grid|random|latin", "how the values are combined (grid)"},
    {'n', false, "runs", "N", "number of runs at random or of a Latin hypercube"},
    {'e', false, "seed", "S", "start of the random numbers (0)"},
    {'J', false, "jobs", "J", "number of runs at a time (as many as processors)"},
    {'d', false, "db", "FILE.sqlite", "keep every run in a database; go on where it ends"},
    {'C', false, "csv", "FILE|-", "write a row for each run"},
    {'P', false, "plot", "FILE.{png,pdf,svg}", "draw the quantity over one or two parameters"},
    {'Q', false, "quantity", "KEY", "what to draw and to sum up (peak_force_N)"},
    {'L', false, "plot", "FILE.{png,pdf,svg}", "draw the study; a CSV of what is drawn beside it"},
    {'O', false, "only", "NAME", "measure this one alone"},
    {'B', false, "baseline", "FILE", "compare with what --json wrote before"},
    {'A', false, "against", "SCENARIO", "a run to hold the others against"},
    {'t', false, "tolerance", "PERCENT", "differences beyond it are marked (5)"},
    {'X', false, "markdown", "FILE|-", "write the table as one of a Markdown page"},
    {'H', false, "columns", "KEY,KEY...", "show only these quantities, by their keys of --json"},
    {'M', false, "mono", NULL, "black and greys on white"},
    {'D', false, "dark", NULL, "on near black"},
    {'W', false, "width", "MM", "width of the page in millimetres"},
    {'Y', false, "overlay", "FILE.csv", "points of reference data over recorded signals"},
    {'i', false, "dpi", "N", "resolution of a PNG (200)"},
    {'T', false, "at", "T", "draw the arm at this instant [s] (may be repeated)"},
    {'G', false, "gl", "osmesa|egl|cairo|auto", "what draws the arm (auto)"},
    {'K', false, "camera", "three-quarter|top|side", "where it is seen from (three-quarter)"},
    {'Z', false, "size", "WIDTHxHEIGHT", "of the picture in pixels (1280x720)"},
    {'F', false, "fps", "N", "frames per second of the film (30)"},
    {'U', false, "seconds", "S", "length of the film (10)"},
    {'V', false, "slow", "N", "how much the first impact is slowed down (8)"},
    {'k', false, "keys", "KEYS", "press these keys: characters, and <Right>, <Enter>, <C-l>..."},
    {'r', false, "script", "FILE|-", "carry out commands, one a line, as : takes them"},
    {'z', false, "size", "WIDTHxHEIGHT", "print a screen of this size in characters (120x40)"},
    {'g', false, "glyphs", "braille|blocks|ascii", "characters to draw with"},
    {'E', false, "theme", "dark|light|mono", "colours for that ground"},
    {'I', false, "colours", "auto|true|256|16|mono", "how many of them the terminal has"},
    {'o', true, "output", "PATH", "file or folder to write to"},
    {'f', false, "format", "png,pdf,svg", "which kinds of files to write"},
    {'q', true, "quiet", NULL, "print no summary"},
    {'h', true, "help", NULL, "print this help"},
};
enum { OPTIONS = sizeof option_table / sizeof option_table[0] };

static bool has_option(const command *self, const option_info *info)
{
    return info->letter == 'h' || strchr(self->options, info->letter) != NULL;
}

void print_help(const command *self)
{
    printf("impactlab %s%s%s%s\n\n%s.\n", self->name, self->operands[0] ? " " : "", self->operands,
           " [OPTION]...", self->summary);
    if (self->help[0] != '\0') {
        printf("\n%s", self->help);
    }
    printf("\nOptions:\n");
    for (int i = 0; i < OPTIONS; i++) {
        const option_info *info = &option_table[i];
        if (has_option(self, info)) {
            char text[64];
            snprintf(text, sizeof text, "--%s%s%s", info->name, info->value ? " " : "",
                     info->value ? info->value : "");
            printf("  %c%c%c %-26s  %s\n", info->is_short ? '-' : ' ',
                   info->is_short ? info->letter : ' ', info->is_short ? ',' : ' ', text,
                   info->help);
        }
    }
}

// Stores an option's value; false if it was given before.
static bool take_text(const char **slot, const char *value)
{
    bool first = *slot == NULL;
    *slot = value;
    return first;
}

static bool take_option(arguments *a, int letter, char *value)
{
    switch (letter) {
    case 's':
        a->sets[a->set_count++] = value;
        return true;
    case 'j':
        return take_text(&a->json, value);
    case 'c':
    case 'C':
        return take_text(&a->csv, value);
    case 'p':
    case 'P':
    case 'L':
        return take_text(&a->plot, value);
    case 'S':
        return take_text(&a->scene, value);
    case 'v':
        a->varies[a->vary_count++] = value;
        return true;
    case 'm':
        return take_text(&a->sample, value);
    case 'n':
        return take_text(&a->runs, value);
    case 'e':
        return take_text(&a->seed, value);
    case 'J':
        return take_text(&a->jobs, value);
    case 'd':
        return take_text(&a->db, value);
    case 'Q':
        return take_text(&a->quantity, value);
    case 'O':
        return take_text(&a->only, value);
    case 'B':
        return take_text(&a->baseline, value);
    case 'A':
        return take_text(&a->against, value);
    case 't':
        return take_text(&a->tolerance, value);
    case 'X':
        return take_text(&a->markdown, value);
    case 'H':
        return take_text(&a->columns, value);
    case 'M':
        a->mono = true;
        return true;
    case 'D':
        a->dark = true;
        return true;
    case 'Y':
        return take_text(&a->overlay, value);
    case 'W':
        return take_text(&a->width, value);
    case 'i':
        return take_text(&a->dpi, value);
    case 'T':
        a->ats[a->at_count++] = value;
        return true;
    case 'G':
        return take_text(&a->gl, value);
    case 'K':
        return take_text(&a->camera, value);
    case 'Z':
        return take_text(&a->size, value);
    case 'F':
        return take_text(&a->fps, value);
    case 'U':
        return take_text(&a->seconds, value);
    case 'V':
        return take_text(&a->slow, value);
    case 'k':
        return take_text(&a->keys, value);
    case 'r':
        return take_text(&a->script, value);
    case 'z':
        return take_text(&a->size, value);
    case 'g':
        return take_text(&a->glyphs, value);
    case 'I':
        return take_text(&a->colours, value);
    case 'E':
        return take_text(&a->theme, value);
    case 'o':
        return take_text(&a->output, value);
    case 'f':
        return take_text(&a->format, value);
    default:
        a->quiet = true;
        return true;
    }
}

// What is said of an option getopt does not take.
static int complain_option(const command *self, int found, const char *text)
{
    char shown[96];
    if (found == ':') {
        return complain("option %s needs a value (see impactlab %s --help)", text, self->name);
    }
    snprintf(shown, sizeof shown, "%.*s", (int)strcspn(text, "="), text);
    nearest_word near = nearest_begin(shown + strspn(shown, "-"));
    for (int i = 0; i < OPTIONS; i++) {
        if (has_option(self, &option_table[i])) {
            nearest_try(&near, option_table[i].name);
        }
    }
    if (near.best != NULL && near.distance > 0) {
        return complain("%s has no option %s, did you mean --%s?", self->name, shown, near.best);
    }
    return complain("%s has no option %s (see impactlab %s --help)", self->name, shown, self->name);
}

// Fills getopt's tables with the options of the command.
static void option_lists(const command *self, struct option *longs, char *shorts)
{
    // the colon makes getopt tell a missing value from an unknown option
    *shorts++ = ':';
    for (int i = 0; i < OPTIONS; i++) {
        const option_info *info = &option_table[i];
        if (!has_option(self, info)) {
            continue;
        }
        *longs++ = (struct option){info->name, info->value != NULL, NULL, info->letter};
        if (info->is_short) {
            *shorts++ = info->letter;
            if (info->value != NULL) {
                *shorts++ = ':';
            }
        }
    }
    *longs = (struct option){0};
    *shorts = '\0';
}

static const char *option_name(int letter)
{
    for (int i = 0; i < OPTIONS; i++) {
        if (option_table[i].letter == letter) {
            return option_table[i].name;
        }
    }
    return "";
}

// Two results must not end in one place.
static int check_places(const arguments *a)
{
    const char *places[] = {a->json, a->csv, a->plot, a->scene, a->db, a->markdown, a->output};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        for (size_t j = 0; j < i; j++) {
            if (places[i] != NULL && places[j] != NULL && strcmp(places[i], places[j]) == 0) {
                return complain("two results cannot both be written to %s",
                                strcmp(places[i], "-") == 0 ? "the standard output" : places[i]);
            }
        }
    }
    return EXIT_DONE;
}

static int check_operands(const arguments *a, const command *self)
{
    const char *name = self->name;
    if (a->operand_count < self->least) {
        return complain("%s needs %s (see impactlab %s --help)", name, self->operands, name);
    }
    if (a->operand_count > self->most) {
        return complain("%s does not know what to do with '%s' (see impactlab %s --help)", name,
                        a->operands[self->most], name);
    }
    return check_places(a);
}

bool arguments_read(arguments *a, const command *self, int argc, char **argv, int *exit_status)
{
    struct option longs[OPTIONS + 1];
    char shorts[2 * OPTIONS + 2];
    int letter;
    memset(a, 0, sizeof *a);
    a->sets = calloc((size_t)argc + 1, sizeof *a->sets);
    a->varies = calloc((size_t)argc + 1, sizeof *a->varies);
    a->ats = calloc((size_t)argc + 1, sizeof *a->ats);
    if (a->sets == NULL || a->varies == NULL || a->ats == NULL) {
        arguments_finish(a);
        complain("out of memory");
        *exit_status = EXIT_FAILED;
        return false;
    }
    option_lists(self, longs, shorts);
    opterr = 0;
    *exit_status = EXIT_DONE;
    while (*exit_status == EXIT_DONE &&
           (letter = getopt_long(argc, argv, shorts, longs, NULL)) != -1) {
        if (letter == 'h') {
            print_help(self);
            arguments_finish(a);
            return false;
        }
        if (letter == '?' || letter == ':') {
            *exit_status = complain_option(self, letter, argv[optind - 1]);
        } else if (!take_option(a, letter, optarg)) {
            *exit_status = complain("option --%s was given twice", option_name(letter));
        }
    }
    a->operands = argv + optind;
    a->operand_count = argc - optind;
    if (*exit_status == EXIT_DONE) {
        *exit_status = check_operands(a, self);
    }
    if (*exit_status != EXIT_DONE) {
        arguments_finish(a);
    }
    return *exit_status == EXIT_DONE;
}

void arguments_finish(arguments *a)
{
    free(a->sets);
    free(a->varies);
    free(a->ats);
    memset(a, 0, sizeof *a);
}

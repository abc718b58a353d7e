// Command lines made from the tables of options: each option in one of its spellings,
// with values of its type and others, in the order of the bytes. A line is refused with a
// sentence and status 2, or the command runs on a small scenario and ends with a known
// status, saying why where it is not 0; nothing that is said has control characters.
#include "tests/fuzz/fuzz.h"

#include <getopt.h>
#include <sys/mman.h>
#include <unistd.h>

#include "ui/command_table.h"
#include "ui/commands/arguments.h"
#include "ui/commands/results.h"

enum { MOST_LINES = 16, MOST_WORDS = 40, MOST_LETTERS = 24, DRAWN_OF = 16 };

// A line that is being made.
typedef struct line {
    char *words[MOST_WORDS + 1];
    int count;
    bool raw;   // has a word of any letters
    bool draws; // paints, which takes long
} line;

static void add(line *l, char *word)
{
    if (l->count == MOST_WORDS) {
        free(word);
        return;
    }
    l->words[l->count++] = word;
}

static char *raw_word(source *s, line *l)
{
    char word[MOST_LETTERS + 1];
    fuzz_letters(s, word, MOST_LETTERS);
    l->raw = true;
    return strdup(word[0] == '.' || word[0] == '-' ? "_" : word);
}

// A value for an option: mostly of its type.
static char *value_for(source *s, line *l, const option_row *o)
{
    char text[64];
    if (next(s) % 8 == 0) {
        return raw_word(s, l);
    }
    switch (o->type) {
    case OPTION_CHOICE:
    case OPTION_WORD: {
        // one of its words
        const char *word = o->value;
        for (int skip = next(s) % 8; skip > 0 && strchr(word, '|') != NULL; skip--) {
            word = strchr(word, '|') + 1;
        }
        return strndup(word, strcspn(word, "|"));
    }
    case OPTION_FILE:
    case OPTION_SCENARIO:
        return strdup(
            ONE_OF(s, "small.yaml", "printed.yaml", "two.set", "none", ".", "/dev/null"));
    case OPTION_RESULT:
    case OPTION_PICTURE:
    case OPTION_PLACE:
        return strdup(ONE_OF(s, "out.json", "out.csv", "out.svg", "out.png", "-",
                             "/dev/full", "none/out.svg", ".", "out.sqlite"));
    case OPTION_QUANTITY:
        return strdup(ONE_OF(s, "peak_force_N", "first_contact_s", "impacts",
                             "peak_force", "", "energy_J"));
    case OPTION_NUMBER:
    case OPTION_NUMBERS:
    case OPTION_LENGTH:
    case OPTION_WHOLE:
        // at both ends of its range and beyond
        snprintf(text, sizeof text, "%g", next(s) % 2 == 0 ? o->low : o->low + 1);
        return strdup(next(s) % 3 > 0
                          ? text
                          : ONE_OF(s, "0", "-1", "2", "1e308", "nan", "inf", "1e-320",
                                   "85mm", "2 s", "0x2", "", "18446744073709551616"));
    case OPTION_SIZE:
        return strdup(
            ONE_OF(s, "64x48", "1x1", "0x0", "9x", "x9", "99999999999x2", "-3x3"));
    case OPTION_PARAMETERS:
        return strdup(ONE_OF(s, "motor.voltage=3", "motor.voltage=1:3:2", "arm.k2=4,6",
                             "arm.links=3", "wall.kind=plane", "wall.kind=none",
                             "control.law=hybrid", "arm.model=printed", "motor.voltage",
                             "=", "arm.k3=1", "method.name=event,newmark",
                             "run.duration=0.05", "control.seed=1:2", "wall.angle=nan",
                             "arm.k2=0:0:2"));
    default:
        return strdup(ONE_OF(s, "hybrid,force-pd", "1/2", "3/2", "force,last_angle",
                             "0.01:2,0.02:0", "DejaVu Sans", "a", "",
                             "peak_force_N,impacts", ":seek 0.01<Enter>D"));
    }
}

// "--name value", "--name=value", "-n value", a beginning of the name, or another
// option's alias.
static void add_option(source *s, line *l, const command *c)
{
    int count = 0;
    char *word = NULL;
    while (command_option(c, count) != NULL) {
        count++;
    }
    const option_row *o = command_option(c, next(s) % count);
    char *value = o->type == OPTION_FLAG ? NULL : value_for(s, l, o);
    l->draws = l->draws || strcmp(o->name, "plot") == 0 || strcmp(o->name, "scene") == 0;
    const int how = next(s) % 8;
    const char *name = o->alias != NULL && how == 0 ? o->alias : o->name;
    if (o->letter != 0 && how < 3) {
        FUZZ_CHECK(asprintf(&word, "-%c", o->letter) > 0);
    } else if (value != NULL && how < 5) {
        FUZZ_CHECK(asprintf(&word, "--%s=%s", name, value) > 0);
        free(value);
        value = NULL;
    } else {
        FUZZ_CHECK(asprintf(&word, "--%.*s", how == 7 ? 3 : 64, name) > 0);
    }
    add(l, word);
    if (value != NULL && how != 6) {
        add(l, value);
    } else {
        free(value);
    }
}

static line make(source *s, const command *c)
{
    line l = {.words = {strdup(c->name)}, .count = 1};
    const bool study = strcmp(c->name, "study") == 0;
    if (next(s) % 8 > 0 && c->most > 0) {
        add(&l, strdup(study ? "links" : "small.yaml"));
    }
    for (int left = next(s) % 5; left > 0; left--) {
        if (next(s) % 8 == 0) {
            add(&l, next(s) % 6 == 0
                        ? raw_word(s, &l)
                        : strdup(ONE_OF(s, "small.yaml", "small.yaml", "printed.yaml",
                                        "recipe.yaml", "methods", "links", "part.sqlite",
                                        "none.yaml", "--", "run", "bash", "4.1")));
        } else {
            add_option(s, &l, c);
        }
    }
    return l;
}

// ---- what may be run

// Neither the terminal nor minutes nor a program of the line's own.
static bool may_run(const arguments *a, const line *l)
{
    static const char *const left_out[] = {"lab",    "lesson", "tables", "figures",
                                           "report", "bench",  "animate"};
    static int inputs;
    for (size_t i = 0; i < sizeof left_out / sizeof left_out[0]; i++) {
        if (strcmp(a->command->name, left_out[i]) == 0) {
            return false;
        }
    }
    return !a->allow_code && a->runs < 4 && (!l->draws || inputs++ % DRAWN_OF == 0);
}

static void write_text(const char *path, const char *text)
{
    FILE *stream = fopen(path, "w");
    FUZZ_CHECK(stream != NULL && fputs(text, stream) >= 0 && fclose(stream) == 0);
}

static void make_files(void)
{
    fuzz_folder();
    write_text("small.yaml", "title: small\nrun: {duration: 0.02 s}\ninitial: {angle: "
                             "-0.001}\nwall: {angle: 0}\n");
    write_text("printed.yaml",
               "title: printed\narm: {model: printed}\nrun: {duration: 0.02 s}\n");
    write_text("two.set", "case one: arm.k2=4\ncase two: motor.voltage=2\n");
    write_text("recipe.yaml",
               "runs:\n  - {scenario: small.yaml}\npanels:\n  - {signals: [force]}\n");
}

// What was said since the stream was rewound has no control characters. Returns its
// length.
static long check_said(FILE *stream)
{
    fflush(stream);
    const long length = ftell(stream);
    char *text =
        mmap(NULL, (size_t)length + 1, PROT_READ, MAP_PRIVATE, fileno(stream), 0);
    FUZZ_CHECK(text != MAP_FAILED);
    for (long i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)text[i];
        FUZZ_CHECK((c >= ' ' && c != 0x7f) || c == '\n' || c == '\r' || c == '\t');
    }
    munmap(text, (size_t)length + 1);
    rewind(stream);
    FUZZ_CHECK(ftruncate(fileno(stream), 0) == 0);
    return length;
}

// From now on the standard streams are files in memory; a broken promise is told on the
// descriptor.
static void take_streams(void)
{
    static bool taken;
    if (taken) {
        return;
    }
    taken = true;
    const int out = memfd_create("out", 0), err = memfd_create("err", 0);
    FUZZ_CHECK(out >= 0 && err >= 0);
    stdout = fdopen(out, "w+");
    stderr = fdopen(err, "w+");
    FUZZ_CHECK(stdout != NULL && stderr != NULL);
}

// Makes a line, reads it, and runs it where it may be run.
static void try_line(source *s)
{
    const command *c = command_table.items[next(s) % command_table.count];
    line l = make(s, c);
    char *words[MOST_WORDS + 1];
    arguments a = {.command = c, .commands = &command_table};
    int code = -1;

    // getopt begins anew, and moves words about
    memcpy(words, l.words, sizeof words);
    optind = 0;
    if (arguments_read(&a, l.count, words, &code)) {
        FUZZ_CHECK(code == EXIT_DONE && a.operand_count >= c->least &&
                   a.operand_count <= c->most);
        if (may_run(&a, &l)) {
            code = check_results(&a);
            code = code == EXIT_DONE ? command_run(&a) : code;
            FUZZ_CHECK(code >= EXIT_DONE && code <= EXIT_BAD_ARGUMENTS);
        }
        arguments_finish(&a);
    } else {
        FUZZ_CHECK(code == EXIT_DONE || code == EXIT_BAD_ARGUMENTS);
    }

    // what is not done is said
    check_said(stdout);
    FUZZ_CHECK(check_said(stderr) > 0 || code == EXIT_DONE);
    for (int i = 0; i < l.count; i++) {
        free(l.words[i]);
    }
}

// Several lines: what one leaves behind, the next one meets.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    source s = {data, size, 0};
    make_files();
    take_streams();
    for (int i = 0; i < MOST_LINES && s.at < s.size; i++) {
        try_line(&s);
    }
    return 0;
}

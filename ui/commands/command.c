// The commands there are, and what they share.
#include "ui/commands/command.h"

#include <assert.h>
#include <langinfo.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "src/scenario/outside.h"
#include "ui/commands/interrupts.h"

// One line a command: its name as a C word, in the order in which they are listed.
#define COMMANDS(X)                                                                      \
    X(lab)                                                                               \
    X(lesson)                                                                            \
    X(list)                                                                              \
    X(show)                                                                              \
    X(check)                                                                             \
    X(run)                                                                               \
    X(predict)                                                                           \
    X(modes)                                                                             \
    X(sweep)                                                                             \
    X(merge)                                                                             \
    X(compare)                                                                           \
    X(converge)                                                                          \
    X(solve)                                                                             \
    X(study)                                                                             \
    X(identify)                                                                          \
    X(calibrate)                                                                         \
    X(robust)                                                                            \
    X(linear)                                                                            \
    X(tune)                                                                              \
    X(animate)                                                                           \
    X(plot)                                                                              \
    X(tables)                                                                            \
    X(figures)                                                                           \
    X(report)                                                                            \
    X(bench)                                                                             \
    X(help)

#define COMMAND_DECLARED(name) extern const command name##_command;
COMMANDS(COMMAND_DECLARED)
#undef COMMAND_DECLARED

const command *const command_table[] = {
#define COMMAND_ADDRESS(name) &name##_command,
    COMMANDS(COMMAND_ADDRESS)
#undef COMMAND_ADDRESS
};
const int command_count = (int)(sizeof command_table / sizeof command_table[0]);

const command *command_find(const char *name)
{
    for (int i = 0; i < command_count; i++) {
        if (strcmp(command_table[i]->name, name) == 0) {
            return command_table[i];
        }
    }
    return NULL;
}

int complain_command(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < command_count; i++) {
        nearest_try(&near, command_table[i]->name);
    }
    if (near.best != NULL) {
        return complain("there is no command '%s', did you mean '%s'?", name, near.best);
    }

    // nothing is near: all there are
    char known[256] = "";
    size_t length = 0;
    for (int i = 0; i < command_count && length < sizeof known; i++) {
        length += (size_t)snprintf(known + length, sizeof known - length, "%s%s",
                                   i ? ", " : "", command_table[i]->name);
    }
    return complain("there is no command '%s', only %s", name, known);
}

void *option_place(const arguments *a, const option_row *o)
{
    return (char *)a + o->place;
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

// The text an option's place holds, NULL if it was not given. Only for types that store a
// text.
static const char *option_text(const arguments *a, const option_row *o)
{
    assert(o->type >= OPTION_TEXT && o->type <= OPTION_QUANTITY);
    return *(const char **)option_place(a, o);
}

bool option_is_written(const option_row *o)
{
    return o->type == OPTION_RESULT || o->type == OPTION_PICTURE ||
           o->type == OPTION_PLACE;
}

const char *option_written(const arguments *a, const option_row *o)
{
    if (option_is_written(o)) {
        return option_text(a, o);
    }
    return NULL;
}

// --- what they share -------------------------------------------------------------------

int complain(const char *format, ...)
{
    va_list list;
    fflush(stdout);
    fputs("impactlab: ", stderr);
    va_start(list, format);
    print_printable_list(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
    return EXIT_BAD_ARGUMENTS;
}

int complain_fault(const fault *f)
{
    complain("%s", f->text[0] ? f->text : status_text(f->code));

    // what the user can mend, and what went wrong on the way
    switch (f->code) {
    case STATUS_OK:
        return EXIT_DONE;
    case STATUS_BAD_ARGUMENT:
    case STATUS_BAD_SCENARIO:
    case STATUS_CANNOT_READ:
        return EXIT_BAD_ARGUMENTS;
    default:
        return EXIT_FAILED;
    }
}

void report_to_stderr(void *context, const char *sentence)
{
    fflush(stdout);
    print_printable(stderr, "%s\n", sentence);
}

void tell_first_fault(told_faults *t)
{
    if (t->first != NULL) {
        report_to_stderr(NULL, t->first);
    }
    free(t->first);
    t->first = NULL;
}

void tell_fault(void *context, const char *sentence)
{
    told_faults *t = context;
    tell_first_fault(t);
    if (t->count++ == 0) {
        t->first = strdup(sentence);
    } else {
        t->first = NULL;
    }
    if (t->first == NULL) {
        report_to_stderr(NULL, sentence);
    }
}

int tell_unopened(told_faults *t, status code, const char *name_or_file)
{
    assert(code != STATUS_OK);
    if (t->count == 0) {
        complain("'%s': %s", name_or_file, status_text(code));
    } else if (t->first != NULL && code == STATUS_BAD_ARGUMENT) {
        complain("%s", t->first);
        free(t->first);
        t->first = NULL;
    }
    tell_first_fault(t);
    if (code == STATUS_NO_MEMORY) {
        return EXIT_FAILED;
    }
    return EXIT_BAD_ARGUMENTS;
}

void complain_sentence(void *context, const char *sentence)
{
    complain("%s", sentence);
}

int open_scenario(scenario *s, const char *name_or_file, const arguments *a)
{
    told_faults told = {0};
    status code = scenario_open(s, name_or_file, tell_fault, &told);
    if (code != STATUS_OK) {
        return tell_unopened(&told, code, name_or_file);
    }
    tell_first_fault(&told);

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
    return interrupts_end(c->use != NULL ? with_scenario(a->operands[0], a, c->use)
                                         : c->run(a));
}

RESULT_WRITER(write_value, json_t, json_write(stream, found))

int write_json(const char *path, json_t *value)
{
    // all of it or nothing
    const bool lost = loss_noted() || value == NULL;
    const int result = lost ? complain_fault(&(fault){.code = STATUS_NO_MEMORY})
                            : write_file(path, write_value, NULL, value);
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
        const char *path = o->type == OPTION_RESULT ? option_text(a, o) : NULL;
        alone = alone || (path != NULL && strcmp(path, "-") == 0);
    }
    return !a->quiet && !alone;
}

void say(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    print_printable_list(stdout, format, list);
    va_end(list);
}

void print_cell(int width, const char *conversion, double value)
{
    char text[40] = "-";
    if (!isnan(value)) {
        snprintf(text, sizeof text, conversion, value);
    }
    printf(" %*s", width, text);
}

void say_title(const scenario *s)
{
    char title[SCENARIO_TITLED];
    say("%s: %s\n", s->name, scenario_titled(s, title));
}

bool terminal_has_utf8(void)
{
    if (strcmp(nl_langinfo(CODESET), "UTF-8") == 0) {
        return true;
    }

    // a locale that is not installed, or had no memory, tells by its name
    static const char *const places[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    const char *name = NULL;
    for (int i = 0; i < 3 && (name == NULL || *name == '\0'); i++) {
        name = getenv(places[i]);
    }
    return name != NULL &&
           (strcasestr(name, ".UTF-8") != NULL || strcasestr(name, ".utf8") != NULL);
}

// --- longer texts ----------------------------------------------------------------------

void print_indented(FILE *stream, const char *text, int bytes, int width, int indent)
{
    const char *end = text + bytes;
    int column = 0;
    assert(bytes >= 0 && indent >= 0 && width > indent);
    while ((text += strspn(text, " \n")) < end) {
        char word[256];
        int length = (int)strcspn(text, " \n");
        if (!(length < end - text)) {
            length = (int)(end - text);
        }
        snprintf(word, sizeof word, "%.*s", length, text);

        // a word goes to the next line if this one has no room for it
        int wide = 0;
        for (const char *c = word; *c != '\0'; c++) {
            wide += ((unsigned char)*c & 0xC0) != 0x80; // of UTF-8
        }
        const bool fits = column > 0 && column + 1 + wide <= width;
        if (!fits) {
            fprintf(stream, "%s%*s", column > 0 ? "\n" : "", indent, "");
        }
        print_printable(stream, "%s%.*s", fits ? " " : "", length, text);
        if (fits) {
            column = column + 1 + wide;
        } else {
            column = indent + wide;
        }
        text += length;
    }
    fprintf(stream, "%s", column > 0 ? "\n" : "");
}

bool next_paragraph(const char **text, paragraph *p)
{
    *text += strspn(*text, "\n");
    if (**text == '\0') {
        return false;
    }
    *p = (paragraph){.start = *text, .literal = **text == ' '};

    // lines are one paragraph until one that is empty or begins with a blank
    do {
        *text += strcspn(*text, "\n");
        p->bytes = (int)(*text - p->start);
        *text += **text == '\n';
    } while (!p->literal && strchr("\n ", **text) == NULL);
    return true;
}

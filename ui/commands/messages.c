#include "ui/commands/messages.h"

#include <assert.h>
#include <glib.h>
#include <langinfo.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/words.h"

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
    const char *sentence = f->text;
    if (sentence[0] == '\0') {
        sentence = status_text(f->code);
    }
    complain("%s", sentence);

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
    (void)context;
    fflush(stdout);
    print_printable(stderr, "%s\n", sentence);
}

void report_first_fault(opening_faults *t)
{
    if (t->first != NULL) {
        report_to_stderr(NULL, t->first);
    }
    g_clear_pointer(&t->first, g_free);
}

void report_opening_fault(void *context, const char *sentence)
{
    opening_faults *t = context;
    t->count++;
    if (t->count == 1) {
        t->first = g_strdup(sentence);
        return;
    }
    report_first_fault(t);
    report_to_stderr(NULL, sentence);
}

int report_unopened(opening_faults *t, status code, const char *name_or_file)
{
    assert(code != STATUS_OK);
    if (t->count == 0) {
        complain("'%s': %s", name_or_file, status_text(code));
    } else if (t->first != NULL && code == STATUS_BAD_ARGUMENT) {
        // there is no such scenario
        complain("%s", t->first);
        g_clear_pointer(&t->first, g_free);
    }
    report_first_fault(t);

    if (code == STATUS_NO_MEMORY) {
        return EXIT_FAILED;
    }
    return EXIT_BAD_ARGUMENTS;
}

void complain_sentence(void *context, const char *sentence)
{
    (void)context;
    complain("%s", sentence);
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

const char *blank_before(const char *unit)
{
    if (unit[0] != '\0') {
        return " ";
    }
    return "";
}

const char *plural_ending(size_t count)
{
    if (count == 1) {
        return "";
    }
    return "s";
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

    // a locale that is not installed says it by its name, in the first variable that is
    // set
    static const char *const variables[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    const char *name = NULL;
    for (int i = 0; i < 3 && (name == NULL || *name == '\0'); i++) {
        name = getenv(variables[i]);
    }
    return name != NULL &&
           (strcasestr(name, ".UTF-8") != NULL || strcasestr(name, ".utf8") != NULL);
}

// --- longer texts ----------------------------------------------------------------------

// Characters of a word in UTF-8: its bytes but those that continue a character.
static int characters_of(const char *word, int bytes)
{
    int count = 0;
    for (int i = 0; i < bytes; i++) {
        if (((unsigned char)word[i] & 0xC0) != 0x80) {
            count++;
        }
    }
    return count;
}

void print_indented(FILE *stream, const char *text, int bytes, int width, int indent)
{
    const char *end = text + bytes;
    int column = 0;
    assert(bytes >= 0 && indent >= 0 && width > indent);

    // word by word: what is between them stands for one blank
    while ((text += strspn(text, " \n")) < end) {
        int length = (int)strcspn(text, " \n");
        if (length > end - text) {
            length = (int)(end - text);
        }
        const int characters = characters_of(text, length);

        // on this line if it has room, else on the next
        if (column > 0 && column + 1 + characters <= width) {
            fputc(' ', stream);
            column++;
        } else {
            if (column > 0) {
                fputc('\n', stream);
            }
            fprintf(stream, "%*s", indent, "");
            column = indent;
        }
        print_printable(stream, "%.*s", length, text);
        column += characters;
        text += length;
    }
    if (column > 0) {
        fputc('\n', stream);
    }
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
        if (**text == '\n') {
            (*text)++;
        }
    } while (!p->literal && strchr("\n ", **text) == NULL);
    return true;
}

// Man pages from the tables of commands and options: one a command, and one of impactlab.
#include "ui/commands/command.h"

#include <assert.h>
#include <ctype.h>
#include <string.h>

#include "src/base/shipped.h"

// Text in which troff finds no request and no escape of its own.
static void put_text(FILE *stream, const char *text, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        // a dot or quote at the start of a line would be a request
        bool at_start = i == 0 || text[i - 1] == '\n';
        if (at_start && strchr(".'", text[i]) != NULL) {
            fputs("\\&", stream);
        }

        switch (text[i]) {
        case '\\':
            fputs("\\e", stream);
            break;
        case '-':
            fputs("\\-", stream);
            break;
        default:
            fputc(text[i], stream);
        }
    }
}

static void put_string(FILE *stream, const char *text)
{
    put_text(stream, text, (int)strlen(text));
}

static void put_upper(FILE *stream, const char *text)
{
    for (; *text != '\0'; text++) {
        fputc(toupper((unsigned char)*text), stream);
    }
}

static void put_title(FILE *stream, const char *title)
{
    fprintf(stream, ".SH ");
    put_upper(stream, title);
    fprintf(stream, "\n");
}

static void put_paragraphs(FILE *stream, const char *text)
{
    paragraph p;
    bool was_literal = false;

    while (next_paragraph(&text, &p)) {
        if (p.literal && !was_literal) {
            fprintf(stream, ".PP\n.nf\n");
        } else if (!p.literal) {
            fprintf(stream, "%s.PP\n", was_literal ? ".fi\n" : "");
        }

        put_text(stream, p.start, p.bytes);
        fprintf(stream, "\n");
        was_literal = p.literal;
    }

    fprintf(stream, "%s", was_literal ? ".fi\n" : "");
}

static void put_option(FILE *stream, const option_row *o)
{
    fprintf(stream, ".TP\n\\fB");
    if (o->letter != 0) {
        fprintf(stream, "\\-%c\\fR, \\fB", o->letter);
    }
    fprintf(stream, "\\-\\-");
    put_string(stream, o->name);

    if (o->value != NULL) {
        fprintf(stream, " \\fI");
        put_string(stream, o->value);
    }

    fprintf(stream, "\\fR\n");
    put_string(stream, o->help);
    fprintf(stream, "\n");
}

static void put_options(FILE *stream, const option_table *t, const char *title_before)
{
    if (strcmp(t->title, title_before) != 0) {
        put_title(stream, t->title);
    }
    for (int i = 0; i < t->count; i++) {
        put_option(stream, &t->rows[i]);
    }
}

// A list of terms, each with what it means.
typedef struct term {
    const char *name, *meaning;
} term;

static void put_terms(FILE *stream, const char *title, const term *terms, int count)
{
    put_title(stream, title);
    for (int i = 0; i < count; i++) {
        fprintf(stream, ".TP\n\\fB");
        put_string(stream, terms[i].name);
        fprintf(stream, "\\fR\n");
        put_string(stream, terms[i].meaning);
        fprintf(stream, "\n");
    }
}

static const term exit_status[] = {
    {"0", "Done."},
    {"1", "The run failed or is inaccurate, an expectation was not met, or a file could not be "
          "written."},
    {"2", "Bad arguments or a bad scenario."},
    {"130", "Ended by ^C; what was computed is kept."},
};

static const term environment[] = {
    {"IMPACTLAB_SCENARIOS",
     "Folders with further scenarios, separated by colons; of two of one name theirs counts."},
    {"NO_COLOR", "If not empty, the terminal lab shows no colours unless --colours or its settings "
                 "ask for them."},
    {"COLORTERM", "If truecolor or 24bit, the terminal has colours by red, green and blue."},
    {"XDG_CONFIG_HOME",
     "Where the terminal lab keeps its settings, in impactlab/lab; ~/.config if not set."},
};

static const term examples[] = {
    {"impactlab run corrected/first-impact --set motor.voltage=5",
     "How hard does the arm hit at 5 V?"},
    {"impactlab run corrected/first-impact --json - | jq .peak_force_N", "The peak force alone."},
};

#define PUT_TERMS(stream, title, terms)                                                            \
    put_terms(stream, title, terms, (int)(sizeof terms / sizeof terms[0]))

static void write_overview(FILE *stream)
{
    fprintf(stream, ".SH NAME\nimpactlab \\- impact and force control of a flexible robot arm\n"
                    ".SH SYNOPSIS\n\\fBimpactlab\\fR [\\fICOMMAND\\fR [\\fIARGUMENT\\fR]...]\n");

    put_title(stream, "Description");
    put_paragraphs(
        stream,
        "impactlab simulates a robot arm, a hub turned by a motor with a beam of one or more links "
        "on it, that hits a rigid wall and goes on pressing against it. A SCENARIO is a name that "
        "impactlab list prints, or a file. Without a command the arm is explored on the terminal; "
        "where there is none, the scenarios are listed.\n\n"
        "Options may stand before or after the other arguments. Files are written whole or not at "
        "all. impactlab --version prints the version.");

    put_title(stream, "Commands");
    for (int i = 0; i < command_count; i++) {
        const command *c = command_table[i];
        fprintf(stream, ".TP\n\\fBimpactlab\\-%s\\fR(1)\n", c->name);
        put_string(stream, c->summary);
        fprintf(stream, ".\n");
    }

    PUT_TERMS(stream, "Environment", environment);
    PUT_TERMS(stream, "Exit status", exit_status);
    PUT_TERMS(stream, "Examples", examples);
}

static void write_command(FILE *stream, const command *c)
{
    // name and call
    fprintf(stream, ".SH NAME\nimpactlab\\-%s \\- ", c->name);
    put_string(stream, c->summary);
    fprintf(stream, "\n.SH SYNOPSIS\n\\fBimpactlab %s\\fR%s", c->name, c->operands[0] ? " " : "");
    put_string(stream, c->operands);
    fprintf(stream, " [\\fIOPTION\\fR]...\n");

    // what it does
    put_title(stream, "Description");
    put_string(stream, c->summary);
    fprintf(stream, ".\n");
    put_paragraphs(stream, c->help);

    // its options, table by table
    const option_table *t;
    const char *title = "";
    for (int i = 0; (t = command_options(c, i)) != NULL; i++) {
        put_options(stream, t, title);
        title = t->title;
    }
    PUT_TERMS(stream, "Exit status", exit_status);
    fprintf(stream, ".SH SEE ALSO\n\\fBimpactlab\\fR(1)\n");
}

void write_man_page(FILE *stream, const command *c)
{
    assert(stream != NULL);

    // a page of its own for each command, named as man looks it up
    fprintf(stream, ".TH IMPACTLAB");
    if (c != NULL) {
        fprintf(stream, "\\-");
        put_upper(stream, c->name);
    }
    fprintf(stream, " 1 \"\" \"impactlab %s\"\n", lab_version());

    // the sections below the heading
    if (c == NULL) {
        write_overview(stream);
    } else {
        write_command(stream, c);
    }
}

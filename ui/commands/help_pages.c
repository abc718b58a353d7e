#include "ui/commands/help_pages.h"

#include <glib.h>
#include <string.h>

#include "src/base/shipped.h"

// --- on the terminal -------------------------------------------------------------------

enum { LINE_WIDTH = 100 };

// Paragraphs with an empty line between them; literal lines stand close together.
static void print_paragraphs(FILE *stream, const char *text)
{
    paragraph p;
    bool was_literal = false;
    while (next_paragraph(&text, &p)) {
        if (!p.literal || !was_literal) {
            fprintf(stream, "\n");
        }

        if (p.literal) {
            fprintf(stream, "%.*s\n", p.bytes, p.start);
        } else {
            print_indented(stream, p.start, p.bytes, LINE_WIDTH, 0);
        }
        was_literal = p.literal;
    }
}

// Characters that an option's name and the name of its value take, with the blank between
// them.
static int option_width(const option_row *o)
{
    size_t width = strlen(o->name);
    if (o->value != NULL) {
        width += 1 + strlen(o->value);
    }
    return (int)width;
}

// The width of the column of options.
static int widest_option(const command *c)
{
    const option_row *o;
    int widest = 0;
    for (int i = 0; (o = command_option(c, i)) != NULL; i++) {
        if (option_width(o) > widest) {
            widest = option_width(o);
        }
    }
    return widest;
}

// A line of an option, what it does behind a column of that width.
static void print_option(FILE *stream, const option_row *o, int width)
{
    char letter[] = {'-', o->letter, ',', '\0'};
    if (o->letter == 0) {
        letter[0] = '\0';
    }
    fprintf(stream, "  %-3s --%s", letter, o->name);
    if (o->value != NULL) {
        fprintf(stream, " %s", o->value);
    }
    fprintf(stream, "%*s  %s\n", width - option_width(o), "", o->help);
}

void print_help(FILE *stream, const command *c)
{
    fprintf(stream, "impactlab %s%s%s [OPTION]...\n\n%s.\n", c->name,
            blank_before(c->operands), c->operands, c->summary);
    print_paragraphs(stream, c->help);

    // tables with one title stand below it together
    const option_table *t;
    const char *title = "";
    const int width = widest_option(c);
    for (int i = 0; (t = command_options(c, i)) != NULL; i++) {
        if (strcmp(t->title, title) != 0) {
            fprintf(stream, "\n%s:\n", t->title);
        }
        title = t->title;
        for (int k = 0; k < t->count; k++) {
            print_option(stream, &t->rows[k], width);
        }
    }
}

// The commands of a group, a line each.
static void print_group(FILE *stream, const command_list *all, int group,
                        const char *title)
{
    fprintf(stream, "\n%s:\n", title);
    for (int i = 0; i < all->count; i++) {
        const command *c = all->items[i];
        if ((int)c->group == group) {
            fprintf(stream, "  %-9s  %s\n", c->name, c->summary);
        }
    }
}

void print_commands(FILE *stream, const command_list *all)
{
    static const char *const titles[] = {
#define GROUP_TITLE(group, title) title,
        COMMAND_GROUPS(GROUP_TITLE)
#undef GROUP_TITLE
    };

    // how it is called
    fprintf(stream,
            "impactlab %s: impact and force control of a flexible robot arm\n\n"
            "usage: impactlab COMMAND [ARGUMENT]...\n",
            lab_version());

    // what there is
    for (int group = 0; group < COMMAND_GROUP_COUNT; group++) {
        print_group(stream, all, group, titles[group]);
    }

    // where to read on
    fprintf(stream, "\nimpactlab COMMAND --help describes a command, impactlab "
                    "help QUESTION searches\n"
                    "the manual.\n"
                    "Exit status: 0 done; 1 the run failed or is inaccurate, or a file "
                    "could not be written;\n"
                    "2 bad arguments or a bad scenario; 130 ended by ^C.\n");
}

// --- man pages -------------------------------------------------------------------------

char *troff_text(const char *text)
{
    GString *escaped = g_string_new(NULL);
    bool begins_line = true;
    for (const char *c = text; *c != '\0'; c++) {
        // a dot or quote at the start of a line would be a request
        if (begins_line && (*c == '.' || *c == '\'')) {
            g_string_append(escaped, "\\&");
        }

        if (*c == '\\') {
            g_string_append(escaped, "\\e");
        } else if (*c == '-') {
            g_string_append(escaped, "\\-");
        } else {
            g_string_append_c(escaped, *c);
        }
        begins_line = *c == '\n';
    }
    return g_string_free(escaped, FALSE);
}

// The heading of a section, in capital letters.
static void write_section(FILE *stream, const char *title)
{
    g_autofree char *capitals = g_ascii_strup(title, -1);
    fprintf(stream, ".SH %s\n", capitals);
}

// Paragraphs; lines that are printed as they are stand between .nf and .fi.
static void write_paragraphs(FILE *stream, const char *text)
{
    paragraph p;
    bool was_literal = false;
    while (next_paragraph(&text, &p)) {
        if (p.literal && !was_literal) {
            fprintf(stream, ".PP\n.nf\n");
        }
        if (!p.literal && was_literal) {
            fprintf(stream, ".fi\n");
        }
        if (!p.literal) {
            fprintf(stream, ".PP\n");
        }

        // the text between these marks
        g_autofree char *words = g_strndup(p.start, (size_t)p.bytes);
        g_autofree char *escaped = troff_text(words);
        fprintf(stream, "%s\n", escaped);
        was_literal = p.literal;
    }
    if (was_literal) {
        fprintf(stream, ".fi\n");
    }
}

// A list of terms, each with what it means; a row without a name ends it.
typedef struct term {
    const char *name, *meaning;
} term;

static void write_term_list(FILE *stream, const char *title, const term *terms)
{
    write_section(stream, title);
    for (; terms->name != NULL; terms++) {
        g_autofree char *name = troff_text(terms->name);
        g_autofree char *meaning = troff_text(terms->meaning);
        fprintf(stream, ".TP\n\\fB%s\\fR\n%s\n", name, meaning);
    }
}

static const term exit_status[] = {
    {"0", "Done."},
    {"1", "The run failed or is inaccurate, an expectation was not met, or a "
          "file could not be written."},
    {"2", "Bad arguments or a bad scenario."},
    {"3", "identify found a fit, and the data show something that the model lacks."},
    {"130", "Ended by ^C; what was computed is kept, and a second ^C ends at once."},
    {NULL},
};

static const term environment[] = {
    {"IMPACTLAB_SCENARIOS", "Folders with further scenarios, separated by colons; of two "
                            "of one name theirs counts."},
    {"NO_COLOR", "If not empty, the terminal lab shows no colours."},
    {"COLORTERM",
     "If truecolor or 24bit, the terminal has colours by red, green and blue."},
    {"XDG_CONFIG_HOME", "Where the terminal lab keeps its settings, in impactlab/lab; "
                        "~/.config if not set."},
    {"XDG_STATE_HOME",
     "Where the terminal lab keeps what is not saved, in impactlab, until "
     "it is left; ~/.local/state if not set."},
    {NULL},
};

static const term examples[] = {
    {"impactlab run corrected/first-impact --set motor.voltage=5",
     "How hard does the arm hit at 5 V?"},
    {"impactlab run corrected/first-impact --json - | jq .peak_force_N",
     "The peak force alone."},
    {NULL},
};

// The page of impactlab itself.
static void write_program_page(FILE *stream, const command_list *all)
{
    fprintf(stream,
            ".SH NAME\nimpactlab \\- impact and force control of a flexible robot arm\n"
            ".SH SYNOPSIS\n\\fBimpactlab\\fR [\\fICOMMAND\\fR [\\fIARGUMENT\\fR]...]\n"
            ".SH DESCRIPTION\n");
    write_paragraphs(stream,
                     "impactlab simulates a robot arm, a hub turned by a motor with a "
                     "beam of one or more links on it, that hits a rigid wall and goes "
                     "on pressing against it. A SCENARIO is a name that impactlab list "
                     "prints, or a file. Without a command the arm is explored on the "
                     "terminal; where there is none, the scenarios are listed.\n\n"
                     "Options may stand before or after the other arguments. Files are "
                     "written whole or not at all. impactlab --version prints the "
                     "version.");

    // each command in a line
    write_section(stream, "Commands");
    for (int i = 0; i < all->count; i++) {
        const command *c = all->items[i];
        g_autofree char *summary = troff_text(c->summary);
        fprintf(stream, ".TP\n\\fBimpactlab\\-%s\\fR(1)\n%s.\n", c->name, summary);
    }

    write_term_list(stream, "Environment", environment);
    write_term_list(stream, "Exit status", exit_status);
    write_term_list(stream, "Examples", examples);
    fprintf(stream,
            ".SH SEE ALSO\n\\fBimpactlab\\-scenario\\fR(5), \\fBlibimpactlab\\fR(3)\n");
}

// An option as a term of a list.
static void write_option(FILE *stream, const option_row *o)
{
    g_autofree char *name = troff_text(o->name);
    g_autofree char *help = troff_text(o->help);
    fprintf(stream, ".TP\n");
    if (o->letter != 0) {
        fprintf(stream, "\\fB\\-%c\\fR, ", o->letter);
    }
    fprintf(stream, "\\fB\\-\\-%s", name);
    if (o->value != NULL) {
        g_autofree char *value = troff_text(o->value);
        fprintf(stream, " \\fI%s", value);
    }
    fprintf(stream, "\\fR\n%s\n", help);
}

// The page of a command, impactlab-COMMAND(1).
static void write_command_page(FILE *stream, const command *c)
{
    g_autofree char *summary = troff_text(c->summary);
    g_autofree char *operands = troff_text(c->operands);
    fprintf(stream, ".SH NAME\nimpactlab\\-%s \\- %s\n", c->name, summary);
    fprintf(stream, ".SH SYNOPSIS\n\\fBimpactlab %s\\fR%s%s [\\fIOPTION\\fR]...\n",
            c->name, blank_before(operands), operands);
    fprintf(stream, ".SH DESCRIPTION\n%s.\n", summary);
    write_paragraphs(stream, c->help);

    // tables with one title stand below it together
    const option_table *t;
    const char *title = "";
    for (int i = 0; (t = command_options(c, i)) != NULL; i++) {
        if (strcmp(t->title, title) != 0) {
            write_section(stream, t->title);
        }
        title = t->title;
        for (int k = 0; k < t->count; k++) {
            write_option(stream, &t->rows[k]);
        }
    }
    write_term_list(stream, "Exit status", exit_status);
    fprintf(stream, ".SH SEE ALSO\n\\fBimpactlab\\fR(1)\n");
}

void write_man_page(FILE *stream, const command_list *all, const command *c)
{
    // a page of its own for each command, named as man looks it up
    fprintf(stream, ".TH IMPACTLAB");
    if (c != NULL) {
        g_autofree char *capitals = g_ascii_strup(c->name, -1);
        fprintf(stream, "\\-%s", capitals);
    }
    fprintf(stream, " 1 \"\" \"impactlab %s\"\n", lab_version());

    if (c == NULL) {
        write_program_page(stream, all);
    } else {
        write_command_page(stream, c);
    }
}

// Pages from the tables of commands, options, parameters, signals and quantities: man pages, and
// chapters of the manual.
#include "ui/commands/command.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "src/base/shipped.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/trace.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"

// --- man pages --------------------------------------------------------------------------------
// One a command, and one of impactlab.

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
    fputs(".SH SEE ALSO\n\\fBimpactlab\\-scenario\\fR(5), \\fBlibimpactlab\\fR(3)\n", stream);
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

// --- chapters ---------------------------------------------------------------------------------
// In Markdown; and the man page of scenario files.

// Text of a table's cell or a paragraph, in which Markdown finds no marks of its own.
static void put_cell(FILE *stream, const char *text)
{
    for (; *text != '\0'; text++) {
        if (strchr("|*_<\\", *text) != NULL) {
            fputc('\\', stream);
        }
        fputc(*text, stream);
    }
}

// ---- parameters

// "0.1 to 100", "point, plane, none", "true, false", "text".
static void put_range(FILE *stream, const parameter_info *info)
{
    switch (info->type) {
    case PARAMETER_CHOICE:
        for (const char *c = info->choices; *c != '\0'; c++) {
            fputs(*c == '|' ? ", " : (char[]){*c, '\0'}, stream);
        }
        break;
    case PARAMETER_BOOLEAN:
        fputs("true, false", stream);
        break;
    case PARAMETER_TEXT:
        fputs("text", stream);
        break;
    case PARAMETER_LIST:
    case PARAMETER_REAL:
    case PARAMETER_INTEGER:
        fprintf(stream, "%s%g to %g", info->type == PARAMETER_LIST ? "list of " : "", info->minimum,
                info->maximum);
        break;
    }
}

// The default under a model as scenario files would give it, "derived" if other parameters give it.
static void format_default(int index, arm_model_kind model, char *text, size_t size)
{
    const parameter_info *info = &parameter_table[index];
    parameters p;

    parameters_defaults(&p, model);
    if (!parameter_is_text(info) && isnan(parameter_get(&p, index))) {
        snprintf(text, size, "derived");
    } else {
        parameter_format(&p, index, text, size);
    }
}

static void put_default(FILE *stream, int index)
{
    char corrected[PARAMETER_TEXT_SIZE], printed[PARAMETER_TEXT_SIZE];

    format_default(index, ARM_CORRECTED, corrected, sizeof corrected);
    format_default(index, ARM_PRINTED, printed, sizeof printed);
    fputs(corrected, stream);
    if (strcmp(corrected, printed) != 0) {
        fprintf(stream, " (printed: %s)", printed);
    }
}

// Whether a group, "arm" of "arm.k2", begins with this parameter; its length in *length.
static bool group_begins(int index, int *length)
{
    const char *path = parameter_table[index].path;
    *length = (int)(strchr(path, '.') - path);
    return index == 0 || strncmp(path, parameter_table[index - 1].path, (size_t)*length + 1) != 0;
}

static void write_parameters(FILE *stream)
{
    fputs("# Parameters\n\nEvery parameter of a scenario, by its path. A default is \"derived\" if "
          "it "
          "follows from other parameters; *timed* ones may change during a run.\n",
          stream);
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        int length;

        if (group_begins(i, &length)) {
            fprintf(
                stream,
                "\n## %.*s\n\n| path | default | unit | range | meaning |\n|---|---|---|---|---|\n",
                length, info->path);
        }

        fprintf(stream, "| `%s` | ", info->path);
        put_default(stream, i);
        fprintf(stream, " | %s | ", info->unit);
        put_range(stream, info);
        fputs(" | ", stream);
        put_cell(stream, info->description);
        fprintf(stream, "%s |\n", info->timed ? "; *timed*" : "");
    }
}

// ---- signals, quantities, events

static void write_signals(FILE *stream)
{
    fputs(
        "# Signals\n\nWhat a run records at every row: columns of `--csv`, names for `--signals`, "
        "panes and recipes.\n\n| name | symbol | unit | meaning |\n|---|---|---|---|\n",
        stream);
    for (int i = 0; i < signal_count; i++) {
        const signal_info *s = &signal_table[i];
        fprintf(stream, "| `%s` | ", s->name);
        put_cell(stream, s->ascii);
        fprintf(stream, " | %s | ", s->unit);
        put_cell(stream, s->description);
        fprintf(stream, "%s |\n", s->optional ? "; only if recorded" : "");
    }
}

static void write_quantities(FILE *stream)
{
    fputs("# Quantities\n\nThe numbers of a run: keys of `run --json`, `expect`, sweeps and "
          "comparisons. One that did not occur is null.\n\n"
          "| key | unit | meaning |\n|---|---|---|\n",
          stream);
    for (int i = 0; i < summary_count; i++) {
        const summary_info *s = &summary_table[i];
        fprintf(stream, "| `%s` | %s | ", s->key, s->unit);
        put_cell(stream, s->description);
        fprintf(stream, "%s |\n", s->special ? "; only in some runs" : "");
    }
}

static void write_events(FILE *stream)
{
    fputs("# Events\n\nWhat happens between rows, located in time: `events` of `run --json`.\n\n"
          "| kind | what happens |\n|---|---|\n",
          stream);
    for (int i = 0; event_description(i) != NULL; i++) {
        fprintf(stream, "| `%s` | ", event_name((event_kind)i));
        put_cell(stream, event_description(i));
        fputs(" |\n", stream);
    }
}

// ---- control laws

// The parameters of a law: those of the scenario by path, its own with their meaning.
static void put_law_parameters(FILE *stream, const controller *c)
{
    for (int i = 0; i < c->parameter_count; i++) {
        const controller_parameter p = controller_parameter_at(c, i);
        char path[80];

        snprintf(path, sizeof path, "control.%s", c->parameters[i].name);
        if (parameter_find(path) >= 0 && c->parameters[i].description == NULL) {
            fprintf(stream, "- `%s`\n", path);
            continue;
        }

        fprintf(stream, "- in `control.settings`: `%s`, %g %s (%g to %g), ", p.name, p.initial,
                p.unit != NULL ? p.unit : "", p.minimum, p.maximum);
        put_cell(stream, p.description != NULL ? p.description : "");
        fputc('\n', stream);
    }
}

static void write_laws(FILE *stream)
{
    fputs(
        "# Control laws and their parameters\n\nThe choices of `control.law`, what each does, and "
        "the parameters that it reads.\n",
        stream);
    for (int law = LAW_NONE; law < LAW_COUNT; law++) {
        fprintf(stream, "\n## %s\n\n", control_law_table[law].word);
        put_cell(stream, control_law_table[law].description);
        fputs(".\n\n", stream);
        if (controller_of(law) != NULL) {
            put_law_parameters(stream, controller_of(law));
        }
    }
}

// ---- the man page of scenario files

static void put_man_parameter(FILE *stream, int index)
{
    const parameter_info *info = &parameter_table[index];

    fputs(".TP\n\\fB", stream);
    put_string(stream, info->path);
    fprintf(stream, "\\fR%s%s\n", info->unit[0] != '\0' ? " in " : "", info->unit);
    put_string(stream, info->description);
    fputs(".\nDefault: ", stream);
    put_default(stream, index);
    fputs("; range: ", stream);
    put_range(stream, info);
    fprintf(stream, "%s.\n", info->timed ? "; may change during a run" : "");
}

static void write_scenario_man(FILE *stream)
{
    fprintf(
        stream,
        ".TH IMPACTLAB\\-SCENARIO 5 \"\" \"impactlab %s\"\n"
        ".SH NAME\nimpactlab\\-scenario \\- files that describe a run of impactlab\n"
        ".SH SYNOPSIS\n.nf\n"
        "title: A stiffer beam\n"
        "arm: {k2: 49.2 N m/rad}\n"
        "motor: {voltage: 1 V}\n"
        "script:\n"
        "  \\- {at: 0.5 s, set: {motor.voltage: 2 V}}\n"
        "expect:\n"
        "  impacts: {value: 3, tolerance: 2}\n.fi\n"
        ".SH DESCRIPTION\n"
        "A scenario is one YAML file. Every key may be left out. The path arm.k2 below is the key "
        "k2 in the group arm. A value may carry the unit that is given here; nothing is "
        "converted.\n.PP\n"
        "title, description, script, expect, panes and lesson stand beside the groups; the manual "
        "describes them under \\(lqScenario files\\(rq.\n",
        lab_version());
    for (int i = 0; i < parameter_count; i++) {
        int length;
        if (group_begins(i, &length)) {
            fputs(".SH ", stream);
            for (int k = 0; k < length; k++) {
                fputc(toupper((unsigned char)parameter_table[i].path[k]), stream);
            }
            fputc('\n', stream);
        }
        put_man_parameter(stream, i);
    }
    fputs(".SH SEE ALSO\n\\fBimpactlab\\fR(1), \\fBimpactlab\\-check\\fR(1), "
          "\\fBlibimpactlab\\fR(3)\n",
          stream);
}

void write_reference(FILE *stream, const char *page)
{
    static const struct {
        const char *page;
        void (*write)(FILE *stream);
    } pages[] = {
        {"parameters", write_parameters}, {"signals", write_signals},
        {"quantities", write_quantities}, {"laws", write_laws},
        {"events", write_events},         {"scenario.5", write_scenario_man},
    };

    assert(stream != NULL && page != NULL);
    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        if (strcmp(pages[i].page, page) == 0) {
            pages[i].write(stream);
        }
    }
}

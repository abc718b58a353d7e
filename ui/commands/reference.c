// Pages from the tables of commands, options, parameters, signals and quantities: man
// pages, and chapters of the manual.
#include "ui/commands/command.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "src/base/shipped.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/trace.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"

// --- text in pages ---------------------------------------------------------------------

// Text of a man page, in which troff finds no request and no escape of its own, or of a
// table's cell or paragraph in which Markdown finds no marks of its own.
static void put_escaped(FILE *stream, bool man, const char *text, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        // a dot or quote at the start of a line would be a request
        if (man && (i == 0 || text[i - 1] == '\n') && strchr(".'", text[i]) != NULL) {
            fputs("\\&", stream);
        }
        if (strchr(man ? "\\-" : "|*_<\\", text[i]) != NULL) {
            fputc('\\', stream);
        }
        fputc(man && text[i] == '\\' ? 'e' : text[i], stream);
    }
}

// Prints a page's text: %s a text as it is, %u in capital letters, %m for troff, %t for
// Markdown, %g a number.
static void put(FILE *stream, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    for (; *format != '\0'; format++) {
        const char kind = *format == '%' ? *++format : '\0';
        const char *text = kind != '\0' && kind != 'g' ? va_arg(list, const char *) : "";
        if (kind == '\0') {
            fputc(*format, stream);
        } else if (kind == 'g') {
            fprintf(stream, "%g", va_arg(list, double));
        } else if (kind == 's') {
            fputs(text, stream);
        } else if (kind == 'u') {
            for (; *text != '\0'; text++) {
                fputc(toupper((unsigned char)*text), stream);
            }
        } else {
            put_escaped(stream, kind == 'm', text, (int)strlen(text));
        }
    }
    va_end(list);
}

// --- man pages -------------------------------------------------------------------------
// One a command, and one of impactlab.

static void put_paragraphs(FILE *stream, const char *text)
{
    paragraph p;
    bool was_literal = false;

    while (next_paragraph(&text, &p)) {
        if (p.literal && !was_literal) {
            put(stream, ".PP\n.nf\n");
        } else if (!p.literal) {
            put(stream, "%s.PP\n", was_literal ? ".fi\n" : "");
        }
        put_escaped(stream, true, p.start, p.bytes);
        put(stream, "\n");
        was_literal = p.literal;
    }
    put(stream, was_literal ? ".fi\n" : "");
}

// A list of terms, each with what it means; a row without a name ends it.
typedef struct term {
    const char *name, *meaning;
} term;

static void put_terms(FILE *stream, const char *title, const term *terms)
{
    put(stream, ".SH %u\n", title);
    for (; terms->name != NULL; terms++) {
        put(stream, ".TP\n\\fB%m\\fR\n%m\n", terms->name, terms->meaning);
    }
}

static const term exit_status[] = {
    {"0", "Done."},
    {"1", "The run failed or is inaccurate, an expectation was not met, or a "
          "file could not be written."},
    {"2", "Bad arguments or a bad scenario."},
    {"130", "Ended by ^C; what was computed is kept, and a second ^C ends at once."},
    {NULL},
};

static const term environment[] = {
    {"IMPACTLAB_SCENARIOS", "Folders with further scenarios, separated by colons; of two "
                            "of one name theirs counts."},
    {"NO_COLOR", "If not empty, the terminal lab shows no colours unless --colours or "
                 "its settings ask for them."},
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

static void write_overview(FILE *stream, const command_list *all)
{
    put(stream,
        ".SH NAME\nimpactlab \\- impact and force control of a flexible robot arm\n"
        ".SH SYNOPSIS\n\\fBimpactlab\\fR [\\fICOMMAND\\fR [\\fIARGUMENT\\fR]...]\n"
        ".SH DESCRIPTION\n");
    put_paragraphs(stream, "impactlab simulates a robot arm, a hub turned by a motor "
                           "with a beam of one or more links "
                           "on it, that hits a rigid wall and goes on pressing against "
                           "it. A SCENARIO is a name that "
                           "impactlab list prints, or a file. Without a command the arm "
                           "is explored on the terminal; "
                           "where there is none, the scenarios are listed.\n\n"
                           "Options may stand before or after the other arguments. Files "
                           "are written whole or not at "
                           "all. impactlab --version prints the version.");

    put(stream, ".SH COMMANDS\n");
    for (int i = 0; i < all->count; i++) {
        const command *c = all->items[i];
        put(stream, ".TP\n\\fBimpactlab\\-%s\\fR(1)\n%m.\n", c->name, c->summary);
    }

    put_terms(stream, "Environment", environment);
    put_terms(stream, "Exit status", exit_status);
    put_terms(stream, "Examples", examples);
    put(stream,
        ".SH SEE ALSO\n\\fBimpactlab\\-scenario\\fR(5), \\fBlibimpactlab\\fR(3)\n");
}

static void write_command(FILE *stream, const command *c)
{
    put(stream, ".SH NAME\nimpactlab\\-%s \\- %m\n", c->name, c->summary);
    put(stream, ".SH SYNOPSIS\n\\fBimpactlab %s\\fR%s%m [\\fIOPTION\\fR]...\n", c->name,
        c->operands[0] ? " " : "", c->operands);
    put(stream, ".SH DESCRIPTION\n%m.\n", c->summary);
    put_paragraphs(stream, c->help);

    // its options, table by table
    const option_table *t;
    const char *title = "";
    for (int i = 0; (t = command_options(c, i)) != NULL; i++) {
        if (strcmp(t->title, title) != 0) {
            put(stream, ".SH %u\n", t->title);
        }
        title = t->title;
        for (const option_row *o = t->rows; o < t->rows + t->count; o++) {
            const char letter[] = {o->letter, '\0'};
            put(stream, o->letter != 0 ? ".TP\n\\fB\\-%s\\fR, \\fB" : ".TP\n\\fB",
                letter);
            put(stream, o->value != NULL ? "\\-\\-%m \\fI%m" : "\\-\\-%m", o->name,
                o->value);
            put(stream, "\\fR\n%m\n", o->help);
        }
    }
    put_terms(stream, "Exit status", exit_status);
    put(stream, ".SH SEE ALSO\n\\fBimpactlab\\fR(1)\n");
}

void write_man_page(FILE *stream, const command_list *all, const command *c)
{
    // a page of its own for each command, named as man looks it up
    put(stream, c != NULL ? ".TH IMPACTLAB\\-%u" : ".TH IMPACTLAB",
        c != NULL ? c->name : "");
    put(stream, " 1 \"\" \"impactlab %s\"\n", lab_version());
    if (c == NULL) {
        write_overview(stream, all);
    } else {
        write_command(stream, c);
    }
}

// --- chapters --------------------------------------------------------------------------
// In Markdown; and the man page of scenario files.

// What is said of a parameter.
typedef struct parameter_words {
    char range[RANGE_TEXT];
    char initial[2 * PARAMETER_TEXT_SIZE +
                 16]; // its default, also of the printed model if other
} parameter_words;

const char *format_range(const parameter_info *info, const char *separator,
                         char text[RANGE_TEXT])
{
    const char *choices;
    if (info->type == PARAMETER_CHOICE) {
        choices = info->choices;
    } else if (info->type == PARAMETER_BOOLEAN) {
        choices = "true|false";
    } else if (info->type == PARAMETER_TEXT) {
        choices = "text";
    } else {
        choices = NULL;
    }
    if (choices == NULL) {
        snprintf(text, RANGE_TEXT, "%s%g to %g",
                 info->type == PARAMETER_LIST ? "list of " : "", info->minimum,
                 info->maximum);
        return text;
    }
    size_t length = 0;
    for (const char *c = choices; *c != '\0' && length < RANGE_TEXT; c++) {
        length += (size_t)snprintf(text + length, RANGE_TEXT - length, "%s",
                                   *c == '|' ? separator : (char[]){*c, '\0'});
    }
    return text;
}

// The default under a model as scenario files would give it, "derived" if other
// parameters give it.
static void format_default(int index, arm_model_kind model,
                           char text[PARAMETER_TEXT_SIZE])
{
    parameters p;
    parameters_defaults(&p, model);
    if (!parameter_is_text(&parameter_table[index]) && isnan(parameter_get(&p, index))) {
        snprintf(text, PARAMETER_TEXT_SIZE, "derived");
    } else {
        parameter_format(&p, index, text, PARAMETER_TEXT_SIZE);
    }
}

static parameter_words words_of(int index)
{
    char corrected[PARAMETER_TEXT_SIZE], printed[PARAMETER_TEXT_SIZE];
    parameter_words w;
    format_range(&parameter_table[index], ", ", w.range);
    format_default(index, ARM_CORRECTED, corrected);
    format_default(index, ARM_PRINTED, printed);
    snprintf(w.initial, sizeof w.initial,
             strcmp(corrected, printed) != 0 ? "%s (printed: %s)" : "%s", corrected,
             printed);
    return w;
}

// The group "arm" of "arm.k2", if it begins with this parameter; else "".
static const char *group_that_begins(int index, char group[32])
{
    const char *path = parameter_table[index].path;
    const int length = (int)(strchr(path, '.') - path);
    const bool begins = index == 0 || strncmp(path, parameter_table[index - 1].path,
                                              (size_t)length + 1) != 0;
    snprintf(group, 32, "%.*s", begins ? length : 0, path);
    return group;
}

static void write_parameters(FILE *stream)
{
    put(stream, "# Parameters\n\nEvery parameter of a scenario, by its path. A "
                "default is \"derived\" if it follows from other parameters; *timed* "
                "ones may change during a run.\n");
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const parameter_words w = words_of(i);
        char group[32];
        if (group_that_begins(i, group)[0] != '\0') {
            put(stream,
                "\n## %s\n\n| path | default | unit | range | meaning "
                "|\n|---|---|---|---|---|\n",
                group);
        }
        put(stream, "| `%s` | %s | %s | %s | %t%s |\n", info->path, w.initial, info->unit,
            w.range, info->description, info->timed ? "; *timed*" : "");
    }
}

// ---- signals, quantities, events

static void write_signals(FILE *stream)
{
    put(stream, "# Signals\n\nWhat a run records at every row: columns of `--csv`, "
                "names for `--signals`, panes and recipes.\n\n| name | symbol | unit "
                "| meaning |\n|---|---|---|---|\n");
    for (const signal_info *s = signal_table; s < signal_table + signal_count; s++) {
        put(stream, "| `%s` | %t | %s | %t%s |\n", s->name, s->ascii, s->unit,
            s->description, s->optional ? "; only if recorded" : "");
    }
}

static void write_quantities(FILE *stream)
{
    put(stream, "# Quantities\n\nThe numbers of a run: keys of `run --json`, `expect`, "
                "sweeps and "
                "comparisons. One that did not occur is null.\n\n"
                "| key | unit | meaning |\n|---|---|---|\n");
    for (const summary_info *s = summary_table; s < summary_table + summary_count; s++) {
        put(stream, "| `%s` | %s | %t%s |\n", s->key, s->unit, s->description,
            s->special ? "; only in some runs" : "");
    }
}

static void write_events(FILE *stream)
{
    put(stream, "# Events\n\nWhat happens between rows, located in time: `events` of "
                "`run --json`.\n\n| kind | what happens |\n|---|---|\n");
    for (int i = 0; event_description(i) != NULL; i++) {
        put(stream, "| `%s` | %t |\n", event_name((event_kind)i), event_description(i));
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
        const int known = parameter_find(path);
        if (known >= 0 && c->parameters[i].description == NULL) {
            put(stream, "- `%s`, by default %s: %t\n", path, words_of(known).initial,
                parameter_table[known].description);
        } else {
            put(stream, "- in `control.settings`: `%s`, %g %s (%g to %g), %t\n", p.name,
                p.initial, p.unit != NULL ? p.unit : "", p.minimum, p.maximum,
                p.description != NULL ? p.description : "");
        }
    }
}

// What speaks for and against each built-in law; the table of docs/reference/laws.md.
static void put_law_comparison(FILE *stream)
{
    put(stream,
        "\n| law | needs | sensors | memory [B] | fails |\n|---|---|---|---|---|\n");
    for (int law = LAW_NONE; law < LAW_COUNT; law++) {
        const control_law_info *info = &control_law_table[law];
        if (info->needs != NULL) {
            fprintf(stream, "| `%s` | %s | %s | %zu | %s |\n", info->word, info->needs,
                    info->sensors, controller_of(law)->memory_size, info->fails);
        }
    }
}

static void write_laws(FILE *stream)
{
    put(stream, "# Control laws and their parameters\n\nThe choices of "
                "`control.law`, what each does, and the parameters that it reads.\n");
    put_law_comparison(stream);
    for (int law = LAW_NONE; law < LAW_COUNT; law++) {
        put(stream, "\n## %s\n\n%t.\n\n", control_law_table[law].word,
            control_law_table[law].description);
        if (controller_of(law) != NULL) {
            put_law_parameters(stream, controller_of(law));
        }
    }
}

// ---- the man page of scenario files

static void write_scenario_man(FILE *stream)
{
    put(stream,
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
        "A scenario is one YAML file. Every key may be left out. The path arm.k2 below "
        "is the key "
        "k2 in the group arm. A value may carry the unit that is given here; nothing is "
        "converted.\n.PP\n"
        "title, description, script, expect, panes and lesson stand beside the groups; "
        "the manual "
        "describes them under \\(lqScenario files\\(rq.\n",
        lab_version());
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const parameter_words w = words_of(i);
        char group[32];
        if (group_that_begins(i, group)[0] != '\0') {
            put(stream, ".SH %u\n", group);
        }
        put(stream, ".TP\n\\fB%m\\fR%s%s\n%m.\nDefault: %s; range: %s%s.\n", info->path,
            info->unit[0] != '\0' ? " in " : "", info->unit, info->description, w.initial,
            w.range, info->timed ? "; may change during a run" : "");
    }
    put(stream, ".SH SEE ALSO\n\\fBimpactlab\\fR(1), \\fBimpactlab\\-check\\fR(1), "
                "\\fBlibimpactlab\\fR(3)\n");
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

    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        if (strcmp(pages[i].page, page) == 0) {
            pages[i].write(stream);
        }
    }
}

// Chapters of the manual that are the program's own tables: parameters, signals, quantities,
// control laws and events in Markdown; and the man page of scenario files.
#include "ui/commands/command.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "src/base/shipped.h"
#include "src/tables/parameters.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/trace.h"

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

// The same for troff.
static void put_plain(FILE *stream, const char *text)
{
    for (; *text != '\0'; text++) {
        fputs(*text == '\\' ? "\\e" : *text == '-' ? "\\-" : (char[]){*text, '\0'}, stream);
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
    put_plain(stream, info->path);
    fprintf(stream, "\\fR%s%s\n", info->unit[0] != '\0' ? " in " : "", info->unit);
    put_plain(stream, info->description);
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

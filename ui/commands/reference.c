#include "ui/commands/reference.h"

#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/text.h"
#include "src/base/shipped.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/run/trace.h"
#include "src/scenario/scenario.h"
#include "src/tables/signals.h"
#include "src/tables/summary.h"
#include "ui/commands/help_pages.h"
#include "ui/commands/messages.h"

// Text of a cell or paragraph in which Markdown finds no marks of its own; to be freed
// with g_free.
static char *markdown_text(const char *text)
{
    GString *escaped = g_string_new(NULL);
    for (const char *c = text; *c != '\0'; c++) {
        if (strchr("|*_<\\", *c) != NULL) {
            g_string_append_c(escaped, '\\');
        }
        g_string_append_c(escaped, *c);
    }
    return g_string_free(escaped, FALSE);
}

// What is said behind a description where a condition holds, else nothing.
static const char *remark_if(bool holds, const char *remark)
{
    if (holds) {
        return remark;
    }
    return "";
}

// --- what is said of a parameter -------------------------------------------------------

const char *format_range(const parameter_info *info, const char *separator,
                         char text[RANGE_TEXT])
{
    // words are listed, numbers have two ends
    const char *words;
    switch (info->type) {
    case PARAMETER_CHOICE:
        words = info->choices;
        break;
    case PARAMETER_BOOLEAN:
        words = "true|false";
        break;
    case PARAMETER_TEXT:
        words = "text";
        break;
    case PARAMETER_LIST:
        snprintf(text, RANGE_TEXT, "list of %g to %g", info->minimum, info->maximum);
        return text;
    default:
        snprintf(text, RANGE_TEXT, "%g to %g", info->minimum, info->maximum);
        return text;
    }

    g_auto(GStrv) choices = g_strsplit(words, "|", -1);
    g_autofree char *joined = g_strjoinv(separator, choices);
    snprintf(text, RANGE_TEXT, "%s", joined);
    return text;
}

// The default under a model as scenario files would give it, "derived" if other
// parameters give it.
static void format_default(int index, arm_model_kind model,
                           char text[PARAMETER_VALUE_SIZE])
{
    parameters p;
    parameters_defaults(&p, model);
    if (!parameter_is_text(&parameter_table[index]) && isnan(parameter_get(&p, index))) {
        snprintf(text, PARAMETER_VALUE_SIZE, "derived");
    } else {
        parameter_format(&p, index, text, PARAMETER_VALUE_SIZE);
    }
}

// The default, and that of the printed model if it is another; to be freed with g_free.
static char *defaults_text(int index)
{
    char corrected[PARAMETER_VALUE_SIZE], printed[PARAMETER_VALUE_SIZE];
    format_default(index, ARM_CORRECTED, corrected);
    format_default(index, ARM_PRINTED, printed);
    if (strcmp(corrected, printed) == 0) {
        return g_strdup(corrected);
    }
    return text_printf("%s (printed: %s)", corrected, printed);
}

// The group of a parameter, "arm" of "arm.k2"; to be freed with g_free.
static char *group_of_parameter(int index)
{
    const char *path = parameter_table[index].path;
    return g_strndup(path, strcspn(path, "."));
}

// The group that begins with a parameter, NULL if that is not the first of its group; to
// be freed with g_free.
static char *group_that_begins(int index)
{
    char *group = group_of_parameter(index);
    if (index > 0) {
        g_autofree char *before = group_of_parameter(index - 1);
        if (strcmp(group, before) == 0) {
            g_clear_pointer(&group, g_free);
        }
    }
    return group;
}

// --- chapters in Markdown --------------------------------------------------------------

// A table for each group of parameters.
static void write_parameters_chapter(FILE *stream)
{
    fprintf(stream, "# Parameters\n\nEvery parameter of a scenario, by its path. A "
                    "default is \"derived\" if it follows from other parameters; *timed* "
                    "ones may change during a run.\n");
    for (int i = 0; i < parameter_count; i++) {
        // a table for each group
        g_autofree char *group = group_that_begins(i);
        if (group != NULL) {
            fprintf(stream,
                    "\n## %s\n\n| path | default | unit | range | meaning "
                    "|\n|---|---|---|---|---|\n",
                    group);
        }

        const parameter_info *info = &parameter_table[i];
        char range[RANGE_TEXT];
        g_autofree char *defaults = defaults_text(i);
        g_autofree char *description = markdown_text(info->description);
        fprintf(stream, "| `%s` | %s | %s | %s | %s%s |\n", info->path, defaults,
                info->unit, format_range(info, ", ", range), description,
                remark_if(info->timed, "; *timed*"));
    }
}

// The table of signals.
static void write_signals_chapter(FILE *stream)
{
    fprintf(stream, "# Signals\n\nWhat a run records at every row: columns of `--csv`, "
                    "names for `--signals`, panes and recipes.\n\n| name | symbol | unit "
                    "| meaning |\n|---|---|---|---|\n");
    for (int i = 0; i < signal_count; i++) {
        const signal_info *signal = &signal_table[i];
        g_autofree char *symbol = markdown_text(signal->ascii);
        g_autofree char *description = markdown_text(signal->description);
        fprintf(stream, "| `%s` | %s | %s | %s%s |\n", signal->name, symbol, signal->unit,
                description, remark_if(signal->needs != 0, "; only if recorded"));
    }
}

// The table of the numbers of a run.
static void write_quantities_chapter(FILE *stream)
{
    fprintf(stream,
            "# Quantities\n\nThe numbers of a run: keys of `run --json`, `expect`, "
            "sweeps and "
            "comparisons. One that did not occur is null.\n\n"
            "| key | unit | meaning |\n|---|---|---|\n");
    for (int i = 0; i < summary_count; i++) {
        const summary_info *quantity = &summary_table[i];
        g_autofree char *description = markdown_text(quantity->description);
        fprintf(stream, "| `%s` | %s | %s%s |\n", quantity->key, quantity->unit,
                description, remark_if(quantity->special, "; only in some runs"));
    }
}

static void write_events_chapter(FILE *stream)
{
    fprintf(stream, "# Events\n\nWhat happens between rows, located in time: `events` of "
                    "`run --json`.\n\n| kind | what happens |\n|---|---|\n");
    for (int i = 0; event_description(i) != NULL; i++) {
        g_autofree char *description = markdown_text(event_description(i));
        fprintf(stream, "| `%s` | %s |\n", event_name((event_kind)i), description);
    }
}

// A parameter of the scenario that a law reads.
static void write_shared_number(FILE *stream, int index)
{
    g_autofree char *defaults = defaults_text(index);
    g_autofree char *description = markdown_text(parameter_table[index].description);
    fprintf(stream, "- `%s`, by default %s: %s\n", parameter_table[index].path, defaults,
            description);
}

// A number that is a law's own.
static void write_own_number(FILE *stream, const controller_parameter *number)
{
    const char *unit = "";
    if (number->unit != NULL) {
        unit = number->unit;
    }
    g_autofree char *description = g_strdup("");
    if (number->description != NULL) {
        g_free(description);
        description = markdown_text(number->description);
    }
    fprintf(stream, "- in `control.settings`: `%s`, %g %s (%g to %g), %s\n", number->name,
            number->initial, unit, number->minimum, number->maximum, description);
}

// What a law reads: parameters of the scenario and numbers of its own.
static void write_law_numbers(FILE *stream, const controller *law)
{
    for (int i = 0; i < law->parameter_count; i++) {
        const controller_parameter number = controller_parameter_at(law, i);
        g_autofree char *path = text_printf("control.%s", law->parameters[i].name);
        const int shared = parameter_find(path);
        if (shared >= 0 && law->parameters[i].description == NULL) {
            write_shared_number(stream, shared);
        } else {
            write_own_number(stream, &number);
        }
    }
}

// What speaks for and against each built-in law; the table of docs/reference/laws.md.
static void write_law_comparison(FILE *stream)
{
    fprintf(stream,
            "\n| law | needs | sensors | memory [B] | fails |\n|---|---|---|---|---|\n");
    for (int law = LAW_NONE; law < LAW_COUNT; law++) {
        const control_law_info *info = &control_law_table[law];
        if (info->needs != NULL) {
            fprintf(stream, "| `%s` | %s | %s | %zu | %s |\n", info->word, info->needs,
                    info->sensors, controller_of(law)->memory_size, info->fails);
        }
    }
}

// The laws side by side, then a section for each.
static void write_laws_chapter(FILE *stream)
{
    fprintf(stream, "# Control laws and their parameters\n\nThe choices of "
                    "`control.law`, what each does, and the parameters that it reads.\n");
    write_law_comparison(stream);
    for (int i = LAW_NONE; i < LAW_COUNT; i++) {
        g_autofree char *description = markdown_text(control_law_table[i].description);
        fprintf(stream, "\n## %s\n\n%s.\n\n", control_law_table[i].word, description);

        const controller *law = controller_of(i);
        if (law != NULL) {
            write_law_numbers(stream, law);
        }
    }
}

// What a scenario shows, and how it is run; of one with faults, these on stderr.
static void write_scenario_section(FILE *stream, const char *name)
{
    scenario s;
    if (scenario_open(&s, name, complain_sentence, NULL) != STATUS_OK) {
        return;
    }
    char titled[SCENARIO_TITLED];
    g_autofree char *title = markdown_text(scenario_titled(&s, titled));
    g_autofree char *description = markdown_text(s.description);
    fprintf(stream, "\n### %s\n\n**%s.** %s\n\n`impactlab run %s`\n", name, title,
            description, name);
    scenario_finish(&s);
}

// A section for each scenario, below its folder.
static void write_scenarios_chapter(FILE *stream)
{
    char **names;
    int count;
    fault f = {0};
    if (scenario_list(&names, &count, &f) != STATUS_OK) {
        complain_fault(&f);
        return;
    }

    fprintf(stream, "# Gallery of scenarios\n\nEvery scenario that ships, with what it "
                    "shows and its command.\n");
    const char *before = "";
    for (int i = 0; i < count; i++) {
        const int length = (int)strcspn(names[i], "/");
        if (strncmp(names[i], before, (size_t)length + 1) != 0) {
            fprintf(stream, "\n## %.*s\n", length, names[i]);
        }
        write_scenario_section(stream, names[i]);
        before = names[i];
    }

    for (int i = 0; i < count; i++) {
        free(names[i]);
    }
    free(names);
}

// --- the man page of scenario files ----------------------------------------------------

// A parameter with its unit, meaning, default and range.
static void write_man_parameter(FILE *stream, int index)
{
    const parameter_info *info = &parameter_table[index];
    char range[RANGE_TEXT];
    g_autofree char *path = troff_text(info->path);
    g_autofree char *description = troff_text(info->description);
    g_autofree char *defaults = defaults_text(index);

    // its name with its unit, what it does, and its values
    fprintf(stream, ".TP\n\\fB%s\\fR", path);
    if (info->unit[0] != '\0') {
        fprintf(stream, " in %s", info->unit);
    }
    fprintf(stream, "\n%s.\nDefault: %s; range: %s%s.\n", description, defaults,
            format_range(info, ", ", range),
            remark_if(info->timed, "; may change during a run"));
}

// The page impactlab-scenario(5).
static void write_scenario_page(FILE *stream)
{
    fprintf(stream,
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
            "A scenario is one YAML file. Every key may be left out. The path arm.k2 "
            "below is the key k2 in the group arm. A value may carry the unit that is "
            "given here; nothing is converted.\n.PP\n"
            "title, description, script, expect, panes and lesson stand beside the "
            "groups; the manual describes them under \\(lqScenario files\\(rq.\n",
            lab_version());

    // a section for each group
    for (int i = 0; i < parameter_count; i++) {
        g_autofree char *group = group_that_begins(i);
        if (group != NULL) {
            g_autofree char *capitals = g_ascii_strup(group, -1);
            fprintf(stream, ".SH %s\n", capitals);
        }
        write_man_parameter(stream, i);
    }
    fprintf(stream, ".SH SEE ALSO\n\\fBimpactlab\\fR(1), \\fBimpactlab\\-check\\fR(1), "
                    "\\fBlibimpactlab\\fR(3)\n");
}

void write_reference(FILE *stream, const char *page)
{
    static const struct {
        const char *page;
        void (*write)(FILE *stream);
    } pages[] = {
        {"parameters", write_parameters_chapter}, {"signals", write_signals_chapter},
        {"quantities", write_quantities_chapter}, {"laws", write_laws_chapter},
        {"events", write_events_chapter},         {"scenarios", write_scenarios_chapter},
        {"scenario.5", write_scenario_page},
    };

    for (size_t i = 0; i < sizeof pages / sizeof pages[0]; i++) {
        if (strcmp(pages[i].page, page) == 0) {
            pages[i].write(stream);
        }
    }
}

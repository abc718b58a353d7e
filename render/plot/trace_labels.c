// What is written on figures of recorded runs: symbols, labels and captions.
#include "render/plot/trace_plot.h"

#include <string.h>

#include "render/page/text.h"
#include "src/base/shipped.h"
#include "src/rig/rig.h"

// The symbol of a signal as markup. The quantity is set italic, an index or a word
// upright. The index of the last link is the number of its body, links + 1: 3 for two
// links.
char *trace_symbol(const scenario *s, int index)
{
    const signal_info *signal = &signal_table[index];
    const char *symbol = signal->symbol, *body = strstr(symbol, "<sub>");
    size_t letters = strlen(symbol);
    if (body != NULL) {
        letters = (size_t)(body - symbol);
    }

    // a symbol of more than two letters is a word
    if (body == NULL && g_utf8_strlen(symbol, -1) > 2) {
        return g_strdup(symbol);
    }
    if (signal->body == BODY_LAST_LINK) {
        return text_printf("<i>%.*s</i><sub>%d</sub>", (int)letters, symbol,
                           s->parameters.arm.links + 1);
    }
    return text_printf("<i>%.*s</i>%s", (int)letters, symbol, symbol + letters);
}

bool trace_hub_is_first_link(const scenario *s)
{
    return s->parameters.arm.model == ARM_CORRECTED &&
           s->parameters.arm.hub_joint == HUB_RIGID;
}

// The first link's signal of the quantity that a signal of the hub shows; -1 if there is
// none, or if the signal is not of the hub.
static int first_link_twin(int index)
{
    const signal_info *hub = &signal_table[index];
    for (int i = 0; i < signal_count && hub->body == BODY_HUB; i++) {
        if (signal_table[i].body == BODY_FIRST_LINK &&
            strcmp(signal_table[i].quantity, hub->quantity) == 0) {
            return i;
        }
    }
    return -1;
}

// The symbol of a series; "θ1 = θ2" where the hub is part of the first link.
char *trace_series_symbol(const scenario *s, int index)
{
    const int twin = first_link_twin(index);
    g_autofree char *symbol = trace_symbol(s, index);
    if (twin < 0 || !trace_hub_is_first_link(s)) {
        return g_steal_pointer(&symbol);
    }
    g_autofree char *other = trace_symbol(s, twin);
    return text_printf("%s = %s", symbol, other);
}

// The label of a series: its symbol, and the name of its body or its description.
// `joined`: a signal of the hub stands for the first link, too, if the hub is part of it.
char *trace_series_label(const scenario *s, int index, bool joined)
{
    const signal_info *signal = &signal_table[index];
    if (joined && trace_hub_is_first_link(s) && first_link_twin(index) >= 0) {
        g_autofree char *both = trace_series_symbol(s, index);
        return text_printf("%s  hub and first link", both);
    }

    // a signal of no body has its description
    const char *words = signal->description;
    if (signal->body != BODY_NONE) {
        words = signal_body_name(signal->body);
    }
    g_autofree char *symbol = trace_symbol(s, index);
    return text_printf("%s  %s", symbol, words);
}

// ---- axes

figure_axis trace_signal_axis(const trace_figure *t, const trace_panel *from)
{
    const int index = signal_index(from->signals[0]);
    const signal_info *first = &signal_table[index];
    const char *symbol =
        owned_figure_keep(t->drawn, trace_symbol(t->runs[0].scenario, index));
    figure_axis y = {first->name, from->label, first->unit, .with_zero = from->with_zero};
    if (y.label == NULL) {
        y.label = owned_figure_printf(t->drawn, "%s %s", first->quantity, symbol);
    }
    if (from->signals[1] == NULL) {
        y.symbol = symbol;
    }
    return y;
}

// A duration in µs, ms or s, whichever makes the number short.
static char *duration_text(double seconds)
{
    if (seconds < 1e-3) {
        return text_printf("%g\u2009\u00b5s", seconds * 1e6);
    }
    if (seconds < 1) {
        return text_printf("%g\u2009ms", seconds * 1e3);
    }
    return text_printf("%g\u2009s", seconds);
}

// The name of a mode of the scenario's law; NULL if the law has no such mode.
const char *trace_mode_name(const scenario *s, int mode)
{
    const controller *law = controller_of(s->parameters.control.law);
    for (int i = 0; law != NULL && law->modes[i] != NULL; i++) {
        if (i == mode) {
            return law->modes[i];
        }
    }
    return NULL;
}

// ---- captions

// A part of what a run is, for a caption. Parts follow each other in a sentence, so that
// each begins with what separates it from those before it.
typedef void (*run_part)(GString *out, const trace_run *run);

static void add_model(GString *out, const trace_run *run)
{
    const bool printed = run->scenario->parameters.arm.model == ARM_PRINTED;
    text_append(out, "%s model", printed ? "printed" : "corrected");
}

static void add_links(GString *out, const trace_run *run)
{
    const int links = run->scenario->parameters.arm.links;
    text_append(out, ", %d %s", links, links == 1 ? "link" : "links");
}

static void add_hub(GString *out, const trace_run *run)
{
    static const char *const hub_texts[] = {
        [HUB_RIGID] = "rigid", [HUB_SPRING] = "spring", [HUB_BEAM] = "beam's"};
    text_append(out, ", %s hub", hub_texts[run->scenario->parameters.arm.hub_joint]);
}

// Of the printed model the constants that may differ from the thesis's or the beam's.
static void add_printed_constants(GString *out, const trace_run *run)
{
    const arm_parameters *arm = &run->scenario->parameters.arm;
    if (arm->model == ARM_PRINTED) {
        g_autofree char *inertia = text_number(arm->link_inertia, 3);
        text_append(
            out, ", <i>k</i><sub>1</sub> = %.6g\u2009N·m/rad, <i>I</i> = %s\u2009kg·m²",
            arm->k1, inertia);
    }
}

// What drives the arm: a voltage, or a rig.
static void add_drive(GString *out, const trace_run *run)
{
    const parameters *p = &run->scenario->parameters;
    if (p->control.law == LAW_NONE) {
        text_append(out, ", %g\u2009V", p->motor.voltage);
    } else {
        text_append(out, ", on the rig");
    }
}

static void add_law(GString *out, const trace_run *run)
{
    const control_parameters *control = &run->scenario->parameters.control;
    if (control->law != LAW_NONE) {
        text_append(out, ": %s", control_law_table[control->law].word);
    }
}

static void add_rate(GString *out, const trace_run *run)
{
    const control_parameters *control = &run->scenario->parameters.control;
    if (control->law != LAW_NONE) {
        text_append(out, " at %g\u2009Hz", control->rate);
    }
}

static void add_command(GString *out, const trace_run *run)
{
    const control_parameters *control = &run->scenario->parameters.control;
    if (control->law == LAW_OPEN_LOOP) {
        text_append(out, ", %g\u2009V", control->approach_voltage);
    } else if (control->law != LAW_NONE) {
        text_append(out, ", %g\u2009N commanded", control->force);
    }
}

static void add_method(GString *out, const trace_run *run)
{
    const parameters *p = &run->scenario->parameters;
    const bool printed = p->arm.model == ARM_PRINTED;
    if (printed || p->method.name == METHOD_NEWMARK) {
        text_append(out, "; Newmark, <i>β</i> = %g, <i>γ</i> = %g", p->method.beta,
                    p->method.gamma);
    } else if (p->method.name == METHOD_GENERALIZED_ALPHA) {
        text_append(out, "; generalised α, <i>ρ</i><sub>∞</sub> = %g",
                    p->method.spectral_radius);
    } else {
        text_append(out, "; %s engine, located events", run->result->summary.method);
    }
}

// The step of the method; for the event method it is only the spacing of rows.
static void add_step(GString *out, const trace_run *run)
{
    const parameters *p = &run->scenario->parameters;
    g_autofree char *step = duration_text(p->method.step);
    if (p->arm.model != ARM_PRINTED && p->method.name == METHOD_EVENT) {
        text_append(out, ", a row every %s", step);
    } else {
        text_append(out, ", <i>h</i> = %s", step);
    }
}

static const run_part run_parts[] = {add_model,  add_links,
                                     add_hub,    add_printed_constants,
                                     add_drive,  add_law,
                                     add_rate,   add_command,
                                     add_method, add_step};

// A part where all runs have it in the same words, else an empty text.
static char *shared_part(run_part add, const trace_run *runs, int run_count)
{
    GString *first = g_string_new(NULL);
    add(first, &runs[0]);
    for (int i = 1; i < run_count && first->len > 0; i++) {
        GString *other = g_string_new(NULL);
        add(other, &runs[i]);
        if (!g_string_equal(first, other)) {
            g_string_truncate(first, 0);
        }
        g_string_free(other, TRUE);
    }
    return g_string_free(first, FALSE);
}

char *trace_shared(const trace_run *runs, int run_count)
{
    GString *out = g_string_new(NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(run_parts); i++) {
        g_autofree char *part = shared_part(run_parts[i], runs, run_count);
        const char *said = part;
        if (out->len == 0) {
            said += strspn(said, ",;: ");
        }
        g_string_append(out, said);
    }
    return g_string_free(out, FALSE);
}

void trace_add_ending(GString *out, const trace_run *runs, int run_count)
{
    text_append(out, " impactlab %s.", lab_version());
    for (int i = 0; i < run_count; i++) {
        const summary *m = &runs[i].result->summary;
        if (m->status == STATUS_OK) {
            continue;
        }
        g_autofree char *why = text_escape(m->message);
        g_autofree char *name = text_escape(text_or(runs[i].name, ""));
        if (run_count == 1) {
            text_append(out, " <b>The run failed:</b> %s", why);
        } else {
            text_append(out, " <b>%s failed:</b> %s", name, why);
        }
    }
}

// Adds the meaning of the shading to a caption and, if there are several runs, to which
// of them it belongs. Measured points are not counted, since they have no contact.
static void add_shading(GString *out, const trace_run *runs, int run_count,
                        const char *shaded)
{
    int simulated = 0;
    for (int i = 0; i < run_count; i++) {
        if (!runs[i].points) {
            simulated++;
        }
    }
    if (simulated < 2 || runs[0].name == NULL) {
        text_append(out, "Shaded: %s.", shaded);
        return;
    }

    // it belongs to the first of several runs
    g_autofree char *name = text_escape(runs[0].name);
    text_append(out, "Shaded: %s of the first run (%s), whose marks are shown.", shaded,
                name);
}

// From the arm to what went wrong.
char *trace_caption(const trace_run *runs, int run_count, const char *shaded)
{
    g_autofree char *shared = trace_shared(runs, 1);
    GString *out = g_string_new(shared);
    out->str[0] = g_ascii_toupper(out->str[0]);
    g_string_append(out, ". ");
    add_shading(out, runs, run_count, shaded);
    trace_add_ending(out, runs, 1);
    return g_string_free(out, FALSE);
}

// ---- of the scenario

// The title and the changes, in which lines may break only between changes.
char *scenario_title(const scenario *s)
{
    char changes[SCENARIO_CHANGES];
    GString *out = g_string_new(s->title);

    // lines break between changes, not within one
    for (const char *c = scenario_changes(s, changes); *c != '\0'; c++) {
        if (*c == ' ' && c[-1] != ',') {
            g_string_append(out, "\u00a0");
        } else {
            g_string_append_c(out, *c);
        }
    }
    return g_string_free(out, FALSE);
}

// "scenario=NAME arm.k2=4.92 ..."
char *parameters_line(const scenario *s)
{
    GString *out = g_string_new(NULL);
    text_append(out, "scenario=%s", s->name);
    for (int i = 0; i < parameter_count; i++) {
        char value[128];
        parameter_format(&s->parameters, i, value, sizeof value);
        text_append(out, " %s=%s", parameter_table[i].path, value);
    }
    return g_string_free(out, FALSE);
}

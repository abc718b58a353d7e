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

// Adds what drives the arm to a caption: a voltage, or a controller.
static void add_drive(GString *out, const parameters *p)
{
    if (p->control.law == LAW_NONE) {
        text_append(out, ", %g\u2009V; ", p->motor.voltage);
        return;
    }

    // the law with its rate and its command
    const char *law = control_law_table[p->control.law].word;
    text_append(out, ", on the rig: %s at %g\u2009Hz", law, p->control.rate);
    if (p->control.law == LAW_OPEN_LOOP) {
        text_append(out, ", %g\u2009V; ", p->control.approach_voltage);
    } else {
        text_append(out, ", %g\u2009N commanded; ", p->control.force);
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

// Adds the model and its arm to a caption; for the printed model also the constants that
// may differ from the thesis's or the beam's.
static void add_arm(GString *out, const parameters *p)
{
    static const char *const hub_texts[] = {
        [HUB_RIGID] = "rigid", [HUB_SPRING] = "spring", [HUB_BEAM] = "beam's"};
    const bool printed = p->arm.model == ARM_PRINTED;
    const char *model = printed ? "Printed" : "Corrected";
    const char *links = p->arm.links == 1 ? "link" : "links";
    text_append(out, "%s model, %d %s, %s hub", model, p->arm.links, links,
                hub_texts[p->arm.hub_joint]);
    if (printed) {
        g_autofree char *inertia = text_number(p->arm.link_inertia, 3);
        text_append(
            out, ", <i>k</i><sub>1</sub> = %.6g\u2009N·m/rad, <i>I</i> = %s\u2009kg·m²",
            p->arm.k1, inertia);
    }
}

// Adds the method of a run and its step to a caption.
static void add_method(GString *out, const trace_run *run)
{
    const parameters *p = &run->scenario->parameters;
    const bool printed = p->arm.model == ARM_PRINTED;
    if (printed || p->method.name == METHOD_NEWMARK) {
        text_append(out, "Newmark, <i>β</i> = %g, <i>γ</i> = %g", p->method.beta,
                    p->method.gamma);
    } else if (p->method.name == METHOD_GENERALIZED_ALPHA) {
        text_append(out, "generalised α, <i>ρ</i><sub>∞</sub> = %g",
                    p->method.spectral_radius);
    } else {
        text_append(out, "%s engine, located events", run->result->summary.method);
    }

    // for the event method the step is only the spacing of rows
    g_autofree char *step = duration_text(p->method.step);
    if (!printed && p->method.name == METHOD_EVENT) {
        text_append(out, ", a row every %s. ", step);
    } else {
        text_append(out, ", <i>h</i> = %s. ", step);
    }
}

// From the arm to what went wrong, in the order of these calls.
char *trace_caption(const trace_run *runs, int run_count, const char *shaded)
{
    const trace_run *run = &runs[0];
    GString *out = g_string_new(NULL);
    add_arm(out, &run->scenario->parameters);
    add_drive(out, &run->scenario->parameters);
    add_method(out, run);
    add_shading(out, runs, run_count, shaded);
    text_append(out, " impactlab %s.", lab_version());

    // what went wrong
    if (run->result->summary.status != STATUS_OK) {
        g_autofree char *why = text_escape(run->result->summary.message);
        text_append(out, " <b>The run failed:</b> %s", why);
    }
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

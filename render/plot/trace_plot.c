#include "render/plot/trace_plot.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/curve.h"
#include "render/page/text.h"
#include "render/plot/figure_file.h"
#include "render/plot/opened_run.h"
#include "src/base/version.h"
#include "src/rig/rig.h"

#define SHORT_PULSE 0.1  // share of the run below which the first pulse is shown enlarged
#define INSET_SPACE 0.15 // of the pulse, shown before and after it

enum { ACTIONS_MARKED = 16, MARKS = 3 + ACTIONS_MARKED };

// A block, mostly a text, that lives as long as the figure.
static void *keep(GPtrArray *owned, void *block)
{
    g_ptr_array_add(owned, block);
    return block;
}

// ---- labels

// A quantity's symbol is set italic, its index upright, and so is a word. The index of the last
// link is that of the body: 3 of two links, 21 of twenty.
static char *symbol_markup(const scenario *s, const signal_info *signal)
{
    const char *symbol = signal->symbol, *index = strstr(symbol, "<sub>");
    size_t letters = index ? (size_t)(index - symbol) : strlen(symbol);
    if (index == NULL && g_utf8_strlen(symbol, -1) > 2) {
        return g_strdup(symbol);
    }
    if (signal->body == BODY_LAST_LINK) {
        return g_strdup_printf("<i>%.*s</i><sub>%d</sub>", (int)letters, symbol,
                               s->parameters.arm.links + 1);
    }
    return g_strdup_printf("<i>%.*s</i>%s", (int)letters, symbol, symbol + letters);
}

// A hub that is rigidly joined to the first link moves with it.
static bool hub_is_first_link(const scenario *s)
{
    return s->parameters.arm.model == ARM_CORRECTED && s->parameters.arm.hub_joint == HUB_RIGID;
}

// The first link's signal of the same quantity as the hub's, or -1.
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

static char *series_label(const scenario *s, int index, bool joined)
{
    const signal_info *signal = &signal_table[index];
    int twin = joined && hub_is_first_link(s) ? first_link_twin(index) : -1;
    char *symbol = symbol_markup(s, signal), *label;
    if (twin >= 0) {
        char *other = symbol_markup(s, &signal_table[twin]);
        label = g_strdup_printf("%s = %s  hub and first link", symbol, other);
        g_free(other);
    } else {
        // what belongs to no body is described as a whole
        label = g_strdup_printf("%s  %s", symbol,
                                signal->body != BODY_NONE ? signal_body_name(signal->body)
                                                          : signal->description);
    }
    g_free(symbol);
    return label;
}

// The same without words.
static char *series_symbol(const scenario *s, int index)
{
    int twin = hub_is_first_link(s) ? first_link_twin(index) : -1;
    char *symbol = symbol_markup(s, &signal_table[index]);
    if (twin >= 0) {
        char *other = symbol_markup(s, &signal_table[twin]), *own = symbol;
        symbol = g_strdup_printf("%s = %s", own, other);
        g_free(other);
        g_free(own);
    }
    return symbol;
}

// "Contact force f"; the body goes, since the symbol names it.
static char *own_label(const scenario *s, const signal_info *signal)
{
    char *symbol = symbol_markup(s, signal);
    char *label = g_strdup_printf("%s %s", signal->quantity, symbol);
    g_free(symbol);
    return label;
}

static char *duration_text(double seconds)
{
    bool milli = seconds < 1 && seconds >= 1e-3, micro = seconds < 1e-3;
    return text_printf("%g\u2009%s",
                       seconds * (milli   ? 1e3
                                  : micro ? 1e6
                                          : 1),
                       milli   ? "ms"
                       : micro ? "\u00b5s"
                               : "s");
}

static bool on_the_rig(const scenario *s)
{
    return s->parameters.control.law != LAW_NONE;
}

// Name of a mode of the scenario's controller, NULL if it is not known.
static const char *mode_name(const scenario *s, int mode)
{
    const controller *law = controller_of(s->parameters.control.law);
    for (int i = 0; law != NULL && law->modes[i] != NULL; i++) {
        if (i == mode) {
            return law->modes[i];
        }
    }
    return NULL;
}

// What drives the arm: a voltage, or a controller.
static void add_drive(GString *out, const parameters *p)
{
    if (p->control.law == LAW_NONE) {
        text_append(out, ", %g\u2009V; ", p->motor.voltage);
        return;
    }
    const char *law = control_law_table[p->control.law].word;
    text_append(out, ", on the rig: %s at %g\u2009Hz", law, p->control.rate);
    if (p->control.law == LAW_OPEN_LOOP) {
        text_append(out, ", %g\u2009V; ", p->control.approach_voltage);
    } else {
        text_append(out, ", %g\u2009N commanded; ", p->control.force);
    }
}

// Model, links, drive and method in one line.
static char *caption_of(const trace_run *run, const char *shaded)
{
    static const char *const hub_texts[] = {
        [HUB_RIGID] = "rigid", [HUB_SPRING] = "spring", [HUB_BEAM] = "beam's"};
    const parameters *p = &run->scenario->parameters;
    GString *out = g_string_new(p->arm.model == ARM_PRINTED ? "Printed model" : "Corrected model");
    char *step = duration_text(p->method.step);
    g_string_append_printf(out, ", %d link%s, %s hub", p->arm.links, p->arm.links == 1 ? "" : "s",
                           hub_texts[p->arm.hub_joint]);
    add_drive(out, p);
    if (p->arm.model == ARM_PRINTED || p->method.name == METHOD_NEWMARK) {
        text_append(out, "Newmark, <i>β</i> = %g, <i>γ</i> = %g", p->method.beta, p->method.gamma);
    } else if (p->method.name == METHOD_GENERALIZED_ALPHA) {
        text_append(out, "generalised α, <i>ρ</i><sub>∞</sub> = %g", p->method.spectral_radius);
    } else {
        g_string_append(out, "explicit steps, located events");
    }
    g_string_append_printf(out, ", <i>h</i> = %s. Shaded: %s. impactlab %s.", step, shaded,
                           lab_version());
    if (run->result->summary.status != STATUS_OK) {
        char *why = text_escape(run->result->summary.message);
        g_string_append_printf(out, " <b>The run failed:</b> %s", why);
        g_free(why);
    }
    g_free(step);
    return g_string_free(out, FALSE);
}

// ---- what happened

static void add_mark(trace_figure *t, double time, char *label)
{
    t->marks[t->figure.mark_count++] = (figure_mark){time, label};
}

// What the script did at an event, "voltage 2 V"; NULL if the event is no action.
static char *action_label(const scenario *s, const event *e)
{
    if (e->kind == EVENT_PUSH) {
        return text_printf("push %.3g\u2009N·s", e->impulse);
    }
    if (e->kind != EVENT_CHANGE || e->index < 0 || e->index >= s->action_count) {
        return NULL;
    }
    const action *a = &s->actions[e->index];
    const parameter_info *info = &parameter_table[a->parameter];
    char value[128], unit[64];
    action_format_value(a, value, sizeof value);
    text_unit(info->unit, unit, sizeof unit);
    const char *dot = strchr(info->path, '.'), *name = dot ? dot + 1 : info->path;
    return g_strdup_printf("%s %s\u2009%s", name, value, unit);
}

static char *mode_label(const char *name, double mode)
{
    char *escaped = name != NULL ? text_escape(name) : text_printf("%g", mode);
    char *label = g_strdup_printf(name != NULL ? "%s mode" : "mode %s", escaped);
    g_free(escaped);
    return label;
}

// Where the controller went into another mode, with the mode's name. False if it never did.
static bool mark_modes(trace_figure *t, const trace_run *run, GPtrArray *texts)
{
    const trace *rows = &run->result->trace;
    bool marked = false;
    double mode = (double)NAN;
    for (size_t i = 0; i < rows->row_count; i++) {
        double now = rows->rows[i].controller_mode;
        if (isfinite(now) && isfinite(mode) && now != mode && t->figure.mark_count < MARKS) {
            const char *name = mode_name(run->scenario, (int)now);
            add_mark(t, rows->rows[i].time, keep(texts, mode_label(name, now)));
            marked = true;
        }
        mode = isfinite(now) ? now : mode;
    }
    return marked;
}

static char *peak_label(double force)
{
    char *quantity = text_quantity(force, 3, "N"), *label = g_strconcat("peak ", quantity, NULL);
    g_free(quantity);
    return label;
}

static void mark_events(trace_figure *t, const trace_run *run, GPtrArray *texts)
{
    const summary *m = &run->result->summary;
    if (on_the_rig(run->scenario) && mark_modes(t, run, texts)) {
        return;
    }
    const trace *rows = &run->result->trace;
    if (isfinite(m->first_contact_s)) {
        add_mark(t, m->first_contact_s, "contact");
    }
    if (isfinite(m->first_pulse_time_to_peak_s)) {
        add_mark(t, m->first_contact_s + m->first_pulse_time_to_peak_s,
                 keep(texts, peak_label(m->first_pulse_peak_N)));
    }
    if (isfinite(m->first_pulse_s)) {
        add_mark(t, m->first_contact_s + m->first_pulse_s, "release");
    }
    for (size_t i = 0; i < rows->event_count && t->figure.mark_count < MARKS; i++) {
        char *label = action_label(run->scenario, &rows->events[i]);
        if (label != NULL) {
            add_mark(t, rows->events[i].time, keep(texts, label));
        }
    }
}

static bool in_contact(const sample *row)
{
    return row->contact > 0.5;
}

static bool in_second_mode(const sample *row)
{
    return row->controller_mode == 1;
}

// From each first row that is so to the next one that is not. Counts them where `out` is NULL.
static int intervals_of(const trace *rows, bool (*is_so)(const sample *row), figure_interval *out)
{
    int count = 0;
    bool touching = false;
    for (size_t i = 0; i < rows->row_count; i++) {
        bool now = is_so(&rows->rows[i]);
        if (now && !touching) {
            if (out != NULL) {
                out[count] = (figure_interval){rows->rows[i].time, rows->rows[i].time};
            }
            count++;
        }
        if ((now || touching) && out != NULL) {
            out[count - 1].to = rows->rows[i].time;
        }
        touching = now;
    }
    return count;
}

static int impact_impulses(const trace *rows, figure_impulse *out)
{
    int count = 0;
    for (size_t i = 0; i < rows->event_count; i++) {
        if (rows->events[i].kind == EVENT_IMPACT) {
            if (out != NULL) {
                out[count] = (figure_impulse){rows->events[i].time, rows->events[i].impulse};
            }
            count++;
        }
    }
    return count;
}

// ---- panels

static figure_series series_of(const trace_run *run, int index)
{
    assert(index >= 0 && index < signal_count);
    const trace *rows = &run->result->trace;
    const signal_info *signal = &signal_table[index];
    const char *base = (const char *)rows->rows;
    figure_series s = {.name = signal->name,
                       .count = rows->row_count,
                       .stride = sizeof(sample),
                       .colour = signal->colour,
                       .style = signal->style};
    if (base != NULL) {
        s.x = (const double *)(base + offsetof(sample, time));
        s.y = (const double *)(base + signal->offset);
    }
    return s;
}

// A point that lies between two rows.
typedef struct located_point {
    double x, y;
} located_point;

// Where the force is largest in the first pulse and in the whole run, in the order of time. Returns
// their number.
static int located_peaks(const summary *m, located_point peaks[2])
{
    int count = 0;
    const located_point first = {m->first_contact_s + m->first_pulse_time_to_peak_s,
                                 m->first_pulse_peak_N};
    const located_point whole = {m->first_contact_s + m->time_to_peak_s, m->peak_force_N};
    if (isfinite(first.x) && isfinite(first.y)) {
        peaks[count++] = first;
    }
    if (isfinite(whole.x) && isfinite(whole.y) && (count == 0 || whole.x > first.x)) {
        peaks[count++] = whole;
    }
    return count;
}

// The force with its peaks among the rows, so that no mark stands above the curve.
static void add_peaks(figure_series *s, const summary *m, GPtrArray *owned)
{
    located_point peaks[2];
    int count = located_peaks(m, peaks), next = 0;
    double *x = keep(owned, g_new(double, s->count + 2));
    double *y = keep(owned, g_new(double, s->count + 2));
    size_t out = 0;
    for (size_t i = 0; i < s->count; i++) {
        while (next < count && i > 0 && peaks[next].x < series_x(s, i)) {
            if (peaks[next].x > series_x(s, i - 1)) {
                x[out] = peaks[next].x;
                y[out++] = peaks[next].y;
            }
            next++;
        }
        x[out] = series_x(s, i);
        y[out++] = series_y(s, i);
    }
    s->x = x;
    s->y = y;
    s->count = out;
    s->stride = 0;
}

char *trace_symbol(const scenario *s, int index)
{
    return symbol_markup(s, &signal_table[index]);
}

figure_series trace_series(const trace_run *run, int index, GPtrArray *owned)
{
    figure_series s = series_of(run, index);
    if (index == SIGNAL_INDEX(force) && !run->points && s.count > 0 && !on_the_rig(run->scenario)) {
        add_peaks(&s, &run->result->summary, owned);
    }
    return s;
}

figure_interval *trace_contact(const trace *rows, int *count, GPtrArray *owned)
{
    *count = intervals_of(rows, in_contact, NULL);
    figure_interval *intervals = keep(owned, g_new0(figure_interval, *count + 1));
    intervals_of(rows, in_contact, intervals);
    return intervals;
}

// Colours of runs that stand side by side, the most different first.
static const int rank_colours[8] = {0, 5, 2, 4, 1, 3, 6, 7};

// The series of one run; signals of the first link are left out where they equal the hub's.
static void add_series(trace_figure *t, int panel_index, const trace_panel *from,
                       const trace_run *runs, int run, int run_count, GPtrArray *texts)
{
    figure_panel *panel = &t->panels[panel_index];
    const scenario *s = runs[run].scenario;
    bool alone = from->signals[1] == NULL, named = false;
    for (int i = 0; i < TRACE_SIGNALS && from->signals[i] != NULL; i++) {
        int index = signal_index(from->signals[i]);
        bool twin = !alone && signal_table[index].body == BODY_FIRST_LINK && hub_is_first_link(s);
        bool points = run > 0 && runs[run].points;
        if (twin || (points && !trace_has(&runs[run].result->trace, index))) {
            continue;
        }
        figure_series *out = &t->series[panel_index][panel->series_count++];
        *out = trace_series(&runs[run], index, texts);
        for (int k = 0; k + 1 < panel->series_count && run == 0; k++) {
            // two readings of one quantity: the second in grey
            out->colour = t->series[panel_index][k].colour == out->colour ? 7 : out->colour;
        }
        out->secondary = run > 0;
        if (run > 0) {
            out->name = keep(texts, g_strconcat(out->name, " ", runs[run].name, NULL));
            out->colour = alone ? 6 : out->colour;
        }
        if (runs[run].rank > 0) {
            out->secondary = false;
            out->colour = rank_colours[(runs[run].rank - 1) % 8];
            out->label = i == 0 ? keep(texts, text_escape(runs[run].name)) : NULL;
            continue;
        }
        if (points) {
            out->no_line = true;
            out->secondary = false;
            out->marker = MARKER_CIRCLE;
            out->colour = 6;
            out->label = named ? NULL : keep(texts, text_escape(runs[run].name));
            named = true;
        } else if (alone && run_count > 1 && panel_index == 0) {
            // the first panel's legend holds for all
            out->label = keep(texts, text_escape(runs[run].name));
        } else if (!alone && run == 0) {
            out->label = keep(texts, series_label(s, index, true));
            out->symbol = keep(texts, series_symbol(s, index));
        }
    }
}

static void set_zoom(figure_panel *panel, const trace_run *run)
{
    const summary *m = &run->result->summary;
    double pulse = m->first_pulse_s, duration = run->scenario->parameters.run.duration;
    if (pulse > 0 && pulse < SHORT_PULSE * duration) {
        panel->zoom_from = fmax(0, m->first_contact_s - INSET_SPACE * pulse);
        panel->zoom_to = fmin(duration, m->first_contact_s + (1 + INSET_SPACE) * pulse);
    }
}

static void describe_panel(trace_figure *t, int index, const trace_panel *from,
                           const trace_run *runs, int run_count, GPtrArray *texts)
{
    figure_panel *panel = &t->panels[index];
    const signal_info *first = &signal_table[signal_index(from->signals[0])];
    const wall_parameters *wall = &runs[0].scenario->parameters.wall;
    panel->y.name = first->name;
    panel->y.unit = first->unit;
    panel->y.label = from->label ? from->label : keep(texts, own_label(runs[0].scenario, first));
    if (from->signals[1] == NULL) {
        panel->y.symbol = keep(texts, symbol_markup(runs[0].scenario, first));
    }
    panel->weight = from->weight;
    panel->y.with_zero = from->with_zero;
    panel->series = t->series[index];
    for (int run = 0; run < run_count; run++) {
        add_series(t, index, from, runs, run, run_count, texts);
    }
    if (from->impulses) {
        panel->impulses = t->impulses;
        panel->impulse_count = impact_impulses(&runs[0].result->trace, t->impulses);
        panel->impulse_label = "Impulse";
        panel->impulse_unit = signal_table[SIGNAL_INDEX(impulse)].unit;
    }
    if (from->wall && wall->kind != WALL_NONE) {
        t->wall = (figure_level){wall->angle, "wall"};
        panel->levels = &t->wall;
        panel->level_count = 1;
    }
    if (from->inset) {
        set_zoom(panel, &runs[0]);
    }
}

double trace_value_at(const trace *t, int index, double time)
{
    size_t low = 0, high = t->row_count;
    if (high == 0 || time < t->rows[0].time || time > t->rows[high - 1].time) {
        return (double)NAN;
    }
    // the last row that is not later
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (t->rows[middle].time <= time) {
            low = middle;
        } else {
            high = middle;
        }
    }
    double here = signal_value(&t->rows[low], index);
    if (high == t->row_count) {
        return here;
    }
    double span = t->rows[high].time - t->rows[low].time;
    double share = span > 0 ? (time - t->rows[low].time) / span : 0;
    return here + share * (signal_value(&t->rows[high], index) - here);
}

// A panel of what was measured less what was computed, for the first signal that has data.
static void add_residuals(trace_figure *t, const trace_panel *panels, const trace_run *computed,
                          const trace_run *measured, GPtrArray *owned)
{
    const trace *data = &measured->result->trace;
    int last = t->figure.panel_count, panel = 0;
    while (panel < last && !trace_has(data, signal_index(panels[panel].signals[0]))) {
        panel++;
    }
    if (panel == last || last == FIGURE_PANELS) {
        return;
    }
    int index = signal_index(panels[panel].signals[0]);
    double *x = keep(owned, g_new(double, data->row_count + 1));
    double *y = keep(owned, g_new(double, data->row_count + 1));
    for (size_t i = 0; i < data->row_count; i++) {
        x[i] = data->rows[i].time;
        y[i] = signal_value(&data->rows[i], index) -
               trace_value_at(&computed->result->trace, index, x[i]);
    }
    t->residual = (figure_series){.name = "residual",
                                  .x = x,
                                  .y = y,
                                  .count = data->row_count,
                                  .colour = 6,
                                  .marker = MARKER_CIRCLE,
                                  .no_line = true};
    t->panels[last] = (figure_panel){.y = {.name = "residual",
                                           .label = "Residual",
                                           .symbol = "Δ",
                                           .unit = signal_table[index].unit,
                                           .with_zero = true},
                                     .series = &t->residual,
                                     .series_count = 1,
                                     .weight = 0.6};
    t->figure.panel_count++;
}

static status check_panels(const trace_panel *panels, int count, int run_count, fault *f)
{
    if (count < 1 || count > FIGURE_PANELS || run_count < 1 || run_count > TRACE_RUNS) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "a figure of %d panels and %d runs, expected 1 to %d and 1 to %d", count,
                         run_count, FIGURE_PANELS, TRACE_RUNS);
    }
    for (int p = 0; p < count; p++) {
        for (int i = 0; i < TRACE_SIGNALS && (i == 0 || panels[p].signals[i] != NULL); i++) {
            const char *name = panels[p].signals[i];
            if (name == NULL || signal_find(name) < 0) {
                return fault_set(f, STATUS_BAD_ARGUMENT, "panel %d shows no known signal: '%s'",
                                 p + 1, name ? name : "");
            }
        }
    }
    return STATUS_OK;
}

status trace_figure_init(trace_figure *t, const char *title, const trace_panel *panels,
                         int panel_count, const trace_run *runs, int run_count, fault *f)
{
    assert(t != NULL && panels != NULL && runs != NULL);
    memset(t, 0, sizeof *t);
    status code = check_panels(panels, panel_count, run_count, f);
    if (code != STATUS_OK) {
        return code;
    }
    const trace *rows = &runs[0].result->trace;
    bool modes = false;
    for (int i = 0; i < panel_count; i++) {
        modes = modes || panels[i].modes;
    }
    bool (*shaded)(const sample *row) = modes ? in_second_mode : in_contact;
    const char *mode = modes ? mode_name(runs[0].scenario, 1) : NULL;
    int intervals = intervals_of(rows, shaded, NULL), impulses = impact_impulses(rows, NULL);
    t->marks = calloc(MARKS, sizeof *t->marks);
    t->intervals = calloc((size_t)intervals + 1, sizeof *t->intervals);
    t->impulses = calloc((size_t)impulses + 1, sizeof *t->impulses);
    if (t->marks == NULL || t->intervals == NULL || t->impulses == NULL) {
        trace_figure_finish(t);
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a figure of %zu rows",
                         rows->row_count);
    }
    GPtrArray *texts = t->owned = g_ptr_array_new_with_free_func(g_free);
    figure *fig = &t->figure;
    fig->title = title ? title : runs[0].scenario->title;
    char *shading = mode != NULL ? g_strdup_printf("%s mode", mode)
                                 : g_strdup(modes ? "second mode" : "contact");
    fig->caption = keep(texts, caption_of(&runs[0], shading));
    g_free(shading);
    fig->x.name = "time";
    fig->x.label = "Time <i>t</i>";
    fig->x.unit = "s";
    fig->panels = t->panels;
    fig->panel_count = panel_count;
    for (int i = 0; i < panel_count; i++) {
        describe_panel(t, i, &panels[i], runs, run_count, texts);
    }
    for (int run = 1; run < run_count; run++) {
        if (runs[run].points) {
            add_residuals(t, panels, &runs[0], &runs[run], texts);
        }
    }
    mark_events(t, &runs[0], texts);
    fig->marks = t->marks;
    fig->interval_count = intervals_of(rows, shaded, t->intervals);
    fig->intervals = t->intervals;
    fig->software = keep(texts, g_strconcat("impactlab ", lab_version(), NULL));
    fig->parameters = keep(texts, parameters_line(runs[0].scenario));
    return STATUS_OK;
}

void trace_figure_finish(trace_figure *t)
{
    if (t->owned != NULL) {
        g_ptr_array_free(t->owned, TRUE);
    }
    free(t->marks);
    free(t->intervals);
    free(t->impulses);
    memset(t, 0, sizeof *t);
}

const trace_panel usual_panels[USUAL_PANELS] = {
    {.signals = {"force"}, .with_zero = true, .impulses = true, .inset = true, .weight = 1.2},
    {.label = "Angle", .signals = {"hub_angle", "first_angle", "last_angle"}, .wall = true},
    {.label = "Angular velocity", .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    {.label = "Voltage <i>v</i>", .signals = {"voltage"}, .with_zero = true, .weight = 0.5},
};

status plot_run(const scenario *s, const run_result *result, const char *path, fault *f)
{
    return plot_run_beside(s, result, NULL, path, f);
}

status plot_run_beside(const scenario *s, const run_result *result, const run_result *old,
                       const char *path, fault *f)
{
    assert(s != NULL && result != NULL && path != NULL);
    const trace_run runs[] = {{s, result, "this run"}, {s, old, "old run"}};
    trace_figure t;
    status code =
        trace_figure_init(&t, NULL, usual_panels, USUAL_PANELS, runs, old != NULL ? 2 : 1, f);
    if (code == STATUS_OK) {
        code = figure_write(&t.figure, path, f);
        trace_figure_finish(&t);
    }
    return code;
}

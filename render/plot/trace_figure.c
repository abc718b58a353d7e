// Runs side by side: each has a colour, each signal a line, and one key says both.
#include "render/plot/trace_plot.h"

#include <assert.h>
#include <math.h>

#include "render/page/page.h"
#include "render/page/text.h"

// Whether a run has a signal of a panel to show: not the first link's where it equals the
// hub's, and of data only what was measured.
static bool shows(const trace_run *run, const trace_panel *panel, int index)
{
    bool twin = panel->signals[1] != NULL &&
                signal_table[index].body == BODY_FIRST_LINK &&
                trace_hub_is_first_link(run->scenario);
    return !twin && !(run->points && !trace_has(&run->result->trace, index));
}

// ---- lines

enum { KEY_ENTRIES = TRACE_RUNS + FIGURE_PANELS * TRACE_SIGNALS };

// The key of runs side by side: their colours, then lines, then data.
typedef struct trace_key {
    figure_panel panel;
    figure_series series[KEY_ENTRIES];
    int meanings[KEY_ENTRIES]; // what the entry is a line of; 0: no signal
} trace_key;

// What a line stands for: a body, whatever is shown of it, or else a signal.
static int meaning_of(int index)
{
    const signal_body body = signal_table[index].body;
    if (body != BODY_NONE) {
        return -(int)body;
    }
    return index;
}

// The key's entry for a signal, or -1.
static int find_entry(const trace_key *key, int meaning)
{
    for (int i = 0; i < key->panel.series_count; i++) {
        if (key->meanings[i] == meaning) {
            return i;
        }
    }
    return -1;
}

// The plainest line that no signal has with which this one shares a panel.
static line_style free_line(const trace_key *key, const trace_panel *panels,
                            int panel_count, int meaning)
{
    static const line_style lines[TRACE_SIGNALS] = {LINE_SOLID, LINE_DASHED,
                                                    LINE_DASH_DOT, LINE_DOTTED};
    bool taken[TRACE_SIGNALS] = {false};

    for (int p = 0; p < panel_count; p++) {
        bool here = false;
        for (int i = 0; i < TRACE_SIGNALS && panels[p].signals[i] != NULL; i++) {
            here = here || meaning_of(signal_index(panels[p].signals[i])) == meaning;
        }
        for (int i = 0; here && i < TRACE_SIGNALS && panels[p].signals[i] != NULL; i++) {
            int entry = find_entry(key, meaning_of(signal_index(panels[p].signals[i])));
            for (int k = 0; entry >= 0 && k < TRACE_SIGNALS; k++) {
                taken[k] = taken[k] || key->series[entry].style == lines[k];
            }
        }
    }

    int k = 0;
    while (k + 1 < TRACE_SIGNALS && taken[k]) {
        k++;
    }
    return lines[k];
}

// ---- the key

static void add_entry(owned_figure *o, trace_key *key, figure_series entry, int meaning,
                      char *label)
{
    entry.name = entry.label = owned_figure_keep(o, label);
    key->meanings[key->panel.series_count] = meaning;
    key->series[key->panel.series_count++] = entry;
}

// "hub and first link", or of a signal of no body its symbol and what it is.
static char *signal_label(const trace_run *runs, int run_count, int index)
{
    const signal_body body = signal_table[index].body;
    bool joined = body == BODY_HUB;
    for (int run = 0; run < run_count; run++) {
        joined = joined && trace_hub_is_first_link(runs[run].scenario);
    }
    if (body == BODY_NONE) {
        return trace_series_label(runs[0].scenario, index, false);
    }
    return g_strconcat(signal_body_name(body), joined ? " and first link" : "", NULL);
}

// The signals of panels that have several, in the colour of texts.
static void add_signals(owned_figure *o, trace_key *key, const trace_panel *panels,
                        const trace_panel *p, const trace_run *runs, int run_count)
{
    for (int i = 0; i < TRACE_SIGNALS && p->signals[1] != NULL && p->signals[i] != NULL;
         i++) {
        int index = signal_index(p->signals[i]), meaning = meaning_of(index);
        bool shown = false;
        for (int run = 0; run < run_count; run++) {
            shown = shown || (shows(&runs[run], p, index) &&
                              trace_has(&runs[run].result->trace, index));
        }
        if (shown && find_entry(key, meaning) < 0) {
            const line_style style =
                free_line(key, panels, o->figure.panel_count, meaning);
            add_entry(o, key, (figure_series){.run = 1, .colour = 6, .style = style},
                      meaning, signal_label(runs, run_count, index));
        }
    }
}

// Gives signals that stand in one panel different lines, and the figure one key for all
// panels of both runs and signals; empty where no run has a rank.
static trace_key *make_key(owned_figure *o, const trace_panel *panels,
                           const trace_run *runs, int run_count)
{
    trace_key *key = owned_figure_keep(o, g_new0(trace_key, 1));
    for (int run = 0; run < run_count; run++) {
        if (runs[run].rank > 0) {
            const figure_series line = {.run = runs[run].rank,
                                        .colour = palette_slot(runs[run].rank - 1)};
            add_entry(o, key, line, 0, text_escape(runs[run].name));
        }
    }
    if (key->panel.series_count == 0) {
        return key;
    }
    key->panel.series = key->series;
    o->figure.key = &key->panel;
    o->figure.common_legend = true;

    // signals, and data
    for (int p = 0; p < o->figure.panel_count; p++) {
        add_signals(o, key, panels, &panels[p], runs, run_count);
    }
    for (int run = 0; run < run_count; run++) {
        if (runs[run].points) {
            const figure_series points = {.run = 1,
                                          .no_line = true,
                                          .marker = MARKER_CIRCLE,
                                          .colour = 6};
            add_entry(o, key, points, 0, text_escape(runs[run].name));
        }
    }
    return key;
}

// ==== panels

#define SHORT_PULSE 0.1  // share of the run below which the first pulse is shown enlarged
#define STEP_RADIUS 1.1  // of a point at every step [pt]
#define INSET_SPACE 0.15 // of the pulse, shown before and after it

// ---- panels

// The series of one run.
static void add_series(owned_figure *o, const trace_key *key, int panel_index,
                       const trace_panel *from, const trace_run *runs, int run,
                       int run_count)
{
    figure_panel *panel = &o->panels[panel_index];
    const scenario *s = runs[run].scenario;
    bool alone = from->signals[1] == NULL, points = run > 0 && runs[run].points,
         named = false;

    for (int i = 0; i < TRACE_SIGNALS && from->signals[i] != NULL; i++) {
        int index = signal_index(from->signals[i]);

        // what the hub shows already, and what was not measured
        bool left_out = run > 0 && runs[run].brief && i > 0;
        if (left_out || !shows(&runs[run], from, index)) {
            continue;
        }

        // as the signal table has it
        figure_series *out =
            owned_figure_add(o, panel_index, trace_series(&runs[run], index, o));
        for (int k = 0; k + 1 < panel->series_count && run == 0; k++) {
            // two readings of one quantity: the second in grey
            if (o->series[panel_index][k].colour == out->colour) {
                out->colour = 7;
            }
        }

        // the second run stands back
        out->secondary = run > 0;
        if (runs[run].steps) {
            out->marker = MARKER_CIRCLE;
            out->radius = STEP_RADIUS;
        }
        if (run > 0) {
            out->name =
                owned_figure_keep(o, g_strconcat(out->name, " ", runs[run].name, NULL));
            if (alone) {
                out->colour = 6;
            } else if (runs[run].brief) {
                out->colour = 7;
            }
        }

        // runs side by side have a colour each, the same signal has one line in all
        if (runs[run].rank > 0) {
            out->secondary = false;
            out->run = runs[run].rank;
            out->colour = palette_slot(runs[run].rank - 1);
            const int entry = find_entry(key, meaning_of(index));
            if (entry >= 0) {
                out->style = key->series[entry].style;
            } else {
                out->style = LINE_SOLID;
            }
            continue;
        }

        // measured points; else a label where the legend needs one
        if (points) {
            out->no_line = true;
            out->secondary = false;
            out->marker = MARKER_CIRCLE;
            out->colour = 6;
            if (named) {
                out->label = NULL;
            } else {
                out->label = owned_figure_keep(o, text_escape(runs[run].name));
            }
            named = true;
        } else if (alone && run_count > 1 && panel_index == 0) {
            // the first panel's legend holds for all
            out->label = owned_figure_keep(o, text_escape(runs[run].name));
        } else if (!alone && run == 0) {
            out->label = owned_figure_keep(o, trace_series_label(s, index, true));
            out->symbol = owned_figure_keep(o, trace_series_symbol(s, index));
        } else if (!alone && !named) {
            // the first of its signals speaks for the other run
            g_autofree char *symbol = trace_series_symbol(s, index),
                            *run_name = text_escape(runs[run].name);
            out->label = owned_figure_printf(o, "%s  %s", symbol, run_name);
            named = true;
        }
    }
}

// Shows a short first pulse once more in an inset.
static void enlarge_pulse(figure_panel *panel, const trace_run *run)
{
    const summary *m = &run->result->summary;
    const double pulse = m->first_pulse_s, contact = m->first_contact_s;
    const double duration = run->scenario->parameters.run.duration;
    if (pulse > 0 && pulse < SHORT_PULSE * duration) {
        panel->zoom_from = fmax(0, contact - INSET_SPACE * pulse);
        panel->zoom_to = fmin(duration, contact + (1 + INSET_SPACE) * pulse);
    }
}

static void describe_panel(owned_figure *o, const trace_key *key, int index,
                           const trace_panel *from, const trace_run *runs, int run_count)
{
    figure_panel *panel = &o->panels[index];
    const signal_info *first = &signal_table[signal_index(from->signals[0])];
    const wall_parameters *wall = &runs[0].scenario->parameters.wall;

    // the axis, whose symbol names the body
    const char *symbol =
        owned_figure_keep(o, trace_symbol(runs[0].scenario, signal_index(first->name)));
    panel->y.name = first->name;
    panel->y.unit = first->unit;
    if (from->label != NULL) {
        panel->y.label = from->label;
    } else {
        panel->y.label = owned_figure_printf(o, "%s %s", first->quantity, symbol);
    }
    if (from->signals[1] == NULL) {
        panel->y.symbol = symbol;
    }
    panel->weight = from->weight;
    panel->y.with_zero = from->with_zero;

    // curves of all runs
    for (int run = 0; run < run_count; run++) {
        add_series(o, key, index, from, runs, run, run_count);
    }

    // what is drawn with them
    if (from->impulses) {
        panel->impulses =
            trace_impulses(&runs[0].result->trace, &panel->impulse_count, o);
        panel->impulse_label = "Impulse";
        panel->impulse_unit = signal_table[SIGNAL_INDEX(impulse)].unit;
    }
    if (from->wall && wall->kind != WALL_NONE) {
        panel->levels = OWNED(o, figure_level, wall->angle, "wall");
        panel->level_count = 1;
    }
    if (from->inset) {
        enlarge_pulse(panel, &runs[0]);
    }
}

// A panel of what was measured less what was computed, for the first signal that has
// data.
static void add_residuals(owned_figure *o, const trace_panel *panels,
                          const trace_run *computed, const trace_run *measured)
{
    const trace *data = &measured->result->trace;

    // the first panel with a measured signal
    int last = o->figure.panel_count, panel = 0;
    while (panel < last && !trace_has(data, signal_index(panels[panel].signals[0]))) {
        panel++;
    }
    if (panel == last || last == FIGURE_PANELS) {
        return;
    }

    int index = signal_index(panels[panel].signals[0]);
    figure_series *s =
        owned_figure_add(o, last,
                         trace_difference(data, &computed->result->trace, index, o));
    s->name = "residual";
    s->colour = 6;
    s->marker = MARKER_CIRCLE;
    s->no_line = true;
    o->panels[last].y = (figure_axis){"residual", "Residual", signal_table[index].unit,
                                      "Δ", .with_zero = true};
    o->panels[last].weight = 0.6;
    o->figure.panel_count++;
}

// What is shaded: contact, or the controller's second mode by its name.
static char *shading_text(const scenario *s, bool modes)
{
    const char *mode = trace_mode_name(s, 1);
    if (!modes) {
        return g_strdup("contact");
    }
    if (mode == NULL) {
        return g_strdup("second mode");
    }
    return text_printf("%s mode", mode);
}

owned_figure *trace_figure_create(const char *title, const trace_panel *panels,
                                  int panel_count, const trace_run *runs, int run_count)
{
    assert(panel_count >= 1 && panel_count <= FIGURE_PANELS);
    assert(run_count >= 1 && run_count <= TRACE_RUNS);

    // what is shaded
    bool modes = false;
    for (int i = 0; i < panel_count; i++) {
        modes = modes || panels[i].modes;
    }
    g_autofree char *shading = shading_text(runs[0].scenario, modes);

    // the page
    g_autofree char *own_title = scenario_title(runs[0].scenario);
    owned_figure *o = owned_figure_create(panel_count, "%s", text_or(title, own_title));
    o->figure.caption = owned_figure_keep(o, trace_caption(runs, run_count, shading));
    o->figure.x = (figure_axis){"time", "Time <i>t</i>", .unit = "s"};
    o->figure.parameters = owned_figure_keep(o, parameters_line(runs[0].scenario));

    // panels with their curves; side by side, runs are told by colours and signals by
    // lines
    const trace_key *key = make_key(o, panels, runs, run_count);
    for (int i = 0; i < panel_count; i++) {
        describe_panel(o, key, i, &panels[i], runs, run_count);
    }
    for (int run = 1; run < run_count; run++) {
        if (runs[run].points) {
            add_residuals(o, panels, &runs[0], &runs[run]);
        }
    }

    // marks and shading
    trace_mark_events(o, &runs[0]);
    trace_shade(o, &runs[0].result->trace, modes);
    return o;
}

const trace_panel usual_panels[USUAL_PANELS] = {
    {.signals = {"force"},
     .with_zero = true,
     .impulses = true,
     .inset = true,
     .weight = 1.2},
    {.label = "Angle",
     .signals = {"hub_angle", "first_angle", "last_angle"},
     .wall = true},
    {.label = "Angular velocity",
     .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    {.label = "Voltage <i>v</i>",
     .signals = {"voltage"},
     .with_zero = true,
     .weight = 0.5},
};

status plot_run(const scenario *s, const run_result *result, const run_result *old,
                const figure_mark *notes, int note_count, const char *path, fault *f)
{
    const trace_run runs[] = {{s, result, "this run"}, {s, old, "old run"}};
    const int run_count = old != NULL ? 2 : 1;
    owned_figure *o =
        trace_figure_create(NULL, usual_panels, USUAL_PANELS, runs, run_count);

    // notes behind the figure's marks
    const int count = o->figure.mark_count;
    figure_mark *all =
        owned_figure_keep(o, g_new0(figure_mark, (gsize)(count + note_count) + 1));
    for (int i = 0; i < count; i++) {
        all[i] = o->figure.marks[i];
    }
    for (int i = 0; i < note_count; i++) {
        char *label = owned_figure_keep(o, g_markup_escape_text(notes[i].label, -1));
        all[count + i] = (figure_mark){.x = notes[i].x, .label = label};
    }
    o->figure.marks = all;
    o->figure.mark_count += note_count;

    status code = figure_write(&o->figure, path, f);
    owned_figure_destroy(o);
    return code;
}

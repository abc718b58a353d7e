// Runs side by side: each has a colour, each signal a line, and one key says both.
#include "render/plot/trace_plot.h"

#include "render/page/text.h"

enum { NO_SIGNAL = -1 };

// Whether two signals have one line wherever they are shown: those of one body do.
static bool share_line(int index, int other)
{
    const signal_body body = signal_table[index].body;
    return index == other || (body != BODY_NONE && body == signal_table[other].body);
}

// The key's entry for a signal, or -1.
static int find_entry(const trace_key *key, int index)
{
    for (int i = 0; i < key->panel.series_count; i++) {
        if (key->signals[i] != NO_SIGNAL && share_line(key->signals[i], index)) {
            return i;
        }
    }
    return -1;
}

line_style trace_key_line(const trace_key *key, int index)
{
    const int entry = find_entry(key, index);
    if (entry < 0) {
        return LINE_SOLID;
    }
    return key->series[entry].style;
}

// ---- lines

// Whether a panel shows a signal with the line of another one.
static bool panel_has_line(const trace_panel *panel, int index)
{
    for (int i = 0; i < TRACE_SIGNALS && panel->signals[i] != NULL; i++) {
        if (share_line(signal_index(panel->signals[i]), index)) {
            return true;
        }
    }
    return false;
}

// The plainest line that no signal has with which this one shares a panel.
static line_style free_line(const trace_key *key, const trace_figure *from, int index)
{
    static const line_style lines[TRACE_SIGNALS] = {LINE_SOLID, LINE_DASHED,
                                                    LINE_DASH_DOT, LINE_DOTTED};
    bool taken[TRACE_SIGNALS] = {false}; // by line_style

    for (int p = 0; p < from->drawn->figure.panel_count; p++) {
        const trace_panel *panel = &from->panels[p];
        if (!panel_has_line(panel, index)) {
            continue;
        }
        for (int i = 0; i < TRACE_SIGNALS && panel->signals[i] != NULL; i++) {
            const int entry = find_entry(key, signal_index(panel->signals[i]));
            if (entry >= 0) {
                taken[key->series[entry].style] = true;
            }
        }
    }

    // the last one where all are taken
    int plainest = 0;
    while (plainest + 1 < TRACE_SIGNALS && taken[lines[plainest]]) {
        plainest++;
    }
    return lines[plainest];
}

// ---- entries

static void add_key_entry(trace_key *key, owned_figure *drawn, figure_series entry,
                          int signal, char *label)
{
    entry.name = entry.label = owned_figure_keep(drawn, label);
    key->signals[key->panel.series_count] = signal;
    key->series[key->panel.series_count++] = entry;
}

// The runs, by their colours.
static void add_ranked_runs(trace_key *key, const trace_figure *from)
{
    for (int i = 0; i < from->run_count; i++) {
        const trace_run *run = &from->runs[i];
        if (run->rank > 0) {
            const figure_series line = {.run = run->rank,
                                        .colour = palette_slot(run->rank - 1)};
            add_key_entry(key, from->drawn, line, NO_SIGNAL, text_escape(run->name));
        }
    }
}

// "hub and first link", or of a signal of no body its symbol and what it is.
static char *line_label(const trace_figure *from, int index)
{
    const signal_body body = signal_table[index].body;
    if (body == BODY_NONE) {
        return trace_series_label(from->runs[0].scenario, index, false);
    }

    // one body where every run has them joined
    bool joined = body == BODY_HUB;
    for (int i = 0; i < from->run_count && joined; i++) {
        joined = trace_hub_is_first_link(from->runs[i].scenario);
    }
    if (joined) {
        return g_strconcat(signal_body_name(body), " and first link", NULL);
    }
    return g_strdup(signal_body_name(body));
}

// Whether any run has a signal of a panel to show.
static bool any_run_shows(const trace_figure *from, const trace_panel *panel, int index)
{
    for (int i = 0; i < from->run_count; i++) {
        const trace_run *run = &from->runs[i];
        if (trace_shows(run, panel, index) && trace_has(&run->result->trace, index)) {
            return true;
        }
    }
    return false;
}

// The signals of a panel that has several, by their lines, in the colour of texts.
static void add_lines(trace_key *key, const trace_figure *from, const trace_panel *panel)
{
    if (panel->signals[1] == NULL) {
        return;
    }
    for (int i = 0; i < TRACE_SIGNALS && panel->signals[i] != NULL; i++) {
        const int index = signal_index(panel->signals[i]);
        if (any_run_shows(from, panel, index) && find_entry(key, index) < 0) {
            const figure_series line = {.run = 1,
                                        .colour = SLOT_BLACK,
                                        .style = free_line(key, from, index)};
            add_key_entry(key, from->drawn, line, index, line_label(from, index));
        }
    }
}

// Measured data, by their points.
static void add_measured(trace_key *key, const trace_figure *from)
{
    for (int i = 0; i < from->run_count; i++) {
        if (from->runs[i].points) {
            const figure_series points = {.run = 1,
                                          .no_line = true,
                                          .marker = MARKER_CIRCLE,
                                          .colour = SLOT_BLACK};
            add_key_entry(key, from->drawn, points, NO_SIGNAL,
                          text_escape(from->runs[i].name));
        }
    }
}

// Runs first, then lines, then data.
const trace_key *trace_key_create(const trace_figure *from)
{
    figure *fig = &from->drawn->figure;
    trace_key *key = owned_figure_keep(from->drawn, g_new0(trace_key, 1));
    add_ranked_runs(key, from);
    if (key->panel.series_count == 0) {
        return key;
    }

    // one legend for all panels
    key->panel.series = key->series;
    fig->key = &key->panel;
    fig->common_legend = true;
    for (int p = 0; p < fig->panel_count; p++) {
        add_lines(key, from, &from->panels[p]);
    }
    add_measured(key, from);
    return key;
}

// Runs side by side: each has a colour, each signal a line, and one key says both.
#include "render/plot/trace_parts.h"

#include <string.h>

#include "render/page/text.h"

bool trace_shows(const trace_run *run, const trace_panel *panel, int index)
{
    bool twin = panel->signals[1] != NULL && signal_table[index].body == BODY_FIRST_LINK &&
                trace_hub_is_first_link(run->scenario);
    return !twin && !(run->points && !trace_has(&run->result->trace, index));
}

int trace_run_colour(const trace_run *run)
{
    // the most different first
    static const int colours[TRACE_RUNS] = {0, 5, 2, 4, 1, 3, 6, 7};
    return colours[(run->rank - 1) % TRACE_RUNS];
}

// ---- lines

// What a line stands for: a body, whatever is shown of it, or else a signal.
static int meaning_of(int index)
{
    const signal_body body = signal_table[index].body;
    return body != BODY_NONE ? -(int)body : index;
}

// The key's entry for a signal, or -1.
static int find_entry(const trace_figure *t, int meaning)
{
    for (int i = 0; i < t->key.series_count; i++) {
        if (t->key_signals[i] == meaning) {
            return i;
        }
    }
    return -1;
}

line_style trace_line(const trace_figure *t, int index)
{
    int i = find_entry(t, meaning_of(index));
    return i >= 0 ? t->key_series[i].style : LINE_SOLID;
}

// The plainest line that no signal has with which this one shares a panel.
static line_style free_line(const trace_figure *t, const trace_panel *panels, int meaning)
{
    static const line_style lines[TRACE_SIGNALS] = {LINE_SOLID, LINE_DASHED, LINE_DASH_DOT,
                                                    LINE_DOTTED};
    bool taken[TRACE_SIGNALS] = {false};

    for (int p = 0; p < t->figure.panel_count; p++) {
        bool here = false;
        for (int i = 0; i < TRACE_SIGNALS && panels[p].signals[i] != NULL; i++) {
            here = here || meaning_of(signal_index(panels[p].signals[i])) == meaning;
        }
        for (int i = 0; here && i < TRACE_SIGNALS && panels[p].signals[i] != NULL; i++) {
            int entry = find_entry(t, meaning_of(signal_index(panels[p].signals[i])));
            for (int k = 0; entry >= 0 && k < TRACE_SIGNALS; k++) {
                taken[k] = taken[k] || t->key_series[entry].style == lines[k];
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

static void add_entry(trace_figure *t, figure_series entry, int meaning, char *label)
{
    entry.name = entry.label = trace_keep(t->owned, label);
    t->key_signals[t->key.series_count] = meaning;
    t->key_series[t->key.series_count++] = entry;
}

// "hub and first link", or of a signal of no body its symbol and what it is.
static char *signal_label(const trace_run *runs, int run_count, int index)
{
    const signal_body body = signal_table[index].body;
    bool joined = body == BODY_HUB;
    for (int run = 0; run < run_count; run++) {
        joined = joined && trace_hub_is_first_link(runs[run].scenario);
    }
    return body == BODY_NONE
               ? trace_series_label(runs[0].scenario, index, false)
               : g_strconcat(signal_body_name(body), joined ? " and first link" : "", NULL);
}

// The signals of a panel that has several, in the colour of texts.
static void add_signals(trace_figure *t, const trace_panel *panels, int panel,
                        const trace_run *runs, int run_count)
{
    const trace_panel *p = &panels[panel];
    for (int i = 0; i < TRACE_SIGNALS && p->signals[1] != NULL && p->signals[i] != NULL; i++) {
        int index = signal_index(p->signals[i]), meaning = meaning_of(index);
        bool shown = false;
        for (int run = 0; run < run_count; run++) {
            shown = shown || (trace_shows(&runs[run], p, index) &&
                              trace_has(&runs[run].result->trace, index));
        }
        if (shown && find_entry(t, meaning) < 0) {
            const figure_series line = {
                .run = 1, .colour = 6, .style = free_line(t, panels, meaning)};
            add_entry(t, line, meaning, signal_label(runs, run_count, index));
        }
    }
}

void trace_make_key(trace_figure *t, const trace_panel *panels, const trace_run *runs,
                    int run_count)
{
    // runs
    for (int run = 0; run < run_count; run++) {
        if (runs[run].rank > 0) {
            const figure_series line = {.run = runs[run].rank,
                                        .colour = trace_run_colour(&runs[run])};
            add_entry(t, line, 0, text_escape(runs[run].name));
        }
    }
    if (t->key.series_count == 0) {
        return;
    }
    t->key.series = t->key_series;
    t->figure.key = &t->key;
    t->figure.common_legend = true;

    // signals, and data
    for (int p = 0; p < t->figure.panel_count; p++) {
        add_signals(t, panels, p, runs, run_count);
    }
    for (int run = 0; run < run_count; run++) {
        if (runs[run].points) {
            const figure_series points = {
                .run = 1, .no_line = true, .marker = MARKER_CIRCLE, .colour = 6};
            add_entry(t, points, 0, text_escape(runs[run].name));
        }
    }
}

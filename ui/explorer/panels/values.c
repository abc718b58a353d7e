// The panels of values at the cursor and of statistics.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

#include "src/run/trace.h"

// --- values ----------------------------------------------------------------------------
// The panel of all recorded values at the cursor.

enum { NAME = 19, NUMBER = 10, UNIT = 6 }; // columns [cells]

// Whether a signal is in the list: the filter lets it through, and it is not of a sensor
// that is not fitted, which has no value.
static bool is_listed(const explorer_view *view, const sample *row, int signal)
{
    return !(signal_table[signal].optional && isnan(signal_value(row, signal))) &&
           filter_passes(view->filters.text[PANEL_VALUES], signal_table[signal].name);
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    const session *e = &model->session;
    const sample *row = session_sample(e), *beside = NULL;
    sample between;
    const char *against = "", *filter = view->filters.text[PANEL_VALUES];

    // beside the values at the mark, or else those of the kept run
    if (view->mark.set) {
        const trace *t = &e->run.trace;
        beside = &t->rows[trace_row_on_side(t, view->mark.time, view->mark.side)];
        against = ", minus mark";
    } else if (e->has_other) {
        between = trace_sample_at(&e->other.trace, row->time,
                                  trace_side(&e->run.trace, e->row));
        beside = &between;
        against = ", minus old run";
    }

    // as many as there is room for, from the line that it is scrolled to
    int height = a.height - 2, shown = 0, line = 0;
    for (int i = 0; i < signal_count; i++) {
        shown += is_listed(view, row, i);
    }
    int first =
        layout_keep_scroll(lay, PANEL_VALUES, shown > height ? shown - height : 0);
    layout_add_hit(lay, (hit_area){.panel = PANEL_VALUES, .area = a});
    char title[LINE_TEXT + 64], part[32] = "";
    if (shown > height) {
        snprintf(part, sizeof part, ", %d-%d of %d", first + 1, first + height, shown);
    }
    snprintf(title, sizeof title, "values%s%s%s%s", against, filter[0] ? " /" : "",
             filter, part);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // full names if there is room for them and two numbers
    const int room = a.width - 4, numbers = beside != NULL ? 2 * NUMBER : NUMBER;
    const bool wide = room >= NAME + numbers + UNIT;
    const int names = room - numbers - (wide || beside == NULL ? UNIT : 0);
    for (int i = 0; i < signal_count && line < first + height; i++) {
        if (!is_listed(view, row, i) || line++ < first) {
            continue;
        }
        const signal_info *info = &signal_table[i];
        double value = signal_value(row, i), other = beside ? signal_value(beside, i) : 0;
        double difference = value - other, size = fmax(fabs(value), fabs(other));
        bool differs = beside != NULL && fabs(difference) > 1e-6 * size;
        int y = a.y + line - first, x = a.x + 2;
        const bool fits = (int)strlen(info->name) < names;
        screen_text(s, x, y, names - 1, INK_TEXT, fits ? info->name : info->ascii);
        x += names;
        screen_print(s, x, y, NUMBER, INK_TITLE, "%9s", draw_number(value).text);
        x += NUMBER;
        if (beside != NULL) {
            number_text said = draw_number(difference);
            if (signal_is_state(i)) {
                snprintf(said.text, sizeof said.text, "%s", differs ? "other" : "same");
            }
            const ink colour = differs ? INK_WARNING : INK_DIM;
            screen_print(s, x, y, NUMBER, colour, "%9s", said.text);
            x += NUMBER;
        }
        if (wide || beside == NULL) {
            screen_text(s, x, y, a.x + a.width - 2 - x, INK_DIM, info->unit);
        }
    }
}

const panel values_panel = {.name = "values", .draw = draw, .wheel = WHEEL_LINES};

// --- statistics ------------------------------------------------------------------------
// The panel of statistics: what the signals of the panes come to between the mark and the
// cursor, or in the visible part of the run.

enum { LINES = 3 }; // of a signal

// The signals of the panes that are shown, those of the pane in focus first, each once;
// an expression has no difference.
static int find_signals(const explorer_model *model, const explorer_view *view,
                        int signals[PANES * PANE_SIGNALS])
{
    int count = 0;
    const int focused = panes_focused(&view->panes);
    const bool subtracts = model_subtracts(model);

    // from the pane in focus on and around, a signal of several panes once
    for (int i = 0; i < PANES && focused >= 0; i++) {
        const pane *p = &view->panes.pane[(focused + i) % PANES];
        for (int k = 0; p->shown && k < p->count; k++) {
            bool there = subtracts && signal_is_derived(p->signals[k]);
            for (int j = 0; j < count; j++) {
                there = there || signals[j] == p->signals[k];
            }
            if (!there) {
                signals[count++] = p->signals[k];
            }
        }
    }
    return count;
}

// The unit of a signal's integral over time: "N s", of "rad/s" it is "rad".
static void integral_unit(const char *unit, char *text, size_t size)
{
    const size_t length = strlen(unit);
    if (length > 3 && strcmp(unit + length - 3, "/s2") == 0) {
        snprintf(text, size, "%.*s", (int)length - 1, unit);
    } else if (length > 2 && strcmp(unit + length - 2, "/s") == 0) {
        snprintf(text, size, "%.*s", (int)length - 2, unit);
    } else {
        snprintf(text, size, "%s%ss", unit, length > 0 ? " " : "");
    }
}

// The three lines of a signal.
static void draw_signal(screen *s, area a, int signal, const signal_statistics *x)
{
    const signal_info *info = &signal_table[signal];
    char unit[32];
    const number_text mean = draw_number(x->mean), integral = draw_number(x->integral);
    integral_unit(info->unit, unit, sizeof unit);

    // name, then two rows of numbers
    screen_text(s, a.x, a.y, a.width, INK_TITLE, info->name);
    if (info->unit[0] != '\0') {
        screen_print(s, a.x + a.width - 8, a.y, 8, INK_DIM, "%8s", info->unit);
    }
    screen_print(s, a.x, a.y + 1, a.width, INK_TEXT, " min %-9s max %s",
                 draw_number(x->minimum).text, draw_number(x->maximum).text);

    // a state has no mean and no integral, one that is on or off the time it is on
    if (signal_is_state(signal) && x->maximum <= 1) {
        screen_print(s, a.x, a.y + 2, a.width, INK_TEXT, " for %s s in all",
                     integral.text);
    } else if (!signal_is_state(signal) && a.width >= 40) {
        screen_print(s, a.x + 28, a.y + 1, a.width - 28, INK_TEXT, "mean %s", mean.text);
        screen_print(s, a.x, a.y + 2, a.width, INK_TEXT, " rms %-9s integral %s %s",
                     draw_number(x->rms).text, integral.text, unit);
    } else if (!signal_is_state(signal)) {
        screen_print(s, a.x, a.y + 2, a.width, INK_TEXT, " mean %-8s \u222b %s %s",
                     mean.text, integral.text, unit);
    }
}

static void draw_statistics(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    int signals[PANES * PANE_SIGNALS];
    const trace *t = model_run(model, 0).trace;
    const int count = find_signals(model, view, signals), fit = (a.height - 3) / LINES;
    const int first =
        layout_keep_scroll(lay, PANEL_STATISTICS, count > fit ? count - fit : 0);
    double from, to;

    // between both cursors, else what is visible
    view_window(model, view, &from, &to);
    if (view->mark.set) {
        from = fmin(view->mark.time, model->session.now);
        to = fmax(view->mark.time, model->session.now);
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME,
                 "statistics (m sets the mark)");
    layout_add_hit(lay, (hit_area){.panel = PANEL_STATISTICS, .area = a});
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "%s%s %.5g to %.5g s",
                 model_subtracts(model) ? "minus baseline, " : "",
                 view->mark.set ? "mark and cursor," : "visible part,", from, to);
    for (int i = first; i < count && i - first < fit; i++) {
        const signal_statistics x = trace_statistics(t, signals[i], from, to);
        const area lines = {a.x + 2, a.y + 2 + LINES * (i - first), a.width - 4, LINES};
        draw_signal(s, lines, signals[i], &x);
    }
}

const panel statistics_panel = {.name = "statistics",
                                .draw = draw_statistics,
                                .wheel = 1};

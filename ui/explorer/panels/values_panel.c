// The panels of values at the cursor and of statistics.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

#include "src/run/trace.h"

// --- values ----------------------------------------------------------------------------
// The panel of all recorded values at the cursor.

enum { NAME = 19, NUMBER = 10, UNIT = 6 }; // widths of columns [cells]

// Whether a signal is in the list: the filter lets it through, and it is not of a sensor
// that is not fitted, which has no value.
static bool is_listed(const explorer_view *view, const sample *row, int signal)
{
    const signal_info *info = &signal_table[signal];
    if (info->needs != 0 && isnan(signal_value(row, signal))) {
        return false;
    }
    return filter_passes(view->filters.text[PANEL_VALUES], info->name);
}

// What the values are compared with: those at the mark, or else those of the kept run.
typedef struct compared_values {
    const sample *row; // NULL: with nothing
    sample between;    // of the kept run at the same instant
    const char *name;  // in the title
} compared_values;

// Finds what the values at the cursor are compared with.
static void find_compared_values(const explorer_model *model, const explorer_view *view,
                                 compared_values *c)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    *c = (compared_values){.name = ""};
    if (view->mark.set) {
        c->row = &t->rows[trace_row_on_side(t, view->mark.time, view->mark.side)];
        c->name = ", minus mark";
    } else if (e->has_other) {
        const double time = session_sample(e)->time;
        c->between = trace_sample_at(&e->other.trace, time, trace_side(t, e->row));
        c->row = &c->between;
        c->name = ", minus old run";
    }
}

// How the columns of the list are laid out: full names and units if there is room for
// them and the numbers.
typedef struct value_columns {
    int names; // width [cells]
    bool units;
} value_columns;

// The columns in so many cells, with a second number if values are compared.
static value_columns value_columns_for(int room, bool compares)
{
    const int numbers = compares ? 2 * NUMBER : NUMBER;
    value_columns c = {.units = !compares || room >= NAME + numbers + UNIT};
    c.names = room - numbers;
    if (c.units) {
        c.names -= UNIT;
    }
    return c;
}

// By how much a value differs from the other one; of a state only whether it does.
static void draw_difference(screen *s, area a, int signal, double value, double other)
{
    const double size = fmax(fabs(value), fabs(other));
    const bool differs = fabs(value - other) > 1e-6 * size;
    const ink shade = differs ? INK_WARNING : INK_DIM;
    const char *state = differs ? "other" : "same";
    const number_text number = draw_number(value - other);
    const char *text = signal_is_state(signal) ? state : number.text;
    screen_print(s, a.x, a.y, NUMBER, shade, "%9s", text);
}

// A signal's name, value, difference and unit in a line.
static void draw_value(screen *s, area line, int signal, const sample *row,
                       const sample *other, value_columns columns)
{
    const signal_info *info = &signal_table[signal];
    const char *name = info->name;
    if ((int)strlen(name) >= columns.names) {
        name = info->ascii;
    }
    const double value = signal_value(row, signal);
    screen_text(s, line.x, line.y, columns.names - 1, INK_TEXT, name);
    area rest = area_right(line, columns.names);
    screen_print(s, rest.x, rest.y, NUMBER, INK_TITLE, "%9s", draw_number(value).text);
    rest = area_right(rest, NUMBER);
    if (other != NULL) {
        draw_difference(s, rest, signal, value, signal_value(other, signal));
        rest = area_right(rest, NUMBER);
    }
    if (columns.units) {
        area_text(s, rest, INK_DIM, info->unit);
    }
}

// The signals that the filter lets through, each with its value at the cursor.
static void draw_values(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area a)
{
    const sample *row = session_sample(&model->session);
    const char *filter = view->filters.text[PANEL_VALUES];
    compared_values compared;
    find_compared_values(model, view, &compared);

    // those that the filter lets through
    int listed[SIGNALS_AT_MOST], count = 0;
    for (int i = 0; i < signal_count; i++) {
        if (is_listed(view, row, i)) {
            listed[count++] = i;
        }
    }

    // as many as there is room for, from the line that it is scrolled to
    const area inside = area_inside(a);
    const int first = layout_keep_scroll(lay, PANEL_VALUES, count - inside.height);
    layout_add_hit(lay, (hit_area){.panel = PANEL_VALUES, .area = a});
    char title[LINE_TEXT + 64];
    snprintf(title, sizeof title, "values%s", compared.name);
    if (filter[0] != '\0') {
        text_add(title, sizeof title, " /%s", filter);
    }
    if (count > inside.height) {
        text_add(title, sizeof title, ", %d-%d of %d", first + 1, first + inside.height,
                 count);
    }
    area_frame(s, a, INK_FRAME, title);
    const value_columns columns = value_columns_for(inside.width, compared.row != NULL);
    for (int i = first; i < count && i - first < inside.height; i++) {
        draw_value(s, area_row(inside, i - first), listed[i], row, compared.row, columns);
    }
}

const panel values_panel = {.name = "values", .draw = draw_values, .wheel = WHEEL_LINES};

// --- statistics ------------------------------------------------------------------------
// The panel of statistics: what the signals of the panes come to between the mark and the
// cursor, or in the visible part of the run.

enum { SIGNAL_ROWS = 3 };

// Whether a signal is among those already found.
static bool has_signal(const int *signals, int count, int signal)
{
    for (int i = 0; i < count; i++) {
        if (signals[i] == signal) {
            return true;
        }
    }
    return false;
}

// The signals of the panes that are shown, those of the pane in focus first, each once;
// an expression has no difference.
static int find_signals(const explorer_model *model, const explorer_view *view,
                        int signals[PANES * PANE_SIGNALS])
{
    int count = 0;
    const int focused = panes_focused(&view->panes);
    const bool subtracts = model_subtracts(model);
    if (focused < 0) {
        return 0;
    }

    // from the pane in focus on and around
    for (int i = 0; i < PANES; i++) {
        const pane *p = &view->panes.pane[(focused + i) % PANES];
        if (!p->shown) {
            continue;
        }
        for (int k = 0; k < p->count; k++) {
            const int signal = p->signals[k];
            const bool has_values = !subtracts || !signal_is_derived(signal);
            if (has_values && !has_signal(signals, count, signal)) {
                signals[count++] = signal;
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
    } else if (length > 0) {
        snprintf(text, size, "%s s", unit);
    } else {
        snprintf(text, size, "s");
    }
}

// The three rows of a signal: its name and two rows of numbers.
static void draw_signal_statistics(screen *s, area a, int signal,
                                   const signal_statistics *x)
{
    enum { UNITS = 8, WIDE = 40, MEAN_AT = 28 }; // cells
    const signal_info *info = &signal_table[signal];
    const area first = area_row(a, 1), second = area_row(a, 2);
    area_text(s, a, INK_TITLE, info->name);
    if (info->unit[0] != '\0') {
        area_print(s, area_right(a, a.width - UNITS), INK_DIM, "%8s", info->unit);
    }
    area_print(s, first, INK_TEXT, " min %-9s max %s", draw_number(x->minimum).text,
               draw_number(x->maximum).text);

    // a state has no mean and no integral, one that is on or off the time it is on
    const number_text mean = draw_number(x->mean), integral = draw_number(x->integral);
    if (signal_is_state(signal)) {
        if (x->maximum <= 1) {
            area_print(s, second, INK_TEXT, " for %s s in all", integral.text);
        }
        return;
    }
    char unit[32];
    integral_unit(info->unit, unit, sizeof unit);
    if (a.width >= WIDE) {
        area_print(s, area_right(first, MEAN_AT), INK_TEXT, "mean %s", mean.text);
        area_print(s, second, INK_TEXT, " rms %-9s integral %s %s",
                   draw_number(x->rms).text, integral.text, unit);
    } else {
        area_print(s, second, INK_TEXT, " mean %-8s \u222b %s %s", mean.text,
                   integral.text, unit);
    }
}

// The statistics of signals between two instants, as many as there is room for.
static void draw_statistics(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area a)
{
    // between both cursors, else what is visible
    double from, to;
    const char *part = "visible part,";
    view_window(model, view, &from, &to);
    if (view->mark.set) {
        from = fmin(view->mark.time, model->session.now);
        to = fmax(view->mark.time, model->session.now);
        part = "mark and cursor,";
    }
    const area inside = area_inside(a), below = area_below(inside, 1);
    const char *difference = model_subtracts(model) ? "minus baseline, " : "";
    area_frame(s, a, INK_FRAME, "statistics (m sets the mark)");
    layout_add_hit(lay, (hit_area){.panel = PANEL_STATISTICS, .area = a});
    area_print(s, inside, INK_DIM, "%s%s %.5g to %.5g s", difference, part, from, to);

    // as many signals as there is room for, from the one that it is scrolled to
    int signals[PANES * PANE_SIGNALS];
    const int count = find_signals(model, view, signals);
    const int most = below.height / SIGNAL_ROWS;
    const int first = layout_keep_scroll(lay, PANEL_STATISTICS, count - most);
    for (int i = first; i < count && i - first < most; i++) {
        const signal_statistics x =
            trace_statistics(model_run(model, 0).trace, signals[i], from, to);
        draw_signal_statistics(s, area_below(below, SIGNAL_ROWS * (i - first)),
                               signals[i], &x);
    }
}

const panel statistics_panel = {.name = "statistics",
                                .draw = draw_statistics,
                                .wheel = 1};

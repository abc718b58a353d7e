// Recorded runs as the layers of a figure: series with located peaks, marks, stretches,
// impulses.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/page/text.h"
#include "render/plot/axis.h"
#include "render/plot/trace_plot.h"
#include "src/base/csv_units.h"
#include "src/base/numbers.h"
#include "src/run/trace.h"

// over the length of measured data: what their times can lie after the run's begin
#define LONGEST_RUN 10

// ==== what happened

enum {
    TRACE_MARKS = 19
}; // most of a figure: the first pulse and 16 actions of the script

// What the script did at an event, "voltage 2 V"; NULL if the event is no action.
static char *action_label(const scenario *s, const event *e)
{
    if (e->kind == EVENT_PUSH) {
        return text_printf("push %.3g\u2009N·s", e->impulse);
    }

    // any other event but a change of a parameter has no label
    if (e->kind != EVENT_CHANGE || e->index < 0 || e->index >= s->action_count) {
        return NULL;
    }

    const action *a = &s->actions[e->index];
    char value[128], path[ACTION_PATH];
    action_format_value(a, value, sizeof value);
    g_autofree char *unit = text_unit(parameter_table[a->parameter].unit);

    // the parameter's last name and its value with its unit
    const char *name = strchr(action_path(a, path), '.') + 1;
    return text_printf("%s %s\u2009%s", name, value, unit);
}

static void add_mark(GArray *marks, figure_mark mark)
{
    g_array_append_val(marks, mark);
}

// The label of a controller's mode: "force mode", or "mode 2" if it has no name.
static const char *mode_label(owned_figure *o, const scenario *s, double mode)
{
    const char *name = trace_mode_name(s, (int)mode);
    if (name == NULL) {
        return owned_figure_printf(o, "mode %g", mode);
    }
    g_autofree char *escaped = text_escape(name);
    return owned_figure_printf(o, "%s mode", escaped);
}

// Adds a mark with the mode's name at each row where the controller goes over to another
// mode.
static void mark_modes(owned_figure *o, GArray *marks, const trace_run *run)
{
    const trace *rows = &run->result->trace;
    double mode = (double)NAN;

    // rows between samples may have no mode: each is compared with the last one that has
    for (size_t i = 0; i < rows->row_count; i++) {
        double now = rows->rows[i].controller_mode;
        if (isfinite(now) && isfinite(mode) && now != mode && marks->len < TRACE_MARKS) {
            add_mark(marks, (figure_mark){.x = rows->rows[i].time,
                                          .label = mode_label(o, run->scenario, now),
                                          .onwards = true});
        }
        if (isfinite(now)) {
            mode = now;
        }
    }
}

// Adds marks at contact, peak and release of the first pulse, and at the actions of the
// scenario. The peak's mark has a point if the first panel shows the force.
static void mark_contact(owned_figure *o, GArray *marks, const trace_run *run)
{
    const trace *rows = &run->result->trace;
    const summary *m = &run->result->summary;
    const double from = m->first_contact_s, peak = m->first_pulse_peak_N;

    // the first pulse
    if (isfinite(from)) {
        add_mark(marks, (figure_mark){.x = from, .label = "contact"});
    }
    if (isfinite(m->first_pulse_time_to_peak_s)) {
        g_autofree char *force = text_quantity(peak, 3, "N");
        add_mark(marks,
                 (figure_mark){.x = from + m->first_pulse_time_to_peak_s,
                               .label = owned_figure_printf(o, "peak %s", force),
                               .pointed = strcmp(o->panels[0].y.name, "force") == 0,
                               .y = peak});
    }
    if (isfinite(m->first_pulse_s)) {
        add_mark(marks, (figure_mark){.x = from + m->first_pulse_s, .label = "release"});
    }

    // actions of the script
    for (size_t i = 0; i < rows->event_count && marks->len < TRACE_MARKS; i++) {
        char *label = action_label(run->scenario, &rows->events[i]);
        if (label != NULL) {
            add_mark(marks, (figure_mark){.x = rows->events[i].time,
                                          .label = owned_figure_keep(o, label)});
        }
    }
}

// Adds the marks of a run: the modes of its controller, or if it has none, contact and
// actions.
void trace_mark_events(owned_figure *o, const trace_run *run)
{
    GArray *marks = g_array_new(FALSE, FALSE, sizeof(figure_mark));

    if (run->scenario->parameters.control.law != LAW_NONE) {
        mark_modes(o, marks, run);
    }
    if (marks->len == 0) {
        mark_contact(o, marks, run);
    }
    o->figure.mark_count = (int)marks->len;
    o->figure.marks = owned_figure_keep(o, g_array_free(marks, FALSE));
}

// Adds the shaded intervals of a trace: those in contact, or with `modes` those in the
// controller's mode 1. Each ends at the first row after it.
void trace_shade(owned_figure *o, const trace *rows, bool modes)
{
    GArray *found = g_array_new(FALSE, FALSE, sizeof(figure_interval));
    bool open = false;

    // an interval begins at its first row, and every further row moves its end
    for (size_t i = 0; i < rows->row_count; i++) {
        const sample *row = &rows->rows[i];
        bool now = row->contact > 0.5;
        if (modes) {
            now = row->controller_mode == 1;
        }
        if (now && !open) {
            const figure_interval begun = {row->time, row->time};
            g_array_append_val(found, begun);
        } else if (open) {
            g_array_index(found, figure_interval, found->len - 1).to = row->time;
        }
        open = now;
    }
    o->figure.interval_count = (int)found->len;
    o->figure.intervals = owned_figure_keep(o, g_array_free(found, FALSE));
}

// The impulses of a trace, one for each impact; *count becomes their number.
figure_impulse *trace_impulses(const trace *rows, int *count, owned_figure *o)
{
    GArray *found = g_array_new(FALSE, FALSE, sizeof(figure_impulse));
    for (size_t i = 0; i < rows->event_count; i++) {
        if (rows->events[i].kind == EVENT_IMPACT) {
            const figure_impulse impact = {rows->events[i].time, rows->events[i].impulse};
            g_array_append_val(found, impact);
        }
    }
    *count = (int)found->len;
    return owned_figure_keep(o, g_array_free(found, FALSE));
}

// ==== series

bool trace_shows(const trace_run *run, const trace_panel *panel, int index)
{
    bool twin = panel->signals[1] != NULL &&
                signal_table[index].body == BODY_FIRST_LINK &&
                trace_hub_is_first_link(run->scenario);
    return !twin && !(run->points && !trace_has(&run->result->trace, index));
}

enum { PEAKS = 2 };

// Inserts the peaks of the first pulse and of the whole run between the rows of the
// force. They lie between rows, and without them the mark of a peak would stand above the
// curve.
static void add_peaks(figure_series *s, const summary *m, owned_figure *o)
{
    // the whole run's peak counts only if it comes after that of the first pulse
    const double first = m->first_contact_s + m->first_pulse_time_to_peak_s;
    const double whole = m->first_contact_s + m->time_to_peak_s;
    const double at[PEAKS] = {first, whole};
    const double height[PEAKS] = {m->first_pulse_peak_N, m->peak_force_N};
    const int peaks = whole <= first ? 1 : PEAKS;

    // each row, and before it the peaks since the row before
    double *x = owned_figure_numbers(o, s->count + PEAKS);
    double *y = owned_figure_numbers(o, s->count + PEAKS);
    size_t out = 0;
    for (size_t i = 0; i < s->count; i++) {
        for (int k = 0; k < peaks && i > 0; k++) {
            if (at[k] > series_x(s, i - 1) && at[k] < series_x(s, i) &&
                isfinite(height[k])) {
                x[out] = at[k];
                y[out++] = height[k];
            }
        }
        x[out] = series_x(s, i);
        y[out++] = series_y(s, i);
    }

    // the series uses the copy
    s->x = x;
    s->y = y;
    s->count = out;
    s->stride = 0;
}

figure_series trace_series_over(const trace_run *run, int index, int over, double from,
                                double to, owned_figure *o)
{
    const trace *rows = &run->result->trace;
    const signal_info *signal = &signal_table[index];
    figure_series s = {signal->name, .colour = signal->colour, .style = signal->style};
    double *x = owned_figure_numbers(o, rows->row_count);
    double *y = owned_figure_numbers(o, rows->row_count);
    for (size_t i = 0; i < rows->row_count; i++) {
        const sample *row = &rows->rows[i];
        if (row->time >= from && row->time <= to) {
            x[s.count] = signal_value(row, over);
            y[s.count++] = signal_value(row, index);
        }
    }
    s.x = x;
    s.y = y;
    return s;
}

// The series of a signal. It points into the trace's rows; only the force is copied, with
// its peaks.
figure_series trace_series(const trace_run *run, int index, owned_figure *o)
{
    const trace *rows = &run->result->trace;
    if (signal_is_derived(index)) {
        return trace_series_over(run, index, SIGNAL_INDEX(time), -HUGE_VAL, HUGE_VAL, o);
    }
    const signal_info *signal = &signal_table[index];
    const char *base = (const char *)rows->rows;
    figure_series s = {signal->name, .count = rows->row_count, .stride = sizeof(sample),
                       .colour = signal->colour, .style = signal->style};

    // without rows there are no addresses
    if (base != NULL) {
        s.x = (const double *)(base + offsetof(sample, time));
        s.y = (const double *)(base + signal->offset);
    }
    if (index == SIGNAL_INDEX(force) && !run->points && s.count > 0) {
        add_peaks(&s, &run->result->summary, o);
    }
    return s;
}

double trace_value(const trace *t, int index, double time, size_t side)
{
    const size_t last = t->row_count;
    if (last == 0 || time < t->rows[0].time || time > t->rows[last - 1].time) {
        return (double)NAN;
    }
    const sample there = trace_sample_at(t, time, side);
    return signal_value(&there, index);
}

// The series of the difference of a signal between two traces, at the rows of the first.
figure_series trace_difference(const trace *of, const trace *less, int index,
                               owned_figure *o)
{
    double *x = owned_figure_numbers(o, of->row_count + 1);
    double *y = owned_figure_numbers(o, of->row_count + 1);
    for (size_t i = 0; i < of->row_count; i++) {
        x[i] = of->rows[i].time;
        y[i] = signal_value(&of->rows[i], index) -
               trace_value(less, index, x[i], trace_side(of, i));
    }
    return (figure_series){.x = x, .y = y, .count = of->row_count};
}

// ==== measured data

// The first panel whose signal data have, or the number of panels.
static int measured_panel(const trace_figure *t, const trace *data)
{
    const int count = t->drawn->figure.panel_count;
    int panel = 0;
    while (panel < count && !trace_has(data, signal_index(t->panels[panel].signals[0]))) {
        panel++;
    }
    return panel;
}

// The points of data less a run; of runs side by side each has its colour and a form.
static void add_residual(const trace_figure *t, int panel, const trace *data, int index,
                         const trace_run *run)
{
    enum { FORMS = MARKER_DIAMOND };
    figure_series *s =
        owned_figure_add(t->drawn, panel,
                         trace_difference(data, &run->result->trace, index, t->drawn));
    s->name = "residual";
    s->colour = SLOT_BLACK;
    s->marker = MARKER_CIRCLE;
    s->no_line = true;
    if (run->rank > 0) {
        s->name = owned_figure_printf(t->drawn, "residual %s", run->name);
        s->run = run->rank;
        s->marker = MARKER_CIRCLE + (run->rank - 1) % FORMS;
    }
}

void trace_add_residuals(const trace_figure *t)
{
    const trace_run *measured = &t->runs[t->run_count - 1];
    const int last = t->drawn->figure.panel_count;
    if (!measured->points || last == FIGURE_PANELS) {
        return;
    }
    const trace *data = &measured->result->trace;
    const int panel = measured_panel(t, data);
    if (panel == last) {
        return;
    }

    // a panel behind the others
    const int index = signal_index(t->panels[panel].signals[0]);
    for (int i = 0; i < t->run_count; i++) {
        const trace_run *run = &t->runs[i];
        if (!run->points && (i == 0 || run->rank > 0)) {
            add_residual(t, last, data, index, run);
        }
    }
    t->drawn->panels[last].y =
        (figure_axis){"residual", "Residual", signal_table[index].unit, "Δ",
                      .with_zero = true};
    t->drawn->panels[last].weight = 0.6;
    t->drawn->figure.panel_count++;
}

// The signal that a column of measured data stands for: the signal of its name, or the
// first one shown with the unit in its heading; -1 if there is none.
static int signal_of(const csv_table *table, const char *column,
                     const trace_panel *panels, int count)
{
    const int named = signal_find(column), at = csv_table_find(table, column);
    if (named >= 0 || at < 0) {
        return named;
    }

    // the first signal in whose unit it can be had
    char unit[UNIT_TEXT];
    const bool said = csv_table_unit(table, at, unit);
    for (int i = 0; said && i < count; i++) {
        int index = signal_find(panels[i].signals[0]);
        if (index > 0 && csv_unit_factor(unit, signal_table[index].unit) != 0) {
            return index;
        }
    }
    return -1;
}

// Reads a table of measured data: one column of it, or all that are signals, with its
// times shifted [s]. *name becomes its name in the legend.
status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name,
                           fault *f)
{
    csv_table table;
    trace_init(t, 0);
    *name = NULL;
    TRY(csv_table_read(&table, path, 1, f));

    // named by its file
    g_autofree char *file = g_path_get_basename(path);
    if (column != NULL) {
        *name = text_printf("%s: %s", file, column);
    } else {
        *name = g_strdup(file);
    }

    // its rows, of one column or of all that are signals
    int signal = 0;
    if (column != NULL) {
        signal = signal_of(&table, column, panels, panel_count);
    }
    status code;
    if (column == NULL || (signal > 0 && csv_table_find(&table, column) >= 0)) {
        code = measured_rows(t, &table, 0, column, signal, 0, f);
    } else {
        code = fault_set(
            f, STATUS_BAD_ARGUMENT,
            "%s:%d: there is no column '%s' with the unit of a signal that is shown",
            path, table.headings_line, column);
    }
    csv_table_finish(&table);

    // a clock that has nothing to do with the run's begins at 0
    if (code == STATUS_OK) {
        const double first = t->rows[0].time, last = t->rows[t->row_count - 1].time;
        const double most = LONGEST_RUN * (last - first);
        if (sample_clock_is_foreign(t->row_count, first + shift, last + shift, most)) {
            shift -= first;
        }
    }

    // the data's clock differed by this from the run's
    for (size_t i = 0; i < t->row_count; i++) {
        t->rows[i].time += shift;
    }
    return code;
}

// Ends a text at the last occurrence of a character and returns what came after it; NULL
// if the character does not occur.
static const char *cut_off(char *text, char last)
{
    char *at = strrchr(text, last);
    if (at == NULL) {
        return NULL;
    }
    *at = '\0';
    return at + 1;
}

// Reads a text that is a number and nothing else.
static bool read_shift(const char *text, double *shift)
{
    const char *rest;
    return decimal_read(text, shift, &rest) && *rest == '\0';
}

// Divides "FILE.csv:COLUMN@SHIFT" into its parts.
status overlay_read(trace *t, const char *text, const trace_panel *panels,
                    int panel_count, char **name, fault *f)
{
    g_autofree char *path = g_strdup(text);
    const char *column = NULL;
    double shift = 0;
    trace_init(t, 0);
    *name = NULL;

    // a file of that very name, or a shift and a column are cut off its end
    if (!g_file_test(text, G_FILE_TEST_EXISTS)) {
        const char *given = cut_off(path, '@');
        FAULT_IF(given != NULL && !read_shift(given, &shift), f, STATUS_BAD_ARGUMENT,
                 "'%s': '%s' is no shift in seconds, expected FILE.csv:COLUMN@SHIFT",
                 text, given);
        column = cut_off(path, ':');
    }
    return overlay_read_column(t, path, column, shift, panels, panel_count, name, f);
}

// The panes of curves over time.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ui/terminal/pictures.h"

// --- titles ----------------------------------------------------------------------------

// The lines and colours of a pane's signals: those of the signal table, but no two the
// same.
typedef struct pane_look {
    ink colour[PANE_SIGNALS];
    line_style style[PANE_SIGNALS];
} pane_look;

// Whether a slot's colour is that of one of the first curves of a pane, as the terminal
// shows them.
static bool colour_is_taken(const explorer_view *view, const pane_look *look, int curves,
                            int slot)
{
    const ink wanted = (ink)(INK_SERIES_0 + slot);
    const looks *l = &view->looks;
    for (int k = 0; k < curves; k++) {
        if (inks_look_alike(l->theme, l->depth, look->colour[k], wanted)) {
            return true;
        }
    }
    return false;
}

// The slot's colour, or the first behind it that no earlier curve of the pane has.
static int free_colour(const explorer_view *view, const pane_look *look, int curves,
                       int slot)
{
    enum { COLOURS = 8 };
    for (int i = 0; i < COLOURS; i++) {
        const int other = (slot + i) % COLOURS;
        if (!colour_is_taken(view, look, curves, other)) {
            return other;
        }
    }
    return slot;
}

// The style, or the plainest that no earlier curve of the pane has; of more curves than
// there are styles the last one.
static line_style free_line_style(const pane_look *look, int curves, line_style style)
{
    static const line_style plain_first[] = {LINE_SOLID, LINE_DASHED, LINE_DOTTED,
                                             LINE_DASH_DOT};
    enum { STYLES = sizeof plain_first / sizeof plain_first[0] };
    bool taken[STYLES] = {false};
    for (int k = 0; k < curves; k++) {
        taken[look->style[k]] = true;
    }
    for (int i = 0; i < STYLES && taken[style]; i++) {
        style = plain_first[i];
    }
    return style;
}

// Chooses a line and a colour for each signal of a pane, the first ones first.
static pane_look pane_look_of(const explorer_view *view, const pane *p)
{
    pane_look look;
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        const int slot = free_colour(view, &look, k, info->colour);
        look.colour[k] = (ink)(INK_SERIES_0 + slot);
        look.style[k] = free_line_style(&look, k, info->style);
    }
    return look;
}

// Whether a signal of a pane is only in its legend.
static bool is_hidden(const pane *p, int k)
{
    return (p->hidden >> k & 1) != 0;
}

// How a legend says what its curves are, most words first.
typedef enum legend { LEGEND_NAMES, LEGEND_BRIEF, LEGEND_TIGHT, LEGEND_BARE } legend;

// The value of a signal at the cursor, of the first run that a pane shows.
static double value_at_cursor(const explorer_model *model, const pane *p, int signal)
{
    shown_run runs[SHOWN_RUNS];
    const trace *t = model_run(model, 0).trace;
    if (model_runs(model, p, runs) > 0) {
        t = runs[0].trace;
    }
    return signal_value(&t->rows[model_row(model, t)], signal);
}

// What a legend says of a signal's value: a mode by its name, else a number; brief ones
// have up to three digits.
static void format_legend_value(const explorer_model *model, const pane *p, int signal,
                                bool brief, char *text, size_t size)
{
    const double value = value_at_cursor(model, p, signal);
    if (signal == SIGNAL_INDEX(controller_mode) && value >= 0 &&
        value < model->modes.count) {
        law_mode_name(&model->modes, value, text, size);
        return;
    }

    // as many digits as six cells have room for
    snprintf(text, size, "%s", draw_number(value).text);
    if (brief && fabs(value) > 1e-12) {
        int length = snprintf(text, size, "%.3g", value);
        if (length > 6) {
            snprintf(text, size, "%.2g", value);
        }
    }
}

// The unit of all signals of a pane, "" if they have several.
static const char *pane_unit(const pane *p)
{
    const char *unit = signal_table[p->signals[0]].unit;
    for (int k = 1; k < p->count; k++) {
        if (strcmp(signal_table[p->signals[k]].unit, unit) != 0) {
            return "";
        }
    }
    return unit;
}

// What a legend says of a signal: its name or symbol, and its value at the cursor, padded
// so that the legend stands still.
static void write_legend(const explorer_model *model, const pane *p, int signal,
                         legend how, char *text, size_t size)
{
    const signal_info *info = &signal_table[signal];
    char value[48];
    format_legend_value(model, p, signal, how != LEGEND_NAMES, value, sizeof value);
    const bool has_own_unit = pane_unit(p)[0] == '\0' && info->unit[0] != '\0';
    switch (how) {
    case LEGEND_NAMES:
        if (has_own_unit) {
            text_add(value, sizeof value, " %s", info->unit);
        }
        snprintf(text, size, "%s %-8s", info->name, value);
        break;
    case LEGEND_BRIEF:
        snprintf(text, size, "%s %-6s", info->name, value);
        break;
    case LEGEND_TIGHT:
        snprintf(text, size, "%s %-6s", info->ascii, value);
        break;
    case LEGEND_BARE:
        snprintf(text, size, "%s ", info->ascii);
        break;
    }
}

// Whether a legend has a signal of a pane: what is hidden goes where room is short.
static bool legend_has(const pane *p, int k, legend how)
{
    return !is_hidden(p, k) || how == LEGEND_NAMES;
}

// The cells that a legend takes.
static int legend_width(const explorer_model *model, const pane *p, legend how)
{
    int width = -1;
    for (int k = 0; k < p->count; k++) {
        if (legend_has(p, k, how)) {
            char text[128];
            write_legend(model, p, p->signals[k], how, text, sizeof text);
            width += 2 + (int)strlen(text) + 1;
        }
    }
    return width;
}

// Draws a legend: of each signal its line, its name and its value.
static void draw_legend(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, int index, legend how, area a)
{
    static const uint32_t lines[] = {[LINE_SOLID] = GLYPH_LINE,
                                     [LINE_DASHED] = GLYPH_DASHES,
                                     [LINE_DOTTED] = GLYPH_DOTS,
                                     [LINE_DASH_DOT] = GLYPH_HALF_LINE};
    const pane *p = &view->panes.pane[index];
    const pane_look look = pane_look_of(view, p);
    if (a.width < 1) {
        return;
    }
    for (int k = 0; k < p->count; k++) {
        if (!legend_has(p, k, how)) {
            continue;
        }
        char text[128];
        write_legend(model, p, p->signals[k], how, text, sizeof text);
        const int length = 2 + (int)strlen(text);
        ink shade = model_shows_others(model) ? run_ink(1) : look.colour[k];
        if (is_hidden(p, k)) {
            shade = INK_FRAME;
        }
        const uint32_t line = a.width > 0 ? lines[look.style[k]] : ' ';
        screen_put(s, a.x, a.y, line, shade);
        area_text(s, area_right(a, 2), shade, text);

        // a click hides the signal
        const area place = {a.x, a.y, length, 1};
        const int number = index * PANE_SIGNALS + k;
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LEGEND, number, place});
        a = area_right(a, length + 1);
    }
}

// The number and the unit of a pane, where its labels are.
static void draw_pane_number(const explorer_view *view, screen *s, int index, area a)
{
    const bool focused = index == panes_focused(&view->panes);
    const char *unit = pane_unit(&view->panes.pane[index]);
    screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "%3d%*s", index + 1, LABEL_WIDTH - 3,
                 unit);
    if (focused) {
        screen_print(s, a.x, a.y, 3, INK_TITLE, "\u25b8%-2d", index + 1);
    } else {
        screen_print(s, a.x, a.y, 3, INK_DIM, " %-2d", index + 1);
    }
}

// Words at the right end of a title, if it leaves `least` cells and more; returns the
// area without them.
static area draw_end_of_title(screen *s, area a, int least, int cells, ink shade,
                              const char *words)
{
    if (a.width <= least) {
        return a;
    }
    a.width -= cells + 1;
    screen_text(s, a.x + a.width + 1, a.y, cells, shade, words);
    return a;
}

// The pane's number, its unit, its signals with their values at the cursor as far as
// there is room, and the mode of its axis, in the first row of the pane's area.
static void draw_pane_title(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, int index, area a)
{
    const pane *p = &view->panes.pane[index];
    draw_pane_number(view, s, index, a);

    // what the axis does, and what is subtracted
    area rest = area_right(area_row(a, 0), LABEL_WIDTH + 1);
    if (p->is_fixed) {
        rest = draw_end_of_title(s, rest, 30, 5, INK_DIM, "fixed");
    }
    if (p->view == VIEW_RESIDUAL) {
        rest = draw_end_of_title(s, rest, 40, 14, INK_EVENT, "data minus run");
    } else if (model_subtracts(model) && pane_has_amounts(p)) {
        rest = draw_end_of_title(s, rest, 40, 14, INK_EVENT, "minus baseline");
    }

    // what is not over time has no values at the cursor
    const char *name = signal_table[p->signals[0]].name;
    if (p->view == VIEW_PHASE) {
        area_print(s, rest, INK_SERIES_0, "%s over %s", name,
                   signal_table[p->signals[1]].name);
        return;
    }
    if (!pane_is_over_time(p)) {
        area_print(s, rest, INK_SERIES_0, "amplitudes of %s", name);
        return;
    }

    // as many words as fit
    legend how = LEGEND_NAMES;
    while (how < LEGEND_BARE && legend_width(model, p, how) > rest.width) {
        how++;
    }
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_VIEW, index, area_row(a, 0)});
    draw_legend(model, view, lay, s, index, how, rest);
}

// --- the panes -------------------------------------------------------------------------

// Dots far apart: the mark of measured data.
enum { MEASURED_PATTERN = 0x1111 };

// How a run's curves differ from those of others: beside others it has one colour, and
// the lines of its curves tell the signals.
static void set_look(const explorer_model *model, plot_frame *f, const pane *p,
                     const shown_run *run, const pane_look *look, int k)
{
    const int rank = shown_run_rank(run);
    f->pattern = style_pattern(look->style[k]);
    f->colour = look->colour[k];
    if (rank > 0 && model_shows_others(model)) {
        f->colour = run_ink(rank);
    } else if (run->kind == SHOWN_SWEPT && run->index == model->sweep.selected) {
        f->colour = INK_OTHER;
    } else if (run->kind == SHOWN_SWEPT) {
        f->colour = INK_FRAME;
    } else if (run->kind == SHOWN_MEASURED && p->view != VIEW_RESIDUAL) {
        f->colour = INK_TEXT;
        f->pattern = MEASURED_PATTERN;
    }
}

// Whether a run of a sweep is one of those whose curves are drawn: of many a few, evenly
// spread, and the chosen one.
static bool is_in_fan(const lab_sweep *sweep, int index)
{
    enum { FAN = 5 };
    const int stride = (sweep->count + FAN - 2) / (FAN - 1);
    return sweep->count <= FAN || index == sweep->selected || index % stride == 0 ||
           index == sweep->count - 1;
}

// A curve of a run: of the present one (`is_present`) what was seen of it, and after a
// change dimly what is to come.
static void draw_curve(const explorer_model *model, plot_frame f, const trace *t,
                       int signal, const double *pairs, bool is_present)
{
    const session *e = &model->session;
    const ink bright = f.colour;
    double until = f.to;
    if (is_present) {
        if (e->input_count > 0) {
            f.colour = INK_FRAME;
            plot_frame_signal(&f, t, signal, f.to, pairs);
        }
        until = e->seen;
    }
    f.colour = bright;
    plot_frame_signal(&f, t, signal, until, pairs);
}

// The curves of a run in a pane, by its number among those that the pane shows.
static void draw_run_curves(const explorer_model *model, const explorer_view *view,
                            plot_frame f, const pane *p, const shown_run *run, int number)
{
    const pane_look look = pane_look_of(view, p);
    const bool is_present = number == 0 && run->kind != SHOWN_MEASURED;
    if (run->kind == SHOWN_SWEPT && !is_in_fan(&model->sweep, run->index)) {
        return;
    }

    // of a sweep's runs a pane shows what it is about
    const int count = run->kind == SHOWN_SWEPT ? 1 : p->count;
    for (int k = 0; k < count; k++) {
        if (is_hidden(p, k)) {
            continue;
        }
        const int signal = shown_signal(run, p, k);
        const double *pairs = extremes_pairs(&model->extremes[number], run, signal);
        set_look(model, &f, p, run, &look, k);
        draw_curve(model, f, run->trace, signal, pairs, is_present);
    }
}

// The setpoints and limits of what a pane shows.
static void draw_levels(const explorer_model *model, const plot_frame *f, screen *s,
                        const pane *p)
{
    shown_level levels[SHOWN_LEVELS];
    const int count = model_levels(model, p, levels);
    for (int i = 0; i < count; i++) {
        plot_frame_level(f, s, levels[i].value, levels[i].name);
    }
}

// What the curves of a pane over time are compared with: setpoints, limits, tolerances.
static void draw_bounds(const explorer_model *model, const plot_frame *f, screen *s,
                        const pane *p)
{
    if (p->view != VIEW_TIME) {
        return;
    }
    if (!model_subtracts(model)) {
        draw_levels(model, f, s, p);
        return;
    }
    const double tolerance = model->difference.tolerance;
    if (tolerance > 0 && pane_has_amounts(p)) {
        plot_frame_level(f, s, tolerance, "tolerance");
        plot_frame_level(f, s, -tolerance, "tolerance");
    }
}

// Impulses of the present run over its force, an arrow with its number each: they are no
// force, and have no place on its axis. One that is a thousandth of the largest has none.
static void draw_impulses(const explorer_model *model, const plot_frame *f, screen *s)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    double largest = 0;
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].kind == EVENT_IMPACT) {
            largest = fmax(largest, t->events[i].impulse);
        }
    }
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const event *v = &t->events[i];
        char text[32];
        if (v->kind != EVENT_IMPACT || v->impulse < 1e-3 * largest) {
            continue;
        }

        // the largest with its unit where that has room
        snprintf(text, sizeof text, "%.3g mN s", 1e3 * v->impulse);
        if (v->impulse < largest || !plot_frame_arrow(f, s, v->time, text)) {
            text[strcspn(text, " ")] = '\0';
            plot_frame_arrow(f, s, v->time, text);
        }
    }
}

// Why a pane shows no curve.
static const char *reason_of_emptiness(const explorer_model *model, const pane *p)
{
    if (!pane_is_over_time(p)) {
        return "nothing to see yet";
    }
    if (model_subtracts(model) && pane_is_derived(p)) {
        return "an expression has no difference";
    }
    if (p->view == VIEW_RESIDUAL) {
        return "no measured data (:data FILE.csv)";
    }
    return "this run has no such values";
}

// The curves of a pane over time, the present run over those for comparison; limits and
// cursors behind all of them.
static void draw_pane_curves(const explorer_model *model, const explorer_view *view,
                             screen *s, const pane *p, plot_frame *f)
{
    shown_run runs[SHOWN_RUNS];
    plot_frame_open(view, f);
    for (int i = model_runs(model, p, runs) - 1; i >= 0; i--) {
        draw_run_curves(model, view, *f, p, &runs[i], i);
    }
    if (p->signals[0] == SIGNAL_INDEX(force) && p->view == VIEW_TIME &&
        !model_subtracts(model)) {
        draw_impulses(model, f, s);
    }
    draw_bounds(model, f, s, p);
    if (view->mark.set) {
        plot_frame_cursor(f, s, view->mark.time);
    }
    plot_frame_cursor(f, s, model->session.now);
    if (f->picture != NULL) {
        picture_end(s, f->picture);
    }
}

// A pane: its title in the first row, below it an axis of values and what it shows.
static void draw_pane(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, int index, area a)
{
    const pane *p = &view->panes.pane[index];
    const area below = area_below(a, 1), inside = area_right(below, LABEL_WIDTH + 1);
    const area labels = {below.x, below.y, LABEL_WIDTH + 1, below.height};
    const bool over_time = pane_is_over_time(p);
    value_range axis;
    bool has_values;
    draw_pane_title(model, view, lay, s, index, a);

    // what there is to see, or why there is nothing
    if (over_time) {
        has_values = view_pane_axis(model, view, index, &axis);
    } else {
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_VIEW, index, inside});
        has_values = draw_pane_view(model, view, s, p, inside, &axis);
    }
    if (!has_values) {
        area_text(s, inside, INK_DIM, reason_of_emptiness(model, p));
        return;
    }
    draw_value_axis(s, labels, axis);

    // another axis than time: nothing to click at, nothing to scale
    if (!over_time) {
        return;
    }
    plot_frame f = {.canvas = {s, inside.x, inside.y, inside.width, inside.height},
                    .axis = axis};
    view_window(model, view, &f.from, &f.to);
    lay->axes[index] = axis;
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_PANE, index, inside});
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LABELS, index, labels});
    draw_pane_curves(model, view, s, p, &f);
}

enum { LEAST_PANE = 3 }; // rows

// How many panes are shown.
static int count_shown_panes(const pane_set *panes)
{
    int count = 0;
    for (int i = 0; i < PANES; i++) {
        if (panes->pane[i].shown) {
            count++;
        }
    }
    return count;
}

// The panes that are drawn, `most` of those shown: where that is not all, that of force
// and those from the focused one on, so that each can be reached. Returns how many.
static int choose_panes(const pane_set *set, int most, int chosen[PANES])
{
    const int shown = count_shown_panes(set);
    const bool keeps_force = most > 1 && set->pane[0].shown;
    const int first = shown > most ? panes_focused(set) : 0;
    int count = 0;
    if (keeps_force) {
        chosen[count++] = 0;
    }
    for (int i = 0; i < PANES && count < most; i++) {
        const int index = (first + i) % PANES;
        const bool taken = keeps_force && index == 0;
        if (set->pane[index].shown && !taken) {
            chosen[count++] = index;
        }
    }
    return count;
}

// Draws panes one below the other, as many as have room. That of force has half of the
// rows, or more where the others have a few each; they share what is left, rounded up.
static void draw_panes(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, area a, int most)
{
    enum { WANTED = 12 }; // rows of the force
    int chosen[PANES];
    const int count = choose_panes(&view->panes, most, chosen);
    int force = a.height - LEAST_PANE * (count - 1);
    if (force > WANTED) {
        force = WANTED;
    }
    if (force < (a.height + 1) / 2) {
        force = (a.height + 1) / 2;
    }
    for (int i = 0; i < count; i++) {
        const int left = count - i;
        int height = (a.height + left - 1) / left;
        if (chosen[i] == 0 && count > 1) {
            height = force;
        }
        draw_pane(model, view, lay, s, chosen[i], (area){a.x, a.y, a.width, height});
        a = area_below(a, height);
    }
}

// The panes with the time axis and the lanes below them.
static void draw_curves(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area a)
{
    enum { LEAST_PLOT = 9, LOW = 12 }; // width; rows that have few for a time axis

    // from below: the lanes, the time axis, the panes
    const int lanes_height = lanes_rows(model, a.height);
    const int axis_height = a.height < LOW ? 1 : 2;
    const int panes_height = a.height - lanes_height - axis_height;
    const area panes = {a.x, a.y, a.width, panes_height};
    const area axis = {a.x, a.y + panes_height, a.width, axis_height};
    const area lanes = {a.x, axis.y + axis_height, a.width, lanes_height};

    // of two and more that of force has half of the rows
    int most = panes_height / LEAST_PANE;
    if (view->panes.pane[0].shown && most > 1) {
        most = 1 + panes_height / 2 / LEAST_PANE;
    }
    if (view->panes.alone) {
        most = 1;
    }
    const area plot = area_right(panes, LABEL_WIDTH + 1);
    if (count_shown_panes(&view->panes) < 1 || most < 1 || plot.width < LEAST_PLOT) {
        area_text(s, a, INK_DIM, "1 to 9 show curves");
        return;
    }

    // for the mouse; its parts lie over that
    lay->plot = (area){plot.x, plot.y, plot.width, panes_height + axis_height};
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_BODY, 0, plot});
    draw_panes(model, view, lay, s, panes, most);
    const area marked = draw_time_axis(model, view, s, axis);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_TIME_AXIS, 0, marked});
    draw_lanes(model, view, lay, s, lanes);
}

const panel curves_panel = {.name = "curves", .draw = draw_curves, .point = curves_point};

// The panes of curves over time.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/controller.h"
#include "ui/terminal/ink_colours.h"

// --- titles -----------------------------------------------------------------------------------

// The lines and colours of a pane's signals: those of the signal table, but no two the same.
typedef struct pane_look {
    ink colour[PANE_SIGNALS];
    line_style style[PANE_SIGNALS];
} pane_look;

// Whether a slot's colour is that of one of the first curves of a pane, as the terminal shows them.
static bool colour_is_taken(const explorer_state *st, const pane_look *look, int curves, int slot)
{
    const ink wanted = (ink)(INK_SERIES_0 + slot);
    for (int k = 0; k < curves; k++) {
        if (inks_look_alike(st->looks.theme, st->looks.shown_depth, look->colour[k], wanted)) {
            return true;
        }
    }
    return false;
}

static pane_look pane_look_of(const explorer_state *st, const pane *p)
{
    enum { COLOURS = 8, STYLES = 4 };
    static const line_style plain_first[] = {LINE_SOLID, LINE_DASHED, LINE_DOTTED, LINE_DASH_DOT};
    bool style_taken[STYLES] = {false};
    pane_look look;

    // the table's colour and line unless an earlier signal of the pane has them
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        int slot = info->colour, style = (int)info->style;
        for (int i = 0; i < COLOURS && colour_is_taken(st, &look, k, slot); i++) {
            slot = (info->colour + 1 + i) % COLOURS;
        }
        for (int i = 0; i < STYLES && style_taken[style]; i++) {
            style = (int)plain_first[i];
        }
        style_taken[style] = true;
        look.colour[k] = (ink)(INK_SERIES_0 + slot);
        look.style[k] = (line_style)style;
    }
    return look;
}

// How a legend says what its curves are, most words first.
typedef enum legend { LEGEND_NAMES, LEGEND_SYMBOLS, LEGEND_TIGHT, LEGEND_BARE } legend;

// A curve's line in one character.
static uint32_t line_glyph(line_style style)
{
    static const uint32_t glyphs[] = {0x2500, 0x254c, 0x2508, 0x2574};
    return glyphs[style];
}

// What a legend says of a signal's value: a mode by its name where the law is one of ours, else a
// number; short ones have up to three digits.
static void format_value(const explorer_state *st, const pane *p, int signal, bool briefly,
                         char *text, size_t size)
{
    const trace *t =
        state_pane_run_count(st, p) > 0 ? state_pane_run(st, p, 0).trace : state_run(st, 0).trace;
    double value = signal_value(&t->rows[trace_row_at(t, st->session.now)], signal);
    const controller *law = controller_of(st->session.effective.parameters.control.law);
    bool is_mode = strcmp(signal_table[signal].name, "controller_mode") == 0;

    // fewer digits where room is short
    snprintf(text, size, "%s", draw_number(value).text);
    if (briefly && fabs(value) > 1e-12) {
        for (int digits = 3, length = 9; digits > 1 && length > 6; digits--) {
            length = snprintf(text, size, "%.*g", digits, value);
        }
    }

    // a mode by its name
    for (int i = 0; is_mode && law != NULL && law->modes != NULL && law->modes[i] != NULL; i++) {
        if (value == i) {
            snprintf(text, size, "%s", law->modes[i]);
        }
    }
}

// The unit of all signals of a pane, "" if they have several.
static const char *unit_of(const pane *p)
{
    const char *unit = signal_table[p->signals[0]].unit;
    for (int k = 1; k < p->count; k++) {
        unit = strcmp(signal_table[p->signals[k]].unit, unit) == 0 ? unit : "";
    }
    return unit;
}

// Writes a legend and returns the cells it takes; values are padded so that it stands still.
static int draw_legend(const explorer_state *st, layout *lay, screen *s, int index, legend how,
                       int x, int y, int room)
{
    const pane *p = &st->panes.pane[index];
    int start = x, end = x + room;
    const pane_look look = pane_look_of(st, p);

    // each signal: its line, its name, its value at the cursor
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        char value[48], text[128];
        format_value(st, p, p->signals[k], how == LEGEND_TIGHT, value, sizeof value);
        if (unit_of(p)[0] == '\0' && info->unit[0] != '\0' && how < LEGEND_TIGHT) {
            text_add(value, sizeof value, " %s", info->unit);
        }
        // what is hidden goes first where room is short
        if (p->hidden >> k & 1 && how >= LEGEND_SYMBOLS) {
            continue;
        }
        int width = how == LEGEND_TIGHT ? 6 : how == LEGEND_BARE ? 0 : 8;
        int length =
            snprintf(text, sizeof text, "%s %-*s", how == LEGEND_NAMES ? info->name : info->ascii,
                     width, how == LEGEND_BARE ? "" : value);
        if (room > 0) {
            const ink shade = p->hidden >> k & 1 ? INK_FRAME : look.colour[k];
            screen_put(s, x, y, x < end ? line_glyph(look.style[k]) : ' ', shade);
            screen_text(s, x + 2, y, end - x - 2, shade, text);
            layout_add_hit(lay, (hit_area){PANEL_CURVES,
                                           PART_LEGEND,
                                           index * PANE_SIGNALS + k,
                                           {x, y, 2 + length, 1}});
        }
        x += 2 + length + 1;
    }
    return x - start - 1;
}

// The pane's number, its unit, its signals with their values at the cursor as far as there is room,
// and the mode of its axis, in the first row of the pane's area.
static void draw_pane_title(const explorer_state *st, layout *lay, screen *s, int index, area a)
{
    const pane *p = &st->panes.pane[index];
    static const char *const axes[] = {"", "grows", "fixed", "calm"};
    const bool residual = p->view == VIEW_RESIDUAL;
    const bool difference =
        !residual && state_run(st, 0).kind == SHOWN_DIFFERENCE && pane_has_amounts(p);
    bool focused = index == panes_focused(&st->panes);
    int x = a.x + LABEL_WIDTH + 1, room = a.width - LABEL_WIDTH - 1;

    // number, unit, and what the axis does
    screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "%3d%*s", index + 1, LABEL_WIDTH - 3,
                 unit_of(p));
    screen_print(s, a.x, a.y, 3, focused ? INK_TITLE : INK_DIM, "%s%-2d", focused ? "\u25b8" : " ",
                 index + 1);
    if (p->scaling != AXIS_AUTO && room > 30) {
        room -= 6;
        screen_text(s, x + room + 1, a.y, 5, INK_DIM, axes[p->scaling]);
    }
    if ((difference || residual) && room > 40) {
        room -= 15;
        screen_text(s, x + room + 1, a.y, 14, INK_EVENT,
                    residual ? "data minus run" : "minus baseline");
    }

    // what is not over time has no values at the cursor
    if (p->view == VIEW_PHASE) {
        screen_print(s, x, a.y, room, INK_SERIES_0, "%s over %s", signal_table[p->signals[0]].name,
                     signal_table[p->signals[1]].name);
        return;
    }
    if (p->view == VIEW_SPECTRUM) {
        screen_print(s, x, a.y, room, INK_SERIES_0, "amplitudes of %s",
                     signal_table[p->signals[0]].name);
        return;
    }

    // as many words as fit
    legend how = LEGEND_NAMES;
    while (how < LEGEND_BARE && draw_legend(st, lay, s, index, how, x, a.y, 0) > room) {
        how++;
    }
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_VIEW, index, {a.x, a.y, a.width, 1}});
    draw_legend(st, lay, s, index, how, x, a.y, room);
}

// --- the mouse --------------------------------------------------------------------------------

// The instant at a column of the plot, kept within what is visible [s].
static double time_at(const explorer_state *st, area plot, int x)
{
    double from, to;
    state_window(st, &from, &to);
    double share = (x - plot.x + 0.5) / (plot.width > 0 ? plot.width : 1);
    return from + (to - from) * fmax(0, fmin(1, share));
}

// A turn of the wheel zooms the axis of values or of time that is under the mouse, or pans.
static bool turn_wheel(explorer_state *st, const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int direction = pointer_wheel(g->event), rows = h->area.height > 0 ? h->area.height : 1;
    const double factor = direction < 0 ? 0.8 : 1.25;
    double from, to;
    state_window(st, &from, &to);
    if (h->part == PART_LABELS) {
        act_scale_axis(st, h->index, factor, (g->event.y - h->area.y + 0.5) / rows);
    } else if (h->part == PART_TIME_AXIS ? !g->event.control : g->event.shift) {
        act_pan_by(st, 0.1 * direction * (to - from));
    } else {
        act_zoom_at(st, factor, time_at(st, h->area, g->event.x));
    }
    return true;
}

// With Control held a drag draws a box; letting go shows its instants, and its values where it has
// more than a row.
static bool draw_box(explorer_state *st, const panel_gesture *g)
{
    zoom_box *b = &st->box;
    const area a = g->hit.area;
    if (g->event.kind == POINTER_PRESS) {
        *b = (zoom_box){true, g->hit.index, g->event.x, g->event.y, g->event.x, g->event.y};
    }
    b->x1 = g->event.x < a.x ? a.x : g->event.x < a.x + a.width ? g->event.x : a.x + a.width - 1;
    b->y1 = g->event.y < a.y ? a.y : g->event.y < a.y + a.height ? g->event.y : a.y + a.height - 1;
    if (g->event.kind != POINTER_RELEASE) {
        return true;
    }
    b->held = false;
    if (b->x1 == b->x0) {
        return true;
    }
    const double t0 = time_at(st, a, b->x0), t1 = time_at(st, a, b->x1);
    const double top = (double)((b->y0 < b->y1 ? b->y0 : b->y1) - a.y) / a.height;
    const double bottom = (double)((b->y0 < b->y1 ? b->y1 : b->y0) + 1 - a.y) / a.height;
    value_range axis;
    if (b->y0 != b->y1 && state_pane_axis(st, b->pane, &axis)) {
        const double height = axis.high - axis.low;
        pane_fix_axis(&st->panes.pane[b->pane],
                      (value_range){axis.high - bottom * height, axis.high - top * height});
    }
    return act_zoom_between(st, fmin(t0, t1), fmax(t0, t1));
}

// The cursor goes where the mouse is.
static bool scrub(explorer_state *st, const panel_gesture *g)
{
    if (g->event.kind != POINTER_RELEASE) {
        act_scrub(st, time_at(st, g->hit.area, g->event.x));
    }
    return g->event.kind != POINTER_RELEASE;
}

static bool point_at_plot(explorer_state *st, const panel_gesture *g)
{
    const bool in_pane =
        g->hit.part == PART_PANE && pane_is_over_time(&st->panes.pane[g->hit.index]);
    if (g->event.kind == POINTER_PRESS) {
        st->box.held = in_pane && g->event.control;
    }
    return st->box.held ? draw_box(st, g) : scrub(st, g);
}

// The axis is dragged; a click without a drag moves the cursor.
static bool point_at_time_axis(explorer_state *st, const panel_gesture *g)
{
    const area a = g->hit.area;
    double from, to;
    state_window(st, &from, &to);
    if (g->event.kind == POINTER_DRAG) {
        act_pan_by(st, a.width > 0 ? -g->across * (to - from) / a.width : 0);
    } else if (g->event.kind == POINTER_RELEASE && !g->dragged) {
        act_scrub(st, time_at(st, a, g->event.x));
    }
    return true;
}

// A click puts the pane in focus, a drag moves its axis.
static bool point_at_labels(explorer_state *st, const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    if (g->event.kind == POINTER_PRESS) {
        st->panes.focus = h->index;
    } else if (g->event.kind == POINTER_DRAG && g->up != 0) {
        act_shift_axis(st, h->index, -(double)g->up / (h->area.height > 0 ? h->area.height : 1));
    }
    return g->event.kind != POINTER_RELEASE;
}

// On the map of the whole run the visible part moves to the mouse.
static bool point_at_map(explorer_state *st, const panel_gesture *g)
{
    const area line = g->hit.area;
    const double share = (g->event.x - line.x + 0.5) / (line.width > 0 ? line.width : 1);
    double from, to;
    state_window(st, &from, &to);
    if (g->event.kind != POINTER_RELEASE) {
        act_pan_by(st, share * st->session.effective.parameters.run.duration - (from + to) / 2);
    }
    return g->event.kind != POINTER_RELEASE;
}

// --- the panes --------------------------------------------------------------------------------
// The panes of curves over time.

// How a run's curves differ from those of others: the present one has the signals' colours and
// lines, a single pinned one their lines in one colour, several have their own lines.
static void set_look(const explorer_state *st, plot_frame *f, const pane *p, const shown_run *run,
                     const pane_look *look, int k)
{
    f->pattern = style_pattern(look->style[k]);
    f->colour = look->colour[k];
    if (st->looks.by_run && (run->kind == SHOWN_PINNED || run->kind == SHOWN_PRESENT)) {
        f->colour = run_ink(run->kind == SHOWN_PINNED ? run->index : -1);
    } else if (run->kind == SHOWN_PINNED && state_visible_pins(st) == 1) {
        f->colour = INK_OTHER;
    } else if (run->kind == SHOWN_PINNED) {
        f->pattern = run_pattern(run->index);
    } else if (run->kind == SHOWN_SWEPT) {
        f->colour = run->index == st->sweep.selected ? INK_OTHER : INK_FRAME;
    } else if (run->kind == SHOWN_BEFORE) {
        f->colour = INK_FRAME;
    } else if (run->kind == SHOWN_MEASURED && p->view != VIEW_RESIDUAL) {
        f->colour = INK_TEXT;
    }
}

// The curves of one run in a pane: 0 is the present one, as far as it was seen.
static void draw_run(const explorer_state *st, plot_frame f, const pane *p, int number)
{
    const shown_run run = state_pane_run(st, p, number);
    const pane_look look = pane_look_of(st, p);

    // of a sweep of many runs a few curves, evenly spread, and the chosen one
    enum { FAN = 5 };
    const int swept = st->sweep.count, stride = (swept + FAN - 2) / (FAN - 1);
    if (run.kind == SHOWN_SWEPT && swept > FAN && run.index != st->sweep.selected &&
        run.index % stride != 0 && run.index != swept - 1) {
        return;
    }

    // of many runs a pane shows what it is about
    const bool first_only =
        run.kind == SHOWN_SWEPT ||
        (run.kind == SHOWN_PINNED && state_visible_pins(st) > 1 && !st->looks.by_run);
    const int count = first_only && p->count > 1 ? 1 : p->count;
    for (int k = 0; k < count; k++) {
        if (p->hidden >> k & 1) {
            continue;
        }
        const double *pairs =
            extremes_pairs(&st->extremes[number], run.id, run.trace, p->signals[k]);
        set_look(st, &f, p, &run, &look, k);

        // while a value is adjusted the whole future is shown, and after a change dimly
        const bool hidden = number == 0 && run.kind != SHOWN_MEASURED && !st->session.has_ghost;
        if (hidden && st->session.input_count > 0) {
            const ink seen = f.colour;
            f.colour = INK_FRAME;
            plot_frame_signal(&f, run.trace, p->signals[k], f.to, pairs);
            f.colour = seen;
        }
        plot_frame_signal(&f, run.trace, p->signals[k], hidden ? st->session.seen : f.to, pairs);
    }
}

// The setpoints and limits of what a pane shows, as they are at the cursor.
static void draw_levels(const explorer_state *st, const plot_frame *f, screen *s, const pane *p)
{
    static const struct {
        const char *signal, *parameter;
        bool both_ways;
    } levels[] = {
        {"force", "control.force", false},
        {"force", "control.force_limit", false},
        {"command", "motor.voltage_limit", true},
        {"hub_angle", "wall.angle", false},
        {"hub_velocity", "control.speed_limit", true},
    };

    // the bound that was asked for, of its signal
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] == st->limit.signal) {
            plot_frame_level(f, s, st->limit.bound, "limit");
        }
    }

    // those that belong to a signal of the pane and have a value in the run
    const parameters now = state_parameters(st);
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++) {
        const int signal = signal_find(levels[i].signal);
        const int parameter = parameter_index(levels[i].parameter);
        const char *name = strchr(levels[i].parameter, '.') + 1;
        if (p->signals[0] != signal || state_inert_reason(st, parameter) != NULL) {
            continue;
        }
        const double value = parameter_get(&now, parameter);
        plot_frame_level(f, s, value, name);
        if (levels[i].both_ways) {
            plot_frame_level(f, s, -value, name);
        }
    }
}

// The tolerance on both sides of the baseline: its curve, shifted.
static void draw_band(const explorer_state *st, const plot_frame *f, const pane *p)
{
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] != st->band.signal || p->hidden >> k & 1) {
            continue;
        }
        for (int side = -1; side <= 1; side += 2) {
            plot_frame shifted = *f;
            const double by = side * st->band.bound;
            shifted.axis = (value_range){f->axis.low - by, f->axis.high - by};
            shifted.pixels.low -= by;
            shifted.pixels.high -= by;
            shifted.pattern = style_pattern(LINE_DOTTED);
            shifted.colour = INK_FRAME;
            plot_frame_signal(&shifted, &st->session.other.trace, p->signals[k], f->to, NULL);
        }
    }
}

// Whether panes show differences instead of runs.
static bool showing_difference(const explorer_state *st)
{
    return state_run(st, 0).kind == SHOWN_DIFFERENCE;
}

static void draw_pane(const explorer_state *st, layout *lay, screen *s, int index, area a)
{
    plot_frame f = {
        .canvas = {s, a.x + LABEL_WIDTH + 1, a.y + 1, a.width - LABEL_WIDTH - 1, a.height - 1}};
    draw_pane_title(st, lay, s, index, a);

    // another axis than time: nothing to click at, nothing to scale
    const pane *shown = &st->panes.pane[index];
    if (!pane_is_over_time(shown)) {
        const area inside = {f.canvas.x, f.canvas.y, f.canvas.width, f.canvas.height};
        const area column = {a.x, a.y + 1, LABEL_WIDTH + 1, a.height - 1};
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_VIEW, index, inside});
        if (draw_pane_view(st, s, shown, inside, &f.axis)) {
            draw_value_axis(s, column, f.axis);
        } else {
            screen_text(s, inside.x, inside.y, inside.width, INK_DIM, "nothing to see yet");
        }
        return;
    }
    state_window(st, &f.from, &f.to);
    if (!state_pane_axis(st, index, &f.axis)) {
        screen_text(s, f.canvas.x, a.y + 1, f.canvas.width, INK_DIM,
                    showing_difference(st) && pane_is_derived(shown)
                        ? "an expression has no difference"
                    : shown->view == VIEW_RESIDUAL ? "no measured data (:data FILE.csv)"
                                                   : "this run has no such values");
        return;
    }

    area labels = {a.x, a.y + 1, LABEL_WIDTH + 1, a.height - 1};
    const area curves = {f.canvas.x, f.canvas.y, f.canvas.width, f.canvas.height};
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_PANE, index, curves});
    lay->axes[index] = f.axis;
    draw_value_axis(s, labels, f.axis);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LABELS, index, labels});

    plot_frame_open(st, &f);

    // the present run over those for comparison, limits and cursors behind all curves
    for (int run = state_pane_run_count(st, shown); run-- > 0;) {
        draw_run(st, f, &st->panes.pane[index], run);
    }
    if (shown->view == VIEW_TIME && !showing_difference(st)) {
        if (st->session.has_other) {
            draw_band(st, &f, shown);
        }
        draw_levels(st, &f, s, &st->panes.pane[index]);
    } else if (shown->view == VIEW_TIME && st->difference.tolerance > 0 &&
               pane_has_amounts(shown)) {
        plot_frame_level(&f, s, st->difference.tolerance, "tolerance");
        plot_frame_level(&f, s, -st->difference.tolerance, "tolerance");
    }
    if (st->mark.set) {
        plot_frame_cursor(&f, s, st->mark.time);
    }
    plot_frame_cursor(&f, s, st->session.now);
    plot_frame_close(&f);
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    enum { LEAST_PANE = 3, AXIS = 2 };
    int shown = 0;

    // the lanes take the lowest rows
    const int lanes = lanes_rows(st, &lay->lanes, a.height);
    a.height -= lanes;
    const area beneath = {a.x, a.y + a.height, a.width, lanes};
    for (int i = 0; i < PANES; i++) {
        shown += st->panes.pane[i].shown;
    }
    int most = st->panes.alone ? 1 : (a.height - AXIS) / LEAST_PANE;
    if (shown < 1 || most < 1 || a.width < LABEL_WIDTH + 10) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "1 to 9 show curves");
        return;
    }

    lay->plot = (area){a.x + LABEL_WIDTH + 1, a.y, a.width - LABEL_WIDTH - 1, a.height};
    area plot = lay->plot;
    plot.height -= AXIS;
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_BODY, 0, plot});

    // where not all have room, those from the focused one on, so that each can be reached
    int drawn = shown > most ? most : shown, top = a.y, left = drawn;
    int first = drawn < shown ? panes_focused(&st->panes) : 0;
    for (int i = 0; i < PANES && left > 0; i++) {
        int index = (first + i) % PANES;
        if (st->panes.pane[index].shown) {
            int height = (a.y + a.height - AXIS - top + left - 1) / left;
            draw_pane(st, lay, s, index, (area){a.x, top, a.width, height});
            top += height;
            left--;
        }
    }
    if (st->box.held) {
        const zoom_box *b = &st->box;
        screen_tint(s, b->x0 < b->x1 ? b->x0 : b->x1, b->y0 < b->y1 ? b->y0 : b->y1,
                    abs(b->x1 - b->x0) + 1, abs(b->y1 - b->y0) + 1, INK_SELECTED);
    }
    const area below = {a.x, a.y + a.height - AXIS, a.width, AXIS};
    const area axis = draw_time_axis(st, s, below);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_TIME_AXIS, 0, axis});
    draw_lanes(st, lay, s, beneath);
}

static bool point(explorer_state *st, const panel_gesture *g)
{
    const hit_part part = g->hit.part;
    const bool below = part == PART_LANES || part == PART_MAP;
    if (pointer_wheel(g->event) != 0) {
        return !below && (part == PART_VIEW || turn_wheel(st, g));
    }

    // each part takes the mouse in its own way
    switch (part) {
    case PART_BODY:
    case PART_PANE:
        return point_at_plot(st, g);
    case PART_LANES:
        return scrub(st, g);
    case PART_TIME_AXIS:
        return point_at_time_axis(st, g);
    case PART_VIEW:
        return true;
    case PART_LEGEND:
        return g->event.kind == POINTER_PRESS &&
               act_toggle_signal(st, g->hit.index / PANE_SIGNALS, g->hit.index % PANE_SIGNALS);
    case PART_MAP:
        return point_at_map(st, g);
    default:
        return point_at_labels(st, g);
    }
}

const panel curves_panel = {.name = "curves", .draw = draw, .point = point};

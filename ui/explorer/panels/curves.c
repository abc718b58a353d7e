// The panes of curves over time.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/rig/controller.h"
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
    bool taken = false;
    for (int k = 0; k < curves; k++) {
        taken =
            taken || inks_look_alike(l->theme, l->shown_depth, look->colour[k], wanted);
    }
    return taken;
}

static pane_look pane_look_of(const explorer_view *view, const pane *p)
{
    enum { COLOURS = 8, STYLES = 4 };
    static const line_style plain_first[] = {LINE_SOLID, LINE_DASHED, LINE_DOTTED,
                                             LINE_DASH_DOT};
    bool style_taken[STYLES] = {false};
    pane_look look;

    // the table's colour and line unless an earlier signal of the pane has them
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        int slot = info->colour, style = (int)info->style;
        for (int i = 0; i < COLOURS && colour_is_taken(view, &look, k, slot); i++) {
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

// What a legend says of a signal's value: a mode by its name where the law is one of
// ours, else a number; short ones have up to three digits.
static void format_value(const explorer_model *model, const pane *p, int signal,
                         bool briefly, char *text, size_t size)
{
    shown_run runs[SHOWN_RUNS];
    const trace *t =
        (model_runs(model, p, runs) > 0 ? runs[0] : model_run(model, 0)).trace;
    double value = signal_value(&t->rows[model_row(model, t)], signal);
    const controller *law =
        controller_of(model->session.effective.parameters.control.law);
    bool is_mode = strcmp(signal_table[signal].name, "controller_mode") == 0;

    // fewer digits where room is short
    snprintf(text, size, "%s", draw_number(value).text);
    if (briefly && fabs(value) > 1e-12) {
        for (int digits = 3, length = 9; digits > 1 && length > 6; digits--) {
            length = snprintf(text, size, "%.*g", digits, value);
        }
    }

    // a mode by its name
    for (int i = 0; is_mode && law != NULL && law->modes != NULL && law->modes[i] != NULL;
         i++) {
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
        if (strcmp(signal_table[p->signals[k]].unit, unit) != 0) {
            unit = "";
        }
    }
    return unit;
}

// Writes a legend and returns the cells it takes; values are padded so that it stands
// still.
static int draw_legend(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, int index, legend how, int x, int y,
                       int room)
{
    static const uint32_t lines[] = {0x2500, 0x254c, 0x2508,
                                     0x2574}; // by style, in one character
    const pane *p = &view->panes.pane[index];
    int start = x, end = x + room;
    const pane_look look = pane_look_of(view, p);

    // each signal: its line, its name, its value at the cursor
    for (int k = 0; k < p->count; k++) {
        const signal_info *info = &signal_table[p->signals[k]];
        char value[48], text[128];
        format_value(model, p, p->signals[k], how == LEGEND_TIGHT, value, sizeof value);
        if (unit_of(p)[0] == '\0' && info->unit[0] != '\0' && how < LEGEND_TIGHT) {
            text_add(value, sizeof value, " %s", info->unit);
        }
        // what is hidden goes first where room is short
        if (p->hidden >> k & 1 && how >= LEGEND_SYMBOLS) {
            continue;
        }
        int width = 6;
        if (how != LEGEND_TIGHT) {
            if (how == LEGEND_BARE) {
                width = 0;
            } else {
                width = 8;
            }
        }
        int length = snprintf(text, sizeof text, "%s %-*s",
                              how == LEGEND_NAMES ? info->name : info->ascii, width,
                              how == LEGEND_BARE ? "" : value);
        if (room > 0) {
            const ink shade = p->hidden >> k & 1 ? INK_FRAME : look.colour[k];
            screen_put(s, x, y, x < end ? lines[look.style[k]] : ' ', shade);
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

// The pane's number, its unit, its signals with their values at the cursor as far as
// there is room, and the mode of its axis, in the first row of the pane's area.
static void draw_pane_title(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, int index, area a)
{
    const pane *p = &view->panes.pane[index];
    static const char *const axes[] = {"", "grows", "fixed", "calm"};
    const bool residual = p->view == VIEW_RESIDUAL;
    const bool difference = !residual && model_subtracts(model) && pane_has_amounts(p);
    bool focused = index == panes_focused(&view->panes);
    int x = a.x + LABEL_WIDTH + 1, room = a.width - LABEL_WIDTH - 1;

    // number, unit, and what the axis does
    screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "%3d%*s", index + 1, LABEL_WIDTH - 3,
                 unit_of(p));
    screen_print(s, a.x, a.y, 3, focused ? INK_TITLE : INK_DIM, "%s%-2d",
                 focused ? "\u25b8" : " ", index + 1);
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
    if (!pane_is_over_time(p)) {
        screen_print(s, x, a.y, room, INK_SERIES_0,
                     p->view == VIEW_PHASE ? "%s over %s" : "amplitudes of %s",
                     signal_table[p->signals[0]].name, signal_table[p->signals[1]].name);
        return;
    }

    // as many words as fit
    legend how = LEGEND_NAMES;
    while (how < LEGEND_BARE &&
           draw_legend(model, view, lay, s, index, how, x, a.y, 0) > room) {
        how++;
    }
    layout_add_hit(lay,
                   (hit_area){PANEL_CURVES, PART_VIEW, index, {a.x, a.y, a.width, 1}});
    draw_legend(model, view, lay, s, index, how, x, a.y, room);
}

// --- the panes -------------------------------------------------------------------------
// How a run's curves differ from those of others: the present one has the signals'
// colours and lines, a single pinned one their lines in one colour, several have their
// own lines.
static void set_look(const explorer_model *model, const explorer_view *view,
                     plot_frame *f, const pane *p, const shown_run *run,
                     const pane_look *look, int k)
{
    f->pattern = style_pattern(look->style[k]);
    f->colour = look->colour[k];
    if (view->looks.by_run && (run->kind == SHOWN_PINNED || run->kind == SHOWN_PRESENT)) {
        f->colour = run_ink(run->kind == SHOWN_PINNED ? run->index : -1);
    } else if (run->kind == SHOWN_PINNED && model_visible_pins(model) == 1) {
        f->colour = INK_OTHER;
    } else if (run->kind == SHOWN_PINNED) {
        f->pattern = run_pattern(run->index);
    } else if (run->kind == SHOWN_SWEPT) {
        if (run->index == model->sweep.selected) {
            f->colour = INK_OTHER;
        } else {
            f->colour = INK_FRAME;
        }
    } else if (run->kind == SHOWN_BEFORE) {
        f->colour = INK_FRAME;
    } else if (run->kind == SHOWN_MEASURED && p->view != VIEW_RESIDUAL) {
        f->colour = INK_TEXT;
    }
}

// The curves of one run in a pane: 0 is the present one, as far as it was seen.
static void draw_run(const explorer_model *model, const explorer_view *view, plot_frame f,
                     const pane *p, shown_run run, int number)
{
    const pane_look look = pane_look_of(view, p);

    // of a sweep of many runs a few curves, evenly spread, and the chosen one
    enum { FAN = 5 };
    const int swept = model->sweep.count, stride = (swept + FAN - 2) / (FAN - 1);
    if (run.kind == SHOWN_SWEPT && swept > FAN && run.index != model->sweep.selected &&
        run.index % stride != 0 && run.index != swept - 1) {
        return;
    }

    // of many runs a pane shows what it is about
    const bool first_only =
        run.kind == SHOWN_SWEPT || (run.kind == SHOWN_PINNED &&
                                    model_visible_pins(model) > 1 && !view->looks.by_run);
    const int count = first_only && p->count > 1 ? 1 : p->count;
    for (int k = 0; k < count; k++) {
        if (p->hidden >> k & 1) {
            continue;
        }
        const double *pairs =
            extremes_pairs(&model->extremes[number], &run, p->signals[k]);
        set_look(model, view, &f, p, &run, &look, k);

        // while a value is adjusted the whole future is shown, and after a change dimly
        const bool hidden =
            number == 0 && run.kind != SHOWN_MEASURED && !model->session.has_ghost;
        if (hidden && model->session.input_count > 0) {
            const ink seen = f.colour;
            f.colour = INK_FRAME;
            plot_frame_signal(&f, run.trace, p->signals[k], f.to, pairs);
            f.colour = seen;
        }
        plot_frame_signal(&f, run.trace, p->signals[k],
                          hidden ? model->session.seen : f.to, pairs);
    }
}

// The setpoints and limits of what a pane shows, as they are at the cursor.
static void draw_levels(const explorer_model *model, const plot_frame *f, screen *s,
                        const pane *p)
{
    const struct {
        int signal, parameter;
        bool both_ways;
    } levels[] = {{SIGNAL_INDEX(force), PARAMETER_INDEX(control.force), false},
                  {SIGNAL_INDEX(force), PARAMETER_INDEX(control.force_limit), false},
                  {SIGNAL_INDEX(command), PARAMETER_INDEX(motor.voltage_limit), true},
                  {SIGNAL_INDEX(hub_angle), PARAMETER_INDEX(wall.angle), false},
                  {SIGNAL_INDEX(hub_velocity), PARAMETER_INDEX(control.speed_limit),
                   true}};

    // the bound that was asked for, of its signal
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] == model->limit.signal) {
            plot_frame_level(f, s, model->limit.bound, "limit");
        }
    }

    // those that belong to a signal of the pane and have a value in the run
    const parameters now = model_parameters(model);
    for (size_t i = 0; i < sizeof levels / sizeof levels[0]; i++) {
        const int parameter = levels[i].parameter;
        const char *name = strchr(parameter_table[parameter].path, '.') + 1;
        if (p->signals[0] == levels[i].signal &&
            model_inert_reason(model, parameter) == NULL) {
            const double value = parameter_get(&now, parameter);
            plot_frame_level(f, s, value, name);
            plot_frame_level(f, s, levels[i].both_ways ? -value : (double)NAN, name);
        }
    }
}

// The tolerance on both sides of the baseline: its curve, shifted.
static void draw_band(const explorer_model *model, const plot_frame *f, const pane *p)
{
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] != model->band.signal || p->hidden >> k & 1) {
            continue;
        }
        for (int side = -1; side <= 1; side += 2) {
            plot_frame shifted = *f;
            const double by = side * model->band.bound;
            shifted.axis = (value_range){f->axis.low - by, f->axis.high - by};
            shifted.pixels.low -= by;
            shifted.pixels.high -= by;
            shifted.pattern = style_pattern(LINE_DOTTED);
            shifted.colour = INK_FRAME;
            plot_frame_signal(&shifted, &model->session.other.trace, p->signals[k], f->to,
                              NULL);
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

static void draw_pane(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, int index, area a)
{
    const pane *shown = &view->panes.pane[index];
    const area labels = {a.x, a.y + 1, LABEL_WIDTH + 1, a.height - 1};
    const area inside = {a.x + LABEL_WIDTH + 1, a.y + 1, a.width - LABEL_WIDTH - 1,
                         a.height - 1};
    plot_frame f = {.canvas = {s, inside.x, inside.y, inside.width, inside.height}};
    const bool over_time = pane_is_over_time(shown);
    draw_pane_title(model, view, lay, s, index, a);
    view_window(model, view, &f.from, &f.to);

    // what there is to see, or why there is nothing
    if (!over_time) {
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_VIEW, index, inside});
    }
    bool has_values;
    if (over_time) {
        has_values = view_pane_axis(model, view, index, &f.axis);
    } else {
        has_values = draw_pane_view(model, view, s, shown, inside, &f.axis);
    }
    if (!has_values) {
        screen_text(s, inside.x, inside.y, inside.width, INK_DIM,
                    reason_of_emptiness(model, shown));
        return;
    }
    draw_value_axis(s, labels, f.axis);

    // another axis than time: nothing to click at, nothing to scale
    if (!over_time) {
        return;
    }
    lay->axes[index] = f.axis;
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_PANE, index, inside});
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LABELS, index, labels});
    plot_frame_open(view, &f);

    // the present run over those for comparison, limits and cursors behind all curves
    shown_run runs[SHOWN_RUNS];
    for (int run = model_runs(model, shown, runs); run-- > 0;) {
        draw_run(model, view, f, shown, runs[run], run);
    }
    if (shown->view == VIEW_TIME && !model_subtracts(model)) {
        if (model->session.has_other) {
            draw_band(model, &f, shown);
        }
        draw_levels(model, &f, s, shown);
    } else if (shown->view == VIEW_TIME && model->difference.tolerance > 0 &&
               pane_has_amounts(shown)) {
        plot_frame_level(&f, s, model->difference.tolerance, "tolerance");
        plot_frame_level(&f, s, -model->difference.tolerance, "tolerance");
    }
    if (view->mark.set) {
        plot_frame_cursor(&f, s, view->mark.time);
    }
    plot_frame_cursor(&f, s, model->session.now);
    if (f.picture != NULL) {
        picture_end(s, f.picture);
    }
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    enum { LEAST_PANE = 3, AXIS = 2 };
    int shown = 0;

    // the lanes take the lowest rows
    const int lanes = lanes_rows(model, view, &lay->lanes, a.height);
    a.height -= lanes;
    const area beneath = {a.x, a.y + a.height, a.width, lanes};
    for (int i = 0; i < PANES; i++) {
        shown += view->panes.pane[i].shown;
    }
    int most = view->panes.alone ? 1 : (a.height - AXIS) / LEAST_PANE;
    if (shown < 1 || most < 1 || a.width < LABEL_WIDTH + 10) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "1 to 9 show curves");
        return;
    }

    const area plot = {a.x + LABEL_WIDTH + 1, a.y, a.width - LABEL_WIDTH - 1,
                       a.height - AXIS};
    lay->plot = (area){plot.x, plot.y, plot.width, a.height};
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_BODY, 0, plot});

    // where not all have room, those from the focused one on, so that each can be reached
    int drawn = shown > most ? most : shown, top = a.y, left = drawn;
    int first = drawn < shown ? panes_focused(&view->panes) : 0;
    for (int i = 0; i < PANES && left > 0; i++) {
        int index = (first + i) % PANES;
        if (view->panes.pane[index].shown) {
            int height = (a.y + a.height - AXIS - top + left - 1) / left;
            draw_pane(model, view, lay, s, index, (area){a.x, top, a.width, height});
            top += height;
            left--;
        }
    }
    if (view->box.held) {
        const zoom_box *b = &view->box;
        screen_tint(s, b->x0 < b->x1 ? b->x0 : b->x1, b->y0 < b->y1 ? b->y0 : b->y1,
                    abs(b->x1 - b->x0) + 1, abs(b->y1 - b->y0) + 1, INK_SELECTED);
    }
    const area below = {a.x, a.y + a.height - AXIS, a.width, AXIS};
    const area axis = draw_time_axis(model, view, s, below);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_TIME_AXIS, 0, axis});
    draw_lanes(model, view, lay, s, beneath);
}

const panel curves_panel = {.name = "curves", .draw = draw, .point = curves_point};

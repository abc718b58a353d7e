// The panes of curves over time.
#include "ui/explorer/panels/panel.h"

#include <string.h>

#include "ui/explorer/panels/curves_mouse.h"
#include "ui/explorer/panels/lanes.h"
#include "ui/explorer/panels/pane_title.h"
#include "ui/explorer/panels/pane_views.h"
#include "ui/explorer/panels/plot_axes.h"
#include "ui/explorer/panels/plot_frame.h"
#include "ui/explorer/panels/run_lines.h"

// How a run's curves differ from those of others: the present one has the signals' colours and
// lines, a single pinned one their lines in one colour, several have their own lines.
static void set_look(const explorer_state *st, plot_frame *f, const shown_run *run,
                     const pane_look *look, int k)
{
    f->pattern = style_pattern(look->style[k]);
    f->colour = look->colour[k];
    if (run->kind == SHOWN_PINNED && state_visible_pins(st) == 1) {
        f->colour = INK_OTHER;
    } else if (run->kind == SHOWN_PINNED) {
        f->pattern = run_pattern(run->index);
    } else if (run->kind == SHOWN_SWEPT) {
        f->colour = run->index == st->sweep.selected ? INK_OTHER : INK_FRAME;
    } else if (run->kind == SHOWN_BEFORE) {
        f->colour = INK_FRAME;
    }
}

// The curves of one run in a pane: 0 is the present one, as far as it was seen.
static void draw_run(const explorer_state *st, plot_frame f, const pane *p, int number)
{
    const shown_run run = state_run(st, number);
    const pane_look look = pane_look_of(st, p);

    // of many runs a pane shows what it is about
    const bool first_only =
        run.kind == SHOWN_SWEPT || (run.kind == SHOWN_PINNED && state_visible_pins(st) > 1);
    const int count = first_only && p->count > 1 ? 1 : p->count;
    for (int k = 0; k < count; k++) {
        const double *pairs =
            extremes_pairs(&st->extremes[number], run.id, run.trace, p->signals[k]);
        set_look(st, &f, &run, &look, k);

        // while a value is adjusted the whole future is shown
        const bool hidden = number == 0 && !st->session.has_ghost;
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

// Whether panes show differences instead of runs.
static bool showing_difference(const explorer_state *st)
{
    return state_run(st, 0).kind == SHOWN_DIFFERENCE;
}

static void draw_pane(const explorer_state *st, layout *lay, screen *s, int index, area a)
{
    plot_frame f = {
        .canvas = {s, a.x + LABEL_WIDTH + 1, a.y + 1, a.width - LABEL_WIDTH - 1, a.height - 1}};
    draw_pane_title(st, s, index, a);

    // another axis than time: nothing to click at, nothing to scale
    const pane *shown = &st->panes.pane[index];
    if (shown->view != VIEW_TIME) {
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
        screen_text(s, f.canvas.x, a.y + 1, f.canvas.width, INK_DIM, "this run has no such values");
        return;
    }

    area labels = {a.x, a.y + 1, LABEL_WIDTH + 1, a.height - 1};
    lay->axes[index] = f.axis;
    draw_value_axis(s, labels, f.axis);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LABELS, index, labels});

    plot_frame_open(st, &f);

    // the present run over those for comparison, limits and cursors behind all curves
    for (int run = state_run_count(st); run-- > 0;) {
        draw_run(st, f, &st->panes.pane[index], run);
    }
    if (!showing_difference(st)) {
        draw_levels(st, &f, s, &st->panes.pane[index]);
    } else if (st->difference.tolerance > 0 && pane_has_amounts(shown)) {
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
    lanes_survey(st, &lay->lanes);
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
    const area below = {a.x, a.y + a.height - AXIS, a.width, AXIS};
    const area axis = draw_time_axis(st, s, below);
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_TIME_AXIS, 0, axis});
    draw_lanes(st, lay, s, beneath);
}

static bool point(explorer_state *st, const panel_gesture *g, action_result *result)
{
    *result = result_done();

    // each part takes the mouse in its own way
    switch (g->hit.part) {
    case PART_BODY:
        return curves_point_at_plot(st, g);
    case PART_TIME_AXIS:
        return curves_point_at_time_axis(st, g);
    case PART_VIEW:
        return true;
    case PART_LANES:
    case PART_MAP:
        return lanes_point(st, g);
    default:
        return curves_point_at_labels(st, g);
    }
}

const panel curves_panel = {.name = "curves", .draw = draw, .point = point};

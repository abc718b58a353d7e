// The runs: their legend beside the curves, the page of those that are pinned, the
// comparison of two.
#include "ui/explorer/panels/panel.h"

#include <math.h>

// --- the legend ------------------------------------------------------------------------
// The legend of runs: the present one and those pinned, with their lines and peaks.

enum { SAMPLE = 4, PEAK = 10 };

static int rows(const explorer_model *model, const explorer_view *view, screen_size body)
{
    (void)view;
    const bool fits = body.width >= SIDE_WIDTH && body.height >= 12;
    if (fits && model->pinned.count > 0) {
        return model->pinned.count + 3;
    }
    return 0;
}

// A run in a line: how it is drawn, its name, its peak force.
static void draw_run(screen *s, area a, const char *name, double peak, unsigned pattern,
                     ink colour)
{
    draw_line_sample(s, a.x, a.y, SAMPLE, pattern, colour);
    screen_words(s, a.x + SAMPLE + 1, a.y, a.width - SAMPLE - 1 - PEAK, INK_TEXT, name);
    screen_print(s, a.x + a.width - PEAK, a.y, PEAK, INK_FORCE, "%8s N",
                 draw_number(peak).text);
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    const run_list *list = &model->pinned;
    area line = {a.x + 2, a.y + 1, a.width - 4, 1};
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "runs, peaks (R: list)");
    const bool by_run = view->looks.by_run != 0;
    draw_run(s, line, "now", model->session.run.summary.peak_force_N,
             style_pattern(LINE_SOLID), by_run ? run_ink(-1) : INK_TEXT);
    line.y++;

    // the baseline with a mark, hidden ones without a line
    const bool single = model_visible_pins(model) == 1;
    for (int i = 0; i < list->count && line.y < a.y + a.height - 1; i++, line.y++) {
        const pinned_run *p = &list->runs[i];
        unsigned pattern = 0;
        if (!p->hidden) {
            if (single || by_run) {
                pattern = style_pattern(LINE_SOLID);
            } else {
                pattern = run_pattern(i);
            }
        }
        ink colour;
        if (by_run) {
            colour = run_ink(i);
        } else if (single) {
            colour = INK_OTHER;
        } else {
            colour = INK_TEXT;
        }
        draw_run(s, line, p->name, p->run.summary.peak_force_N, pattern, colour);
        if (i == list->baseline) {
            screen_put(s, a.x + 1, line.y, 0x25b8, INK_EVENT);
        }
        layout_add_hit(lay, (hit_area){PANEL_RUNS, PART_LINES, i, line});
    }
}

// A click hides a run or shows it.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    (void)input;
    (void)view;
    const bool pressed = g->event.kind == POINTER_PRESS;
    model->pinned.runs[g->hit.index].hidden ^= pressed;
    return pressed;
}

const panel runs_panel = {.name = "runs", .rows = rows, .draw = draw, .point = point};

// --- the page --------------------------------------------------------------------------
// The page of pinned runs: what differs, and what can be done with them.

enum { NAME_WIDTH = 30, NUMBER = 10 };

// A pinned run: its line, name, peak, and what differs from the present one.
static void draw_pinned(const explorer_model *model, screen *s, area a, int index)
{
    const pinned_run *p = &model->pinned.runs[index];
    char differs[LINE_TEXT];
    const int name = a.width >= 80 ? NAME_WIDTH : 20;
    run_list_differences(p, &model->session, differs, sizeof differs);

    // number, line, name, peak, difference
    screen_print(s, a.x, a.y, 3, INK_DIM, "%s%d",
                 index == model->pinned.baseline ? "\u25b8" : " ", index + 1);
    draw_line_sample(s, a.x + 3, a.y, SAMPLE, p->hidden ? 0 : run_pattern(index),
                     INK_TEXT);
    screen_words(s, a.x + 8, a.y, name - 1, p->hidden ? INK_DIM : INK_TITLE, p->name);
    screen_print(s, a.x + 8 + name, a.y, NUMBER, INK_FORCE, "%7s N",
                 draw_number(p->run.summary.peak_force_N).text);
    screen_words(s, a.x + 8 + name + NUMBER, a.y, a.width - 8 - name - NUMBER, INK_TEXT,
                 differs);
}

// What they stand beside, and the keys.
static void draw_rest(const explorer_model *model, screen *s, area a)
{
    screen_print(s, a.x, a.y, a.width, INK_DIM, "this run peaks at %.4g N; beside it:",
                 model->session.run.summary.peak_force_N);
    screen_text(
        s, a.x, a.y + a.height - 1, a.width, INK_DIM,
        model->pinned.count > 0
            ? "Enter takes it, Space hides, = compares, r renames, d drops, D subtracts"
            : "none yet: b pins the run there is, then change something");
}

static int count(const explorer_model *model)
{
    return model->pinned.count;
}

static int selected(const explorer_model *model, const explorer_view *view)
{
    (void)view;
    return model->pinned.selected;
}

static void select_run(explorer_model *model, explorer_view *view, int index)
{
    (void)view;
    model->pinned.selected = index;
}

static bool press_key(explorer_model *model, explorer_view *view, explorer_input *input,
                      int key, int index)
{
    switch (key) {
    case ' ':
        act_hide_run(model, index);
        return true;
    case '=':
        return act_compare_with(model, input, index);
    case 'r':
        act_ask_run_name(model, input, index);
        return true;
    case 'd':
    case 'x':
    case KEY_CODE_DELETE:
        return act_drop_run(model, input, index);
    case KEY_CODE_ENTER:
        view->page = PANEL_NONE;
        return act_take_run(model, view, input, index);
    case 'D':
        view->page = PANEL_NONE;
        return act_difference(model, view, input, "");
    default:
        view->page = PANEL_NONE;
        return true;
    }
}

static const page_list list = {.title = "pinned runs (Esc closes)",
                               .width = 100,
                               .head = 1,
                               .foot = 2,
                               .needs_lines = true,
                               .count = count,
                               .selected = selected,
                               .select = select_run,
                               .draw_line = draw_pinned,
                               .draw_rest = draw_rest,
                               .key = press_key};

const panel run_list_panel = {.name = "run list", .list = &list};

// --- the comparison --------------------------------------------------------------------

// A quantity of the comparison as a name and as columns; returns whether it means
// anything in either run.
static bool compare_quantity(const session *e, int index, int width, char *columns,
                             size_t size, bool *differs)
{
    // smaller differences are rounding, of numbers near zero too
    const double relative = 1e-6, absolute = 1e-9;
    const double value = summary_value(&e->run.summary, index);
    const double other =
        e->has_other ? summary_value(&e->other.summary, index) : (double)NAN;
    *differs =
        e->has_other && !(isnan(value) && isnan(other)) &&
        !(fabs(value - other) <= absolute + relative * fmax(fabs(value), fabs(other)));

    // a single run has no change
    const number_text none = {""}, two = e->has_other ? draw_number(other) : none;
    number_text change;
    if (e->has_other) {
        change = draw_number(*differs ? value - other : (double)NAN);
    } else {
        change = none;
    }
    snprintf(columns, size, "%*s%*s%*s", width, draw_number(value).text, width, two.text,
             width, change.text);
    return !summary_table[index].timing && !(isnan(value) && isnan(other));
}

static void draw_comparison(const explorer_model *model, const explorer_view *view,
                            layout *lay, screen *s, area body)
{
    (void)view;
    enum { NAMES = 30, WIDE = 12, NARROW = 11 };
    const session *e = &model->session;
    char columns[128];
    bool differs;
    int count = 0, line = 0;

    // what means anything in either run
    for (int i = 0; i < summary_count; i++) {
        count += compare_quantity(e, i, WIDE, columns, sizeof columns, &differs);
    }

    // a narrow screen has the name and the numbers below each other
    int rows = s->width - 6 < NAMES + 3 * WIDE ? 2 : 1, names = rows == 1 ? NAMES : 0;
    int width = rows == 1 ? WIDE : NARROW;
    area a = page_area(body, names + 3 * width + 4, rows * count + 3);
    int room = a.width - 4, shown = a.height - 3;
    int scroll = page_scroll(lay, PANEL_COMPARISON, a, rows * count, 3);
    const int all = rows * count, last = scroll + shown;
    draw_page_frame(s, a,
                    e->has_other ? "two runs (Esc closes)"
                                 : "this run (b branches, Esc closes)",
                    (last < all ? last : all) / rows, count);
    screen_print(s, a.x + 2 + names, a.y + 1, room - names, INK_DIM, "%*s", width, "now");
    if (e->has_other) {
        // under the name that the legend has
        const int at = a.x + 3 + names + width;
        screen_words(s, at, a.y + 1, width - 1, INK_DIM,
                     model->pinned.runs[model->pinned.baseline].name);
        screen_print(s, at + width - 1, a.y + 1, width, INK_DIM, "%*s", width, "change");
    }

    // the lines that it is scrolled to
    for (int i = 0; i < summary_count; i++) {
        if (!compare_quantity(e, i, width, columns, sizeof columns, &differs)) {
            continue;
        }
        const ink colour = differs || !e->has_other ? INK_TEXT : INK_DIM;
        const summary_info *info = &summary_table[i];
        int y = rows * line++ - scroll, below = y + rows - 1;
        if (y >= 0 && y < shown) {
            screen_print(s, a.x + 2, a.y + 2 + y, room, colour, "%s%s%s%s", info->label,
                         info->unit[0] ? " [" : "", info->unit, info->unit[0] ? "]" : "");
        }
        if (below >= 0 && below < shown) {
            screen_text(s, a.x + 2 + names, a.y + 2 + below, room - names, colour,
                        columns);
        }
    }
}

const panel comparison_panel = {.name = "comparison",
                                .draw = draw_comparison,
                                .key = page_key};

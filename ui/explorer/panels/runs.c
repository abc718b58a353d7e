// The runs: their legend beside the curves, and the page of those that are pinned.
#include "ui/explorer/panels/panel.h"

#include "ui/terminal/keys.h"

// --- the legend -------------------------------------------------------------------------------
// The legend of runs: the present one and those pinned, with their lines and peaks.

enum { SAMPLE = 4, PEAK = 10 };

static int rows(const explorer_state *st, screen_size body)
{
    return st->pinned.count > 0 ? st->pinned.count + 3 : 0;
}

// A run in a line: how it is drawn, its name, its peak force.
static void draw_run(screen *s, area a, const char *name, double peak, unsigned pattern, ink colour)
{
    char text[32];
    draw_number(text, sizeof text, peak);
    draw_line_sample(s, a.x, a.y, SAMPLE, pattern, colour);
    screen_words(s, a.x + SAMPLE + 1, a.y, a.width - SAMPLE - 1 - PEAK, INK_TEXT, name);
    screen_print(s, a.x + a.width - PEAK, a.y, PEAK, INK_FORCE, "%8s N", text);
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    const run_list *list = &st->pinned;
    area line = {a.x + 2, a.y + 1, a.width - 4, 1};
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "runs, peaks (R: list)");
    const bool by_run = st->looks.by_run != 0;
    draw_run(s, line, "now", st->session.run.summary.peak_force_N, style_pattern(LINE_SOLID),
             by_run ? run_ink(-1) : INK_TEXT);
    line.y++;

    // the baseline with a mark, hidden ones without a line
    const bool single = state_visible_pins(st) == 1;
    for (int i = 0; i < list->count && line.y < a.y + a.height - 1; i++, line.y++) {
        const pinned_run *p = &list->runs[i];
        const unsigned pattern = p->hidden          ? 0
                                 : single || by_run ? style_pattern(LINE_SOLID)
                                                    : run_pattern(i);
        const ink colour = by_run ? run_ink(i) : single ? INK_OTHER : INK_TEXT;
        draw_run(s, line, p->name, p->run.summary.peak_force_N, pattern, colour);
        if (i == list->baseline) {
            screen_put(s, a.x + 1, line.y, 0x25b8, INK_EVENT);
        }
        layout_add_hit(lay, (hit_area){PANEL_RUNS, PART_LINES, i, line});
    }
}

// A click hides a run or shows it.
static bool point(explorer_state *st, const panel_gesture *g)
{
    char number[16];
    if (g->event.kind != POINTER_PRESS) {
        return false;
    }
    snprintf(number, sizeof number, "%d", g->hit.index + 1);
    act_hide(st, number);
    return true;
}

const panel runs_panel = {.name = "runs",
                          .least_width = SIDE_WIDTH,
                          .least_body = 12,
                          .rows = rows,
                          .draw = draw,
                          .point = point};

// --- the page ---------------------------------------------------------------------------------
// The page of pinned runs: what differs, and what can be done with them.

enum { WIDE = 100, NAME_WIDTH = 30, NUMBER = 10 };

// A pinned run: its line, name, peak, and what differs from the present one.
static void draw_pinned(const explorer_state *st, screen *s, area a, int index)
{
    const pinned_run *p = &st->pinned.runs[index];
    char peak[32], differs[LINE_TEXT];
    const int name = a.width >= 80 ? NAME_WIDTH : 20;
    draw_number(peak, sizeof peak, p->run.summary.peak_force_N);
    run_list_differences(p, &st->session, differs, sizeof differs);

    // number, line, name, peak, difference
    screen_print(s, a.x, a.y, 3, INK_DIM, "%s%d", index == st->pinned.baseline ? "\u25b8" : " ",
                 index + 1);
    draw_line_sample(s, a.x + 3, a.y, SAMPLE, p->hidden ? 0 : run_pattern(index), INK_TEXT);
    screen_words(s, a.x + 8, a.y, name - 1, p->hidden ? INK_DIM : INK_TITLE, p->name);
    screen_print(s, a.x + 8 + name, a.y, NUMBER, INK_FORCE, "%7s N", peak);
    screen_words(s, a.x + 8 + name + NUMBER, a.y, a.width - 8 - name - NUMBER, INK_TEXT, differs);
    if (index == st->pinned.selected) {
        screen_tint(s, a.x - 1, a.y, a.width + 2, 1, INK_SELECTED);
    }
}

static void draw_page(const explorer_state *st, layout *lay, screen *s, area body)
{
    const int count = st->pinned.count;
    const area a = page_area(body, WIDE, count < 1 ? 5 : count + 5);
    const area lines = {a.x + 2, a.y + 2, a.width - 4, count};
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, "pinned runs (Esc closes)");
    layout_add_hit(lay, (hit_area){PANEL_RUN_LIST, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){PANEL_RUN_LIST, PART_LINES, 0, lines});

    // headings, the runs, the keys
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM,
                 "this run peaks at %.4g N; beside it:", st->session.run.summary.peak_force_N);
    for (int i = 0; i < count && lines.y + i < a.y + a.height - 2; i++) {
        draw_pinned(st, s, (area){lines.x, lines.y + i, lines.width, 1}, i);
    }
    screen_text(s, a.x + 2, a.y + a.height - 2, a.width - 4, INK_DIM,
                count > 0
                    ? "Enter takes it, Space hides, = compares, r renames, d drops, D subtracts"
                    : "none yet: b pins the run there is, then change something");
}

static bool list_key(explorer_state *st, int key)
{
    run_list *list = &st->pinned;
    char number[16];
    snprintf(number, sizeof number, "%d", list->selected + 1);

    // keys move the selection or do something with the run
    if (page_select(key, &list->selected, list->count)) {
        return true;
    } else if (list->count == 0) {
        st->page.panel = PANEL_NONE;
    } else if (key == KEY_CODE_ENTER) {
        st->page.panel = PANEL_NONE;
        return act_take(st, number);
    } else if (key == ' ') {
        return act_hide(st, number);
    } else if (key == '=') {
        return act_baseline(st, number);
    } else if (key == 'r') {
        return act_rename(st, number);
    } else if (key == 'd' || key == 'x' || key == KEY_CODE_DELETE) {
        return act_unpin(st, number);
    } else if (key == 'D') {
        st->page.panel = PANEL_NONE;
        return act_difference(st, "");
    } else {
        st->page.panel = PANEL_NONE;
    }
    return true;
}

// A click selects a run.
static bool point_at_page(explorer_state *st, const panel_gesture *g)
{
    return page_point_at_line(st, g, &st->pinned.selected, st->pinned.count);
}

const panel run_list_panel = {
    .name = "run list", .draw = draw_page, .point = point_at_page, .key = list_key};

// The legend of runs: the present one and those pinned, with their lines and peaks.
#include "ui/explorer/panels/panel.h"
#include "ui/explorer/panels/run_lines.h"

enum { SAMPLE = 4, PEAK = 10 };

static int rows(const explorer_state *st, screen_size body)
{
    (void)body;
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
    draw_run(s, line, "now", st->session.run.summary.peak_force_N, style_pattern(LINE_SOLID),
             INK_TEXT);
    line.y++;

    // the baseline with a mark, hidden ones without a line
    const bool single = state_visible_pins(st) == 1;
    for (int i = 0; i < list->count && line.y < a.y + a.height - 1; i++, line.y++) {
        const pinned_run *p = &list->runs[i];
        const unsigned pattern = p->hidden ? 0
                                 : single  ? style_pattern(LINE_SOLID)
                                           : run_pattern(i);
        const ink colour = single ? INK_OTHER : INK_TEXT;
        draw_run(s, line, p->name, p->run.summary.peak_force_N, pattern, colour);
        if (i == list->baseline) {
            screen_put(s, a.x + 1, line.y, 0x25b8, INK_EVENT);
        }
        layout_add_hit(lay, (hit_area){PANEL_RUNS, PART_LINES, i, line});
    }
}

// A click hides a run or shows it.
static bool point(explorer_state *st, const panel_gesture *g, action_result *result)
{
    char number[16];
    *result = result_done();
    if (g->event.kind != POINTER_PRESS) {
        return false;
    }
    snprintf(number, sizeof number, "%d", g->hit.index + 1);
    *result = act_hide_run(st, number);
    return true;
}

const panel runs_panel = {.name = "runs",
                          .least_width = SIDE_WIDTH,
                          .least_body = 18,
                          .rows = rows,
                          .draw = draw,
                          .point = point};

// The page that compares the present run with the kept one in numbers.
#include <math.h>

#include "ui/explorer/panels/page.h"

// A quantity of the comparison as a name and as columns; returns whether it means anything in
// either run.
static bool compare_quantity(const session *e, int index, int width, char *columns, size_t size,
                             bool *differs)
{
    double value = summary_value(&e->run.summary, index), other = (double)NAN;
    char one[32], two[32] = "", change[32] = "";
    draw_number(one, sizeof one, value);

    // a single run has no change
    if (e->has_other) {
        other = summary_value(&e->other.summary, index);
        draw_number(two, sizeof two, other);
        draw_number(change, sizeof change, value - other);
    }

    // two runs differ by more than rounding
    *differs = e->has_other && !(isnan(value) && isnan(other)) &&
               !(fabs(value - other) <= 1e-6 * fmax(fabs(value), fabs(other)));
    snprintf(columns, size, "%*s%*s%*s", width, one, width, two, width, change);
    return !summary_table[index].timing && !(isnan(value) && isnan(other));
}

static void draw(const explorer_state *st, layout *lay, screen *s, area body)
{
    enum { NAMES = 28, WIDE = 12, NARROW = 11 };
    const session *e = &st->session;
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
    int beyond = rows * count - shown;
    int scroll = layout_keep_scroll(lay, PANEL_COMPARISON, beyond > 0 ? beyond : 0);
    lay->page_lines = shown > 1 ? shown - 1 : 1;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 e->has_other ? "this run beside the old one (Esc closes)"
                              : "this run (b branches, Esc closes)");
    layout_add_hit(lay, (hit_area){.panel = PANEL_COMPARISON, .area = a});
    screen_print(s, a.x + 2 + names, a.y + 1, room - names, INK_DIM, "%*s%*s%*s", width, "this run",
                 width, e->has_other ? "old run" : "", width, e->has_other ? "change" : "");

    // the lines that it is scrolled to
    for (int i = 0; i < summary_count; i++) {
        if (!compare_quantity(e, i, width, columns, sizeof columns, &differs)) {
            continue;
        }
        ink colour = differs ? INK_WARNING : INK_TEXT;
        int y = rows * line++ - scroll, below = y + rows - 1;
        if (y >= 0 && y < shown) {
            screen_text(s, a.x + 2, a.y + 2 + y, room, colour, summary_table[i].key);
        }
        if (below >= 0 && below < shown) {
            screen_text(s, a.x + 2 + names, a.y + 2 + below, room - names, colour, columns);
        }
    }
}

const panel comparison_panel = {
    .name = "comparison", .draw = draw, .point = page_point, .key = page_key};

// The panel of all recorded values at the cursor.
#include "ui/explorer/panels/panel.h"

#include <math.h>

// Signals of sensors that are not fitted have none.
static bool has_value(const sample *row, int signal)
{
    return !signal_table[signal].optional || !isnan(signal_value(row, signal));
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    const session *e = &st->session;
    const sample *row = session_sample(e), *beside = NULL;
    const char *against = "";

    // beside the values at the mark, or else those of the kept run
    if (st->mark.set) {
        beside = &e->run.trace.rows[trace_row_at(&e->run.trace, st->mark.time)];
        against = ", minus mark";
    } else if (e->has_other) {
        beside = &e->other.trace.rows[trace_row_at(&e->other.trace, e->now)];
        against = ", minus old run";
    }
    char title[64];
    snprintf(title, sizeof title, "values%s", against);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // as many as there is room for, from the line that it is scrolled to
    int height = a.height - 2, shown = 0, line = 0;
    for (int i = 0; i < signal_count; i++) {
        shown += has_value(row, i);
    }
    int first = layout_keep_scroll(lay, PANEL_VALUES, shown > height ? shown - height : 0);
    layout_add_hit(lay, (hit_area){.panel = PANEL_VALUES, .area = a});

    for (int i = 0; i < signal_count && line < first + height; i++) {
        if (!has_value(row, i) || line++ < first) {
            continue;
        }
        double value = signal_value(row, i), other = beside ? signal_value(beside, i) : 0;
        double difference = value - other, size = fmax(fabs(value), fabs(other));
        bool differs = beside != NULL && fabs(difference) > 1e-6 * size;
        char text[32];
        int y = a.y + line - first;
        screen_text(s, a.x + 2, y, 16, INK_TEXT, signal_table[i].name);
        draw_number(text, sizeof text, value);
        screen_print(s, a.x + 18, y, a.width - 20, INK_TITLE, "%9s", text);
        if (beside != NULL) {
            draw_number(text, sizeof text, difference);
            screen_print(s, a.x + 28, y, a.width - 30, differs ? INK_WARNING : INK_DIM, "%9s",
                         text);
        } else {
            screen_text(s, a.x + 28, y, a.width - 30, INK_DIM, signal_table[i].unit);
        }
    }
}

static bool point(explorer_state *st, const panel_gesture *g, action_result *result)
{
    *result = result_done();
    if (g->event.kind != POINTER_WHEEL_UP && g->event.kind != POINTER_WHEEL_DOWN) {
        return false;
    }
    st->scroll[PANEL_VALUES] += WHEEL_LINES * pointer_wheel(g->event);
    return true;
}

const panel values_panel = {.name = "values", .draw = draw, .point = point};

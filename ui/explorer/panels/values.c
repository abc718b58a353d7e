// The panel of all recorded values at the cursor.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum { NAME = 19, NUMBER = 10, UNIT = 6 }; // columns [cells]

// Signals of sensors that are not fitted have none.
static bool has_value(const sample *row, int signal)
{
    return !signal_table[signal].optional || !isnan(signal_value(row, signal));
}

// Whether a signal is in the list: it has a value, and the filter lets it through.
static bool is_listed(const explorer_state *st, const sample *row, int signal)
{
    return has_value(row, signal) &&
           filter_passes(st->filters.text[PANEL_VALUES], signal_table[signal].name);
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    const session *e = &st->session;
    const sample *row = session_sample(e), *beside = NULL;
    const char *against = "", *filter = st->filters.text[PANEL_VALUES];

    // beside the values at the mark, or else those of the kept run
    if (st->mark.set) {
        beside = &e->run.trace.rows[trace_row_at(&e->run.trace, st->mark.time)];
        against = ", minus mark";
    } else if (e->has_other) {
        beside = &e->other.trace.rows[trace_row_at(&e->other.trace, e->now)];
        against = ", minus old run";
    }

    // as many as there is room for, from the line that it is scrolled to
    int height = a.height - 2, shown = 0, line = 0;
    for (int i = 0; i < signal_count; i++) {
        shown += is_listed(st, row, i);
    }
    int first = layout_keep_scroll(lay, PANEL_VALUES, shown > height ? shown - height : 0);
    layout_add_hit(lay, (hit_area){.panel = PANEL_VALUES, .area = a});
    char title[LINE_TEXT + 64], part[32] = "";
    if (shown > height) {
        snprintf(part, sizeof part, ", %d-%d of %d", first + 1, first + height, shown);
    }
    snprintf(title, sizeof title, "values%s%s%s%s", against, filter[0] ? " /" : "", filter, part);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // full names if there is room for them and two numbers
    const int room = a.width - 4, numbers = beside != NULL ? 2 * NUMBER : NUMBER;
    const bool wide = room >= NAME + numbers + UNIT;
    const int names = room - numbers - (wide || beside == NULL ? UNIT : 0);
    for (int i = 0; i < signal_count && line < first + height; i++) {
        if (!is_listed(st, row, i) || line++ < first) {
            continue;
        }
        const signal_info *info = &signal_table[i];
        double value = signal_value(row, i), other = beside ? signal_value(beside, i) : 0;
        double difference = value - other, size = fmax(fabs(value), fabs(other));
        bool differs = beside != NULL && fabs(difference) > 1e-6 * size;
        char text[32];
        int y = a.y + line - first, x = a.x + 2;
        const bool fits = (int)strlen(info->name) < names;
        screen_text(s, x, y, names - 1, INK_TEXT, fits ? info->name : info->ascii);
        x += names;
        draw_number(text, sizeof text, value);
        screen_print(s, x, y, NUMBER, INK_TITLE, "%9s", text);
        x += NUMBER;
        if (beside != NULL) {
            draw_number(text, sizeof text, difference);
            if (signal_is_state(i)) {
                snprintf(text, sizeof text, "%s", differs ? "other" : "same");
            }
            screen_print(s, x, y, NUMBER, differs ? INK_WARNING : INK_DIM, "%9s", text);
            x += NUMBER;
        }
        if (wide || beside == NULL) {
            screen_text(s, x, y, a.x + a.width - 2 - x, INK_DIM, info->unit);
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

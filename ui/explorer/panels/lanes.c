// The lane below the curves, on their time axis: the modes of the law. Above it the map
// of the run, where only a part of it is visible.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <string.h>

enum { FEWEST_CURVES = 20 }; // rows that lanes leave to the curves and their axis

// Whether only a part of the run is visible.
static bool has_map(const explorer_view *view)
{
    return view->window.to > view->window.from;
}

int lanes_rows(const explorer_model *model, const explorer_view *view, int height)
{
    int wanted = 0;
    if (has_map(view)) {
        wanted++;
    }
    if (model_has_law(model)) {
        wanted++;
    }

    // what the curves leave to them
    const int spare = height > FEWEST_CURVES ? height - FEWEST_CURVES : 0;
    return spare < wanted ? spare : wanted;
}

// --- the modes of the law --------------------------------------------------------------

// The colour of a mode.
static ink mode_ink(int mode)
{
    enum { COLOURS = 6 };
    return (ink)(INK_SERIES_0 + mode % COLOURS);
}

// The name of a mode in its band, as far as that is long enough to tell it.
static void name_mode(const explorer_model *model, screen *s, area band, int mode)
{
    enum { LEAST = 3 }; // cells of a name that tell it
    char name[MODE_NAME_SIZE];
    if (mode < 0) {
        return;
    }
    law_mode_name(&model->modes, mode, name, sizeof name);
    const int length = (int)strlen(name), room = band.width - 2;
    if (room >= length || room >= LEAST) {
        screen_text(s, band.x + 1, band.y, room, mode_ink(mode), name);
    }
}

// A band for each mode that the law was in, as far as the run has been seen; while a
// value is adjusted, all of it.
static void draw_modes(const explorer_model *model, const explorer_view *view, screen *s,
                       area line)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    double from, to;
    view_window(model, view, &from, &to);

    int before = -1, start = 0;
    for (int i = 0; i <= line.width; i++) {
        int mode = -1;
        const double time = from + (to - from) * i / line.width;
        const double end = time + (to - from) / line.width;
        if (i < line.width && (time <= e->seen || e->has_ghost)) {
            const double until = e->has_ghost ? end : fmin(end, e->seen);
            mode = (int)t->rows[trace_row_at(t, until)].controller_mode;
        }

        // a band ends where the next one begins
        if (mode != before) {
            name_mode(model, s, (area){line.x + start, line.y, i - start, 1}, before);
            start = i;
        }
        if (mode >= 0) {
            const uint32_t glyph = i == start ? GLYPH_UPRIGHT : GLYPH_LINE;
            screen_put(s, line.x + i, line.y, glyph, mode_ink(mode));
        }
        before = mode;
    }
}

// --- the map ---------------------------------------------------------------------------

// The column of a line over the whole run at which an instant is.
static int map_column(const session *e, area line, double time)
{
    return (int)(time / e->effective.parameters.run.duration * line.width);
}

// The whole run in a row: the visible part, impacts, the cursor.
static void draw_run_map(const explorer_model *model, const explorer_view *view,
                         screen *s, area line)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    double from, to;
    view_window(model, view, &from, &to);
    const int left = map_column(e, line, from), right = map_column(e, line, to);
    for (int i = 0; i < line.width; i++) {
        if (i >= left && i <= right) {
            screen_put(s, line.x + i, line.y, GLYPH_SHADE, INK_CURSOR);
        } else {
            screen_put(s, line.x + i, line.y, GLYPH_LINE, INK_FRAME);
        }
    }

    // impacts and changes that have been seen
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const event *v = &t->events[i];
        const int at = map_column(e, line, v->time);
        if (v->kind == EVENT_IMPACT && at < line.width) {
            screen_put(s, line.x + at, line.y, GLYPH_TRIANGLE, INK_EVENT);
        } else if (event_is_input(v->kind) && at < line.width) {
            screen_put(s, line.x + at, line.y, GLYPH_DISC, INK_EVENT);
        }
    }

    // the cursor over them
    int now = map_column(e, line, e->now);
    if (now >= line.width) {
        now = line.width - 1;
    }
    screen_put(s, line.x + now, line.y, GLYPH_CURSOR, INK_TITLE);
}

// --- all of them -----------------------------------------------------------------------

void draw_lanes(const explorer_model *model, const explorer_view *view, layout *lay,
                screen *s, area a)
{
    // the map first
    if (a.height > 0 && has_map(view)) {
        const area line = area_right(area_row(a, 0), LABEL_WIDTH + 1);
        screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "whole run");
        draw_run_map(model, view, s, line);
        layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_MAP, 0, line});
        a = area_below(a, 1);
    }

    // then the lane
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LANES, 0,
                                   area_right(a, LABEL_WIDTH + 1)});
    if (a.height > 0 && model_has_law(model)) {
        screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "mode");
        draw_modes(model, view, s, area_right(area_row(a, 0), LABEL_WIDTH + 1));
    }
}

// The lane below the curves, on their time axis: the modes of the law.
#include "ui/explorer/panels/plot.h"

#include <math.h>
#include <string.h>

enum { FEWEST_CURVES = 20 }; // rows that lanes leave to the curves and their axis

int lanes_rows(const explorer_model *model, int height)
{
    return model_has_law(model) && height > FEWEST_CURVES ? 1 : 0;
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

// A band for each mode that the law was in, as far as the run has been seen.
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
        if (i < line.width && time <= e->seen) {
            const double until = fmin(end, e->seen);
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

// --- the lane --------------------------------------------------------------------------

void draw_lanes(const explorer_model *model, const explorer_view *view, layout *lay,
                screen *s, area a)
{
    layout_add_hit(lay, (hit_area){PANEL_CURVES, PART_LANES, 0,
                                   area_right(a, LABEL_WIDTH + 1)});
    if (a.height > 0 && model_has_law(model)) {
        screen_text(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "mode");
        draw_modes(model, view, s, area_right(area_row(a, 0), LABEL_WIDTH + 1));
    }
}

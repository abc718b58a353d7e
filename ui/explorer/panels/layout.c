#include "ui/explorer/panels/layout.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

void draw_number(char *text, size_t size, double value)
{
    assert(text != NULL);
    if (!isfinite(value)) {
        snprintf(text, size, "-");
    } else if (fabs(value) < NOTHING) {
        snprintf(text, size, "0");
    } else if (fabs(value) < 1e-3 || fabs(value) >= 1e5) {
        snprintf(text, size, "%.2e", value);
    } else {
        snprintf(text, size, "%.4g", value);
    }
}

int draw_first_line(int selected, int count, int height)
{
    int first = selected - height / 2;
    first = first > count - height ? count - height : first;
    return first < 0 ? 0 : first;
}

area page_area(area body, int width, int height)
{
    width = width > body.width - 2 ? body.width - 2 : width;
    height = height > body.height ? body.height : height;
    return (area){body.x + (body.width - width) / 2, body.y + (body.height - height) / 2, width,
                  height};
}

void layout_begin(layout *lay, const explorer_state *st)
{
    assert(lay != NULL && st != NULL);
    lay->hit_count = 0;
    lay->plot = (area){0};
    lay->stage = (arm_stage){0};
    lay->page_lines = st->page.lines;
    lay->first_scenario = st->scenarios.first;
    memcpy(lay->scroll, st->scroll, sizeof lay->scroll);
}

void layout_add_hit(layout *lay, hit_area hit)
{
    assert(lay != NULL);
    if (lay->hit_count < HIT_AREAS) {
        lay->hits[lay->hit_count++] = hit;
    }
}

bool area_holds(area a, int x, int y)
{
    return x >= a.x && x < a.x + a.width && y >= a.y && y < a.y + a.height;
}

hit_area layout_hit(const layout *lay, int x, int y)
{
    assert(lay != NULL);
    for (int i = lay->hit_count; i-- > 0;) {
        if (area_holds(lay->hits[i].area, x, y)) {
            return lay->hits[i];
        }
    }
    return (hit_area){.panel = PANEL_NONE};
}

int layout_keep_scroll(layout *lay, panel_id panel, int last)
{
    assert(lay != NULL && panel > PANEL_NONE && panel < PANEL_IDS);
    int *scroll = &lay->scroll[panel];
    *scroll = *scroll > last ? last : *scroll;
    *scroll = *scroll < 0 ? 0 : *scroll;
    return *scroll;
}

void layout_settle(const layout *lay, explorer_state *st)
{
    assert(lay != NULL && st != NULL);
    st->page.lines = lay->page_lines;
    st->scenarios.first = lay->first_scenario;
    memcpy(st->scroll, lay->scroll, sizeof st->scroll);
    st->stage = lay->stage;
}

// What panels have in common: lines of runs, numbers, places for the mouse, pages that
// are scrolled and pages that are lists.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <limits.h>
#include <math.h>

int pointer_wheel(pointer_event e)
{
    if (e.kind == POINTER_WHEEL_UP) {
        return -1;
    }
    if (e.kind == POINTER_WHEEL_DOWN) {
        return 1;
    }
    return 0;
}

// --- lines -----------------------------------------------------------------------------

enum { PERIOD = 16 }; // dots of a pattern

unsigned style_pattern(line_style style)
{
    static const unsigned patterns[] = {[LINE_SOLID] = 0xffff,
                                        [LINE_DASHED] = 0x1f1f,
                                        [LINE_DOTTED] = 0x3333,
                                        [LINE_DASH_DOT] = 0xefef};
    return patterns[style];
}

unsigned run_pattern(int index)
{
    static const unsigned patterns[] = {0x1f1f, 0x3333, 0x0fff, 0x1111,
                                        0x33ff, 0x0333, 0x0101};
    enum { PATTERNS = sizeof patterns / sizeof patterns[0] };
    assert(index >= 0);
    return patterns[index % PATTERNS];
}

ink run_ink(int index)
{
    return (ink)(INK_SERIES_0 + (index + 1) % 8);
}

bool line_has_dot(unsigned pattern, long across)
{
    return (pattern >> (unsigned)((across % PERIOD + PERIOD) % PERIOD) & 1u) != 0;
}

void draw_line_sample(screen *s, int x, int y, int cells, unsigned pattern, ink colour)
{
    const canvas line = {s, x, y, cells, 1};
    for (int i = 0; i < 2 * cells; i++) {
        if (line_has_dot(pattern, i)) {
            canvas_dot(&line, i, 2, colour);
        }
    }
}

// --- the layout ------------------------------------------------------------------------

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

number_text draw_number(double value)
{
    number_text n = {"-"};
    const double size = fabs(value);
    const char *form = "0";
    if (!(size < NOTHING)) {
        if (size < 1e-3 || size >= 1e5) {
            form = "%.2e";
        } else {
            form = "%.4g";
        }
    }
    if (isfinite(value)) {
        snprintf(n.text, sizeof n.text, form, value);
    }
    return n;
}

int draw_first_line(int selected, int count, int height)
{
    int first = selected - height / 2;
    if (first > count - height) {
        first = count - height;
    }
    if (first < 0) {
        return 0;
    }
    return first;
}

int time_column(const explorer_model *model, const explorer_view *view, area line,
                double time)
{
    double from, to;
    view_window(model, view, &from, &to);
    const double at = (time - from) / (to - from) * line.width;
    if (at >= 0 && at < line.width) {
        return line.x + (int)at;
    }
    return -1;
}

area page_area(area body, int width, int height)
{
    if (width > body.width - 2) {
        width = body.width - 2;
    }
    if (height > body.height) {
        height = body.height;
    }
    return (area){body.x + (body.width - width) / 2, body.y + (body.height - height) / 2,
                  width, height};
}

void layout_add_hit(layout *lay, hit_area hit)
{
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
    for (int i = lay->hit_count; i-- > 0;) {
        if (area_holds(lay->hits[i].area, x, y)) {
            return lay->hits[i];
        }
    }
    return (hit_area){.panel = PANEL_NONE};
}

int layout_keep_scroll(layout *lay, panel_id id, int last)
{
    assert(id > PANEL_NONE && id < PANEL_IDS);
    int *scroll = &lay->drawn.scroll[id];
    if (*scroll > last) {
        *scroll = last;
    }
    if (*scroll < 0) {
        *scroll = 0;
    }
    return *scroll;
}

// --- pages -----------------------------------------------------------------------------

bool page_key(explorer_model *model, explorer_view *view, explorer_input *input, int key)
{
    (void)input;
    assert(view->page != PANEL_NONE);
    int *scroll = &view->drawn.scroll[view->page];
    const int lines = view->drawn.page_lines;

    // drawing keeps it within the page
    if (key == KEY_CODE_DOWN || key == 'j' || key == KEY_CODE_PAGE_DOWN || key == ' ') {
        if (key == KEY_CODE_DOWN || key == 'j') {
            *scroll += 1;
        } else {
            *scroll += lines;
        }
    } else if (key == KEY_CODE_UP || key == 'k' || key == KEY_CODE_PAGE_UP) {
        const int by = key == KEY_CODE_PAGE_UP ? lines : 1;
        if (*scroll > by) {
            *scroll = *scroll - by;
        } else {
            *scroll = 0;
        }
    } else if (key == KEY_CODE_END || key == 'G') {
        *scroll = INT_MAX / 2;
    } else if (key == KEY_CODE_HOME || key == 'g') {
        *scroll = 0;
    } else if (key == '/' && view->page == PANEL_HELP) {
        return act_filter(model, view, "");
    } else if (key == KEY_CODE_ESCAPE && view->filters.text[view->page][0] != '\0') {
        view->filters.text[view->page][0] = '\0';
    } else {
        view->page = PANEL_NONE;
    }
    return true;
}

int page_scroll(layout *lay, panel_id id, area a, int lines, int head)
{
    const int shown = a.height - head, beyond = lines - shown;
    if (shown > 1) {
        lay->drawn.page_lines = shown - 1;
    } else {
        lay->drawn.page_lines = 1;
    }
    layout_add_hit(lay, (hit_area){.panel = id, .area = a});
    return layout_keep_scroll(lay, id, beyond > 0 ? beyond : 0);
}

// --- lists -----------------------------------------------------------------------------

void list_draw(const page_list *list, const explorer_model *model,
               const explorer_view *view, layout *lay, screen *s, area body)
{
    const int count = list->count(model), selected = list->selected(model, view);
    const int edges = 2 + list->head + list->foot;
    const area a =
        page_area(body, list->width, edges + (count > 0 ? count : list->least));
    const area lines = {a.x + 1, a.y + 1 + list->head, a.width - 2, a.height - edges};
    const int first = draw_first_line(selected, count, lines.height);
    const char *title = list->title;
    if (count == 0 && list->empty != NULL) {
        title = list->empty;
    } else if (a.width < 60 && list->narrow != NULL) {
        title = list->narrow;
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, title);
    list->draw_rest(model, s, (area){a.x + 2, a.y + 1, a.width - 4, a.height - 2});

    // the lines lie over the page, so a click meets them first
    layout_add_hit(lay, (hit_area){view->page, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){view->page, PART_LINES, first, lines});
    for (int i = first; i < count && i - first < lines.height; i++) {
        const area line = {lines.x + 1, lines.y + i - first, lines.width - 2, 1};
        list->draw_line(model, s, line, i);
        if (i == selected) {
            screen_tint(s, lines.x, line.y, lines.width, 1, INK_SELECTED);
        }
    }
}

bool list_point(const page_list *list, explorer_model *model, explorer_view *view,
                const panel_gesture *g)
{
    const int index = g->hit.index + g->event.y - g->hit.area.y;
    const bool pressed = g->event.kind == POINTER_PRESS && g->hit.part == PART_LINES;
    if (pressed && index < list->count(model)) {
        list->select(model, view, index);
    }
    return pressed;
}

bool list_key_pressed(const page_list *list, explorer_model *model, explorer_view *view,
                      explorer_input *input, int key)
{
    const int count = list->count(model), selected = list->selected(model, view);

    // up and down
    int by = 0;
    if (key == KEY_CODE_UP || key == 'k') {
        by = -1;
    } else if (key == KEY_CODE_DOWN || key == 'j') {
        by = 1;
    }
    if (by != 0) {
        if (selected + by >= 0 && selected + by < count) {
            list->select(model, view, selected + by);
        }
        return true;
    }

    // all others are the list's, unless they need a line and there is none
    if (count == 0 && list->needs_lines) {
        view->page = PANEL_NONE;
        return true;
    }
    return list->key(model, view, input, key, selected);
}

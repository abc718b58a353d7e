// What panels have in common: lines of runs, areas of cells, numbers, places for the
// mouse, pages that are scrolled and pages that are lists.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>

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

int gesture_line(const panel_gesture *g)
{
    return g->hit.index + g->event.y - g->hit.area.y;
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

bool line_has_dot(unsigned pattern, long across)
{
    // a column to the left of the first is one of the pattern before
    long dot = across % PERIOD;
    if (dot < 0) {
        dot += PERIOD;
    }
    return (pattern >> dot & 1u) != 0;
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

// --- areas -----------------------------------------------------------------------------

bool area_holds(area a, int x, int y)
{
    return x >= a.x && x < a.x + a.width && y >= a.y && y < a.y + a.height;
}

area area_inside(area a)
{
    return (area){a.x + 2, a.y + 1, a.width - 4, a.height - 2};
}

area area_row(area a, int row)
{
    return (area){a.x, a.y + row, a.width, 1};
}

area area_right(area a, int columns)
{
    return (area){a.x + columns, a.y, a.width - columns, a.height};
}

area area_below(area a, int rows)
{
    return (area){a.x, a.y + rows, a.width, a.height - rows};
}

void area_frame(screen *s, area a, ink colour, const char *title)
{
    screen_frame(s, a.x, a.y, a.width, a.height, colour, title);
}

void area_tint(screen *s, area a, ink colour)
{
    screen_tint(s, a.x, a.y, a.width, a.height, colour);
}

int area_text(screen *s, area a, ink colour, const char *text)
{
    return screen_text(s, a.x, a.y, a.width, colour, text);
}

int area_words(screen *s, area a, ink colour, const char *text)
{
    return screen_words(s, a.x, a.y, a.width, colour, text);
}

int area_print(screen *s, area a, ink colour, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return area_text(s, a, colour, text);
}

void area_lines(screen *s, area a, ink colour, const text_line *lines, int count)
{
    for (int i = 0; i < count && i < a.height; i++) {
        area_print(s, area_row(a, i), colour, "%.*s", lines[i].bytes, lines[i].start);
    }
}

// --- numbers and places ----------------------------------------------------------------

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

number_text draw_number(double value)
{
    number_text n = {"-"};
    const double size = fabs(value);
    if (!isfinite(value)) {
        return n;
    }
    if (size < NOTHING) {
        snprintf(n.text, sizeof n.text, "0");
    } else if (size < 1e-3 || size >= 1e5) {
        snprintf(n.text, sizeof n.text, "%.2e", value);
    } else {
        snprintf(n.text, sizeof n.text, "%.4g", value);
    }
    return n;
}

bool event_is_input(event_kind kind)
{
    return kind == EVENT_CHANGE || kind == EVENT_PUSH;
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
    // a column is left free on both sides
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

// The line to which a key scrolls a page with so many lines on a screen, -1 if it does
// not; drawing keeps it within the page.
static int scroll_after(int key, int scroll, int page_lines)
{
    switch (key) {
    case KEY_CODE_DOWN:
    case 'j':
        return scroll + 1;
    case KEY_CODE_PAGE_DOWN:
    case ' ':
        return scroll + page_lines;
    case KEY_CODE_UP:
    case 'k':
        return scroll > 1 ? scroll - 1 : 0;
    case KEY_CODE_PAGE_UP:
        return scroll > page_lines ? scroll - page_lines : 0;
    case KEY_CODE_END:
    case 'G':
        return INT_MAX / 2;
    case KEY_CODE_HOME:
    case 'g':
        return 0;
    default:
        return -1;
    }
}

bool page_key(explorer_model *model, explorer_view *view, explorer_input *input, int key)
{
    (void)input;
    assert(view->page != PANEL_NONE);
    int *scroll = &view->drawn.scroll[view->page];
    char *filter = view->filters.text[view->page];

    const int to = scroll_after(key, *scroll, view->drawn.page_lines);
    if (to >= 0) {
        *scroll = to;
        return true;
    }
    if (key == '/' && view->page == PANEL_HELP) {
        return act_filter(model, view, "");
    }

    // Esc shows all lines again, then closes the page, as any other key does
    if (key == KEY_CODE_ESCAPE && filter[0] != '\0') {
        filter[0] = '\0';
    } else {
        view->page = PANEL_NONE;
    }
    return true;
}

int page_scroll(layout *lay, panel_id id, area a, int lines, int head)
{
    // a screen further leaves one line in sight
    const int shown = a.height - head;
    lay->drawn.page_lines = shown > 1 ? shown - 1 : 1;
    layout_add_hit(lay, (hit_area){.panel = id, .area = a});
    return layout_keep_scroll(lay, id, lines - shown);
}

// --- lists -----------------------------------------------------------------------------

// The title of a list for so many lines on a page of this width [cells].
static const char *list_title(const page_list *list, int count, int width)
{
    enum { NARROW = 60 };
    if (count == 0 && list->empty_title != NULL) {
        return list->empty_title;
    }
    if (width < NARROW && list->narrow_title != NULL) {
        return list->narrow_title;
    }
    return list->title;
}

void list_draw(const page_list *list, const explorer_model *model,
               const explorer_view *view, layout *lay, screen *s, area body)
{
    const int count = list->count(model), selected = list->selected(model, view);

    // as high as its lines and edges, if there is room
    const int edges = 2 + list->head + list->foot;
    const int wanted = count > 0 ? count : list->least_lines;
    const area a = page_area(body, list->most_width, edges + wanted);
    area_frame(s, a, INK_CURSOR, list_title(list, count, a.width));
    list->draw_edges(model, s, area_inside(a));

    // the lines lie over the page, so a click meets them first
    const area lines = {a.x + 1, a.y + 1 + list->head, a.width - 2, a.height - edges};
    const int first = draw_first_line(selected, count, lines.height);
    layout_add_hit(lay, (hit_area){view->page, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){view->page, PART_LINES, first, lines});
    for (int i = first; i < count && i - first < lines.height; i++) {
        const area line = area_row(lines, i - first);
        list->draw_line(model, s, (area){line.x + 1, line.y, line.width - 2, 1}, i);
        if (i == selected) {
            area_tint(s, line, INK_SELECTED);
        }
    }
}

bool list_point(const page_list *list, explorer_model *model, explorer_view *view,
                const panel_gesture *g)
{
    if (g->event.kind != POINTER_PRESS || g->hit.part != PART_LINES) {
        return false;
    }
    const int index = gesture_line(g);
    if (index < list->count(model)) {
        list->select(model, view, index);
    }
    return true;
}

bool list_press_key(const page_list *list, explorer_model *model, explorer_view *view,
                    explorer_input *input, int key)
{
    const int count = list->count(model), selected = list->selected(model, view);

    // up and down
    int to = selected;
    if (key == KEY_CODE_UP || key == 'k') {
        to = selected - 1;
    } else if (key == KEY_CODE_DOWN || key == 'j') {
        to = selected + 1;
    }
    if (to != selected) {
        if (to >= 0 && to < count) {
            list->select(model, view, to);
        }
        return true;
    }

    // all others are the list's, unless they need a line and there is none
    if (count == 0 && list->needs_lines) {
        view->page = PANEL_NONE;
        return true;
    }
    return list->press_key(model, view, input, key, selected);
}

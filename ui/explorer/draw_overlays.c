// What opens over the panels: help, list of scenarios, comparison.
#include "ui/explorer/draw.h"

#include <math.h>

static area middle_of(const screen *s, int width, int height)
{
    width = width > s->width - 2 ? s->width - 2 : width;
    height = height > s->height - 3 ? s->height - 3 : height;
    return (area){(s->width - width) / 2, 1 + (s->height - 3 - height) / 2, width, height};
}

void draw_help(lab *l, screen *s)
{
    enum { MOST = 400 };
    static lab_help_line lines[MOST];
    area a = middle_of(s, 114, s->height);
    int count = lab_write_help(l, a.width - 4, lines, MOST);
    a = middle_of(s, 114, count + 2);
    int shown = a.height - 2, last = count > shown ? count - shown : 0;
    l->scroll = l->scroll > last ? last : l->scroll < 0 ? 0 : l->scroll;
    l->page_lines = shown > 1 ? shown - 1 : 1;
    char title[LAB_TEXT];
    snprintf(title, sizeof title,
             last == 0      ? "keys and commands (Esc closes)"
             : a.width < 60 ? "%d of %d lines (Esc closes)"
                            : "keys and commands, %d of %d lines (arrows scroll, Esc closes)",
             l->scroll + shown, count);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, title);
    draw_spot(l, PART_HELP, a, 0);
    for (int i = 0; i < shown && l->scroll + i < count; i++) {
        const lab_help_line *line = &lines[l->scroll + i];
        int x = a.x + 2, y = a.y + 1 + i, room = a.width - 4;
        screen_text(s, x, y, room, line->heading ? INK_EVENT : INK_TEXT, line->text);
        screen_tint(s, x, y, line->keys < room ? line->keys : room, 1, INK_TITLE);
    }
}

void draw_list(lab *l, screen *s)
{
    int count = 0, selected = 0, line = 0;
    for (int i = 0; i < l->name_count; i++) {
        selected = i == l->scroll ? count : selected;
        count += lab_listed(l, i);
    }
    area a = middle_of(s, 96, l->name_count + 4);
    int height = a.height - 4, first = l->list_first;
    // it moves only as far as it must, so that a second click meets what the first one selected
    first = first < 0                    ? draw_first_line(selected, count, height)
            : selected < first           ? selected
            : selected >= first + height ? selected - height + 1
                                         : first;
    first = first > count - height ? count - height : first;
    first = first < 0 ? 0 : first;
    l->list_first = first;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 "scenarios (Enter opens, / filters, Esc closes)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "/ filter: %s%s", l->filter,
                 l->filtering ? "_" : "");
    l->page_lines = height > 1 ? height - 1 : 1;
    draw_spot(l, PART_HELP, a, 0);
    draw_spot(l, PART_LIST, (area){a.x + 1, a.y + 3, a.width - 2, height}, first);
    for (int i = 0; i < l->name_count; i++) {
        if (!lab_listed(l, i)) {
            continue;
        }
        int y = a.y + 3 + line++ - first;
        if (y < a.y + 3 || y >= a.y + a.height - 1) {
            continue;
        }
        int used = screen_text(s, a.x + 2, y, a.width - 4, INK_TEXT, l->names[i]);
        int column = used + 2 > 30 ? used + 2 : 30;
        // as many whole words of the title as there is room for
        text_line title;
        int room = a.width - 4 - column;
        if (room > 0 && text_wrap(lab_title(l, i), room, &title, 1, NULL) > 0) {
            screen_print(s, a.x + 2 + column, y, room, INK_DIM, "%.*s", title.bytes, title.start);
        }
        if (i == l->scroll) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

// A quantity of the comparison as a name and as columns; returns whether it means anything in
// either run.
static bool compare_quantity(const session *e, int index, int width, char *columns, size_t size,
                             bool *differs)
{
    double value = summary_value(&e->run.summary, index), other = (double)NAN;
    char one[32], two[32] = "", change[32] = "";
    draw_number(one, sizeof one, value);
    if (e->has_other) {
        other = summary_value(&e->other.summary, index);
        draw_number(two, sizeof two, other);
        draw_number(change, sizeof change, value - other);
    }
    *differs = e->has_other && !(isnan(value) && isnan(other)) &&
               !(fabs(value - other) <= 1e-6 * fmax(fabs(value), fabs(other)));
    snprintf(columns, size, "%*s%*s%*s", width, one, width, two, width, change);
    return !summary_table[index].timing && !(isnan(value) && isnan(other));
}

void draw_comparison(lab *l, screen *s)
{
    enum { NAMES = 28, WIDE = 12, NARROW = 11 };
    const session *e = &l->session;
    char columns[128];
    bool differs;
    int count = 0, line = 0;
    for (int i = 0; i < summary_count; i++) {
        count += compare_quantity(e, i, WIDE, columns, sizeof columns, &differs);
    }
    // a narrow screen has the name and the numbers below each other
    int rows = s->width - 6 < NAMES + 3 * WIDE ? 2 : 1, names = rows == 1 ? NAMES : 0;
    int width = rows == 1 ? WIDE : NARROW;
    area a = middle_of(s, names + 3 * width + 4, rows * count + 3);
    int room = a.width - 4, shown = a.height - 3;
    int last = rows * count > shown ? rows * count - shown : 0;
    l->scroll = l->scroll > last ? last : l->scroll < 0 ? 0 : l->scroll;
    l->page_lines = shown > 1 ? shown - 1 : 1;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 e->has_other ? "this run beside the old one (Esc closes)"
                              : "this run (b branches, Esc closes)");
    draw_spot(l, PART_COMPARISON, a, 0);
    screen_print(s, a.x + 2 + names, a.y + 1, room - names, INK_DIM, "%*s%*s%*s", width, "this run",
                 width, e->has_other ? "old run" : "", width, e->has_other ? "change" : "");
    for (int i = 0; i < summary_count; i++) {
        if (!compare_quantity(e, i, width, columns, sizeof columns, &differs)) {
            continue;
        }
        ink colour = differs ? INK_WARNING : INK_TEXT;
        int y = rows * line++ - l->scroll, below = y + rows - 1;
        if (y >= 0 && y < shown) {
            screen_text(s, a.x + 2, a.y + 2 + y, room, colour, summary_table[i].key);
        }
        if (below >= 0 && below < shown) {
            screen_text(s, a.x + 2 + names, a.y + 2 + below, room - names, colour, columns);
        }
    }
}

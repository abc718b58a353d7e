// What opens over the panels: help, list of scenarios, comparison.
#include "ui/lab/draw.h"

#include <math.h>

static area middle_of(const screen *s, int width, int height)
{
    width = width > s->width - 2 ? s->width - 2 : width;
    height = height > s->height - 3 ? s->height - 3 : height;
    return (area){(s->width - width) / 2, 1 + (s->height - 3 - height) / 2, width, height};
}

void draw_help(lab *l, screen *s)
{
    int count = 0;
    while (lab_help_line(count) != NULL) {
        count++;
    }
    area a = middle_of(s, 110, count + 4);
    int shown = a.height - 4;
    l->scroll = l->scroll > count - shown ? count - shown : l->scroll;
    l->scroll = l->scroll < 0 ? 0 : l->scroll;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 shown < count ? "keys and commands (arrows scroll, Esc closes)"
                               : "keys and commands (Esc closes)");
    screen_text(
        s, a.x + 2, a.y + 1, a.width - 4, INK_DIM,
        "/ filters the list of scenarios; : takes a command, Tab completes it; Esc goes back");
    for (int i = 0; i < shown; i++) {
        const char *line = lab_help_line(l->scroll + i);
        if (line != NULL) {
            screen_text(s, a.x + 2, a.y + 3 + i, a.width - 4, INK_TEXT, line);
            screen_tint(s, a.x + 2, a.y + 3 + i, a.width - 4 < 27 ? a.width - 4 : 27, 1, INK_TITLE);
        }
    }
}

void draw_list(lab *l, screen *s)
{
    int count = 0, selected = 0, line = 0;
    for (int i = 0; i < l->name_count; i++) {
        selected = i == l->scroll ? count : selected;
        count += lab_listed(l, l->names[i]);
    }
    area a = middle_of(s, 60, l->name_count + 4);
    int height = a.height - 4, first = draw_first_line(selected, count, height);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, "scenarios (Enter opens)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "/ filter: %s%s", l->filter,
                 l->filtering ? "_" : "");
    for (int i = 0; i < l->name_count; i++) {
        if (!lab_listed(l, l->names[i])) {
            continue;
        }
        int y = a.y + 3 + line++ - first;
        if (y < a.y + 3 || y >= a.y + a.height - 1) {
            continue;
        }
        screen_text(s, a.x + 2, y, a.width - 4, INK_TEXT, l->names[i]);
        if (i == l->scroll) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

void draw_comparison(lab *l, screen *s)
{
    const session *e = &l->session;
    area a = middle_of(s, 76, summary_count + 4);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 e->has_other ? "this run beside the old one" : "this run (b branches)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "%-28s %11s %11s %11s", "", "this run",
                 e->has_other ? "old run" : "", e->has_other ? "change" : "");
    int line = 0;
    for (int i = 0; i < summary_count && line < a.height - 3; i++) {
        const char *key = summary_table[i].key;
        double value = (double)NAN, other = (double)NAN;
        char one[32], two[32] = "", change[32] = "";
        if (summary_table[i].timing) {
            continue;
        }
        summary_get(&e->run.summary, key, &value);
        draw_number(one, sizeof one, value);
        if (e->has_other) {
            summary_get(&e->other.summary, key, &other);
            draw_number(two, sizeof two, other);
            draw_number(change, sizeof change, value - other);
        }
        bool same = fabs(value - other) <= 1e-6 * fmax(fabs(value), fabs(other));
        bool none = isnan(value) && isnan(other);
        screen_print(s, a.x + 2, a.y + 2 + line++, a.width - 4,
                     !e->has_other || same || none ? INK_TEXT : INK_WARNING, "%-28s %11s %11s %11s",
                     key, one, two, change);
    }
}

// The help page.
#include "ui/explorer/panels/help_text.h"
#include "ui/explorer/panels/page.h"

// Keeps the lines that pass a filter; returns how many.
static int keep_matching(help_line *lines, int count, const char *filter)
{
    int kept = 0;
    for (int i = 0; i < count && filter[0] != '\0'; i++) {
        if (lines[i].text[0] != '\0' && filter_passes(filter, lines[i].text)) {
            lines[kept++] = lines[i];
        }
    }
    return filter[0] != '\0' ? kept : count;
}

static void draw(const explorer_state *st, layout *lay, screen *s, area body)
{
    enum { MOST = 500 };
    static help_line lines[MOST];
    const char *filter = st->filters.text[PANEL_HELP];

    // as wide as it may be, then as high as its lines need
    area a = page_area(body, 114, body.height);
    int count = help_write(&st->keys, a.width - 4, lines, MOST);
    count = keep_matching(lines, count, filter);
    a = page_area(body, 114, count + 2);
    int shown = a.height - 2, last = count > shown ? count - shown : 0;
    int scroll = layout_keep_scroll(lay, PANEL_HELP, last);
    lay->page_lines = shown > 1 ? shown - 1 : 1;
    char title[LINE_TEXT];
    snprintf(title, sizeof title,
             last == 0      ? "keys and commands (/ filters, Esc closes)"
             : a.width < 60 ? "%d of %d lines (Esc closes)"
                            : "keys and commands, %d of %d lines (/ filters, Esc closes)",
             scroll + shown, count);
    if (filter[0] != '\0') {
        snprintf(title, sizeof title, "keys and commands /%.200s", filter);
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, title);
    layout_add_hit(lay, (hit_area){.panel = PANEL_HELP, .area = a});
    for (int i = 0; i < shown && scroll + i < count; i++) {
        const help_line *line = &lines[scroll + i];
        int x = a.x + 2, y = a.y + 1 + i, room = a.width - 4;
        screen_text(s, x, y, room, line->heading ? INK_EVENT : INK_TEXT, line->text);
        screen_tint(s, x, y, line->keys < room ? line->keys : room, 1, INK_TITLE);
    }
}

const panel help_panel = {.name = "help", .draw = draw, .point = page_point, .key = page_key};

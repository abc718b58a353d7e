// The page that says what the scenario is about.
#include "ui/explorer/panels/page.h"

enum { LINES = 48, WIDE = 84 };

// The title, the description and the script in lines; returns how many.
static int write_lines(const explorer_state *st, int width, char lines[LINES][LINE_TEXT])
{
    const scenario *base = &st->session.base;
    const char *parts[] = {base->title, base->description};
    int count = 0;
    for (int k = 0; k < 2; k++) {
        text_line wrapped[LINES / 2];
        const char *text = parts[k] != NULL ? parts[k] : "";
        const int found = text_wrap(text, width, wrapped, LINES / 2, NULL);
        for (int i = 0; i < found && count < LINES; i++) {
            snprintf(lines[count++], LINE_TEXT, "%.*s", wrapped[i].bytes, wrapped[i].start);
        }
        if (found > 0 && count < LINES) {
            lines[count++][0] = '\0';
        }
    }

    // what its script does
    for (int i = 0; i < base->action_count && count < LINES; i++) {
        const action *a = &base->actions[i];
        char value[PARAMETER_TEXT_SIZE];
        if (a->kind == ACTION_PUSH) {
            snprintf(lines[count++], LINE_TEXT, "%9.5f s  push %g N s", a->time, a->value);
        } else {
            action_format_value(a, value, sizeof value);
            snprintf(lines[count++], LINE_TEXT, "%9.5f s  %s = %s", a->time,
                     parameter_table[a->parameter].path, value);
        }
    }
    while (count > 0 && lines[count - 1][0] == '\0') {
        count--;
    }
    return count;
}

static void draw(const explorer_state *st, layout *lay, screen *s, area body)
{
    static char lines[LINES][LINE_TEXT];
    area a = page_area(body, WIDE, body.height);
    const int count = write_lines(st, a.width - 4, lines);

    // as high as the text, or scrolled
    a = page_area(body, WIDE, count + 2);
    const int shown = a.height - 2, beyond = count - shown;
    const int scroll = layout_keep_scroll(lay, PANEL_INFO, beyond > 0 ? beyond : 0);

    // frame and lines
    char title[LINE_TEXT];
    snprintf(title, sizeof title, "%.180s (Esc closes)", st->session.base.name);
    lay->page_lines = shown > 1 ? shown - 1 : 1;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, title);
    layout_add_hit(lay, (hit_area){.panel = PANEL_INFO, .area = a});
    for (int i = 0; i < shown && scroll + i < count; i++) {
        screen_text(s, a.x + 2, a.y + 1 + i, a.width - 4, i == 0 ? INK_TITLE : INK_TEXT,
                    lines[scroll + i]);
    }
}

const panel info_panel = {.name = "info", .draw = draw, .point = page_point, .key = page_key};

// The page of notes: what was said at which instant.
#include "ui/explorer/panels/panel.h"

#include "ui/terminal/keys.h"

static void draw(const explorer_state *st, layout *lay, screen *s, area body)
{
    enum { WIDTH = 84 };
    const int count = st->note_count, height = count < 1 ? 3 : count + 2;
    const area a = page_area(body, WIDTH, height);
    const int rows = a.height - 2, first = draw_first_line(st->note, count, rows);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 count > 0 ? "notes (Enter goes there, d drops, Esc closes)"
                           : "notes (Esc closes)");
    const area lines = {a.x + 1, a.y + 1, a.width - 2, rows};
    layout_add_hit(lay, (hit_area){PANEL_NOTES, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){PANEL_NOTES, PART_LINES, first, lines});
    if (count == 0) {
        screen_text(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM,
                    "none yet: :note TEXT at an instant");
    }
    for (int i = first; i < count && i - first < rows; i++) {
        const int y = a.y + 1 + i - first;
        screen_print(s, a.x + 2, y, 11, INK_DIM, "%9.5f s", st->notes[i].time);
        screen_words(s, a.x + 15, y, a.width - 17, INK_TEXT, st->notes[i].text);
        if (i == st->note) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

static bool key(explorer_state *st, int key)
{
    const int last = st->note_count - 1;
    if (page_select(key, &st->note, st->note_count)) {
        return true;
    } else if (key == KEY_CODE_ENTER && last >= 0) {
        st->page.panel = PANEL_NONE;
        act_scrub(st, st->notes[st->note].time);
    } else if ((key == 'd' || key == 'x' || key == KEY_CODE_DELETE) && last >= 0) {
        act_drop_note(st, st->note);
    } else {
        st->page.panel = PANEL_NONE;
    }
    return true;
}

static bool point(explorer_state *st, const panel_gesture *g)
{
    return page_point_at_line(st, g, &st->note, st->note_count);
}

const panel notes_panel = {.name = "notes", .draw = draw, .point = point, .key = key};

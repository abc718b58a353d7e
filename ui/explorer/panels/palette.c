// The palette above the prompt: what fits to the words that are being typed.
#include "ui/explorer/panels/panel.h"

enum { MOST_ROWS = 12, WIDE = 110, KEYS = 16, KIND = 10 };

// Kind, name, keys and meaning of an entry in a line.
static void draw_entry(const explorer_view *view, screen *s, area a, palette_entry entry)
{
    const palette_text text = palette_describe(&view->scenarios, &view->keys, entry);
    const bool wide = a.width >= 70;
    const int name = wide ? 30 : 26;
    int x = a.x;

    // a narrow screen leaves the kind out
    if (wide) {
        screen_text(s, x, a.y, KIND, INK_FRAME, text.kind);
        x += KIND;
    }
    const bool command = entry.kind == PALETTE_COMMAND;
    screen_print(s, x, a.y, name - 1, INK_TITLE, "%s%s", command ? ":" : "", text.name);
    x += name;
    if (wide) {
        screen_text(s, x, a.y, KEYS - 1, INK_EVENT, text.keys);
        x += KEYS;
    }
    screen_text(s, x, a.y, a.x + a.width - x, INK_DIM, text.about);
}

// Draws the palette into the rows above the prompt, at the bottom of the area.
void draw_palette(const explorer_view *view, const prompt *p, layout *lay, screen *s,
                  area a)
{
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(&view->scenarios, &view->keys, p->text, entries);
    const int most = a.height - 4 < MOST_ROWS ? a.height - 4 : MOST_ROWS;
    const int rows = count < most ? count : most;
    const int width = s->width < WIDE ? s->width : WIDE;
    char title[64];

    // while only a first word is typed a list without entries would be in the way
    if (rows < 1 && !p->searches) {
        return;
    }
    const int height = (rows > 0 ? rows : 1) + 2;
    const area box = {0, a.y + a.height - height, width, height};
    snprintf(title, sizeof title,
             "%d of all (\u2191 \u2193 choose, Enter takes, Esc closes)", count);
    screen_frame(s, box.x, box.y, box.width, box.height, INK_CURSOR, title);
    if (rows < 1) {
        screen_text(s, box.x + 2, box.y + 1, width - 4, INK_DIM,
                    "nothing has these words");
    }

    // the selected one is always among them
    const int selected =
        view->palette.selected < count ? view->palette.selected : count - 1;
    const int first = selected >= rows ? selected - rows + 1 : 0;
    const area lines = {box.x + 1, box.y + 1, width - 2, rows};
    layout_add_hit(lay, (hit_area){PANEL_PALETTE, PART_BODY, 0, box});
    layout_add_hit(lay, (hit_area){PANEL_PALETTE, PART_LINES, first, lines});
    for (int i = 0; i < rows; i++) {
        draw_entry(view, s, (area){lines.x + 1, lines.y + i, lines.width - 2, 1},
                   entries[first + i]);
        if (first + i == selected) {
            screen_tint(s, lines.x, lines.y + i, lines.width, 1, INK_SELECTED);
        }
    }
}

// A click takes an entry, the wheel moves the selection.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    (void)model;
    const bool picked = g->event.kind == POINTER_PRESS && g->hit.part == PART_LINES;
    const int wheel = pointer_wheel(g->event);
    if (picked) {
        view->palette = (palette_view){g->hit.index + g->event.y - g->hit.area.y, true};
    } else if (wheel != 0) {
        act_move_in_palette(view, input, wheel);
    }
    return picked || wheel != 0;
}

const panel palette_panel = {.name = "palette", .point = point};

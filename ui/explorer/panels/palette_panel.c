// The palette above the prompt: what fits to the words that are being typed.
#include "ui/explorer/panels/panel.h"

enum { MOST_ENTRIES = 12, MOST_WIDTH = 110 };

// Columns of a line [cells]: all four, or a name and its meaning.
enum { WIDE = 70, KIND = 10, NAME = 30, KEYS = 16, NARROW_NAME = 26 };

// An entry in a line: kind, name, keys and meaning, or only name and meaning.
static void draw_palette_entry(const explorer_model *model, const explorer_view *view,
                               screen *s, area line, palette_entry entry)
{
    const palette_text text = palette_describe(model, view, entry);
    const bool wide = line.width >= WIDE;
    const int name_width = wide ? NAME : NARROW_NAME;
    if (wide) {
        screen_text(s, line.x, line.y, KIND, INK_FRAME, text.kind);
        line = area_right(line, KIND);
    }

    const char *colon = entry.kind == PALETTE_COMMAND ? ":" : "";
    screen_print(s, line.x, line.y, name_width - 1, INK_TITLE, "%s%s", colon, text.name);
    line = area_right(line, name_width);
    if (wide) {
        screen_text(s, line.x, line.y, KEYS - 1, INK_EVENT, text.keys);
        line = area_right(line, KEYS);
    }
    area_text(s, line, INK_DIM, text.about);
}

// The lines of the palette, among which the selected one always is.
static void draw_palette_lines(const explorer_model *model, const explorer_view *view,
                               layout *lay, screen *s, area lines,
                               const palette_entry *entries, int count)
{
    const int rows = lines.height;
    int selected = view->palette.selected, first = 0;
    if (selected >= count) {
        selected = count - 1;
    }
    if (selected >= rows) {
        first = selected - rows + 1;
    }
    layout_add_hit(lay, (hit_area){PANEL_PALETTE, PART_LINES, first, lines});
    for (int i = 0; i < rows; i++) {
        const area row = area_row(lines, i);
        draw_palette_entry(model, view, s, (area){row.x + 1, row.y, row.width - 2, 1},
                           entries[first + i]);
        if (first + i == selected) {
            area_tint(s, row, INK_SELECTED);
        }
    }
}

void draw_palette(const explorer_model *model, const explorer_view *view, const prompt *p,
                  layout *lay, screen *s, area a)
{
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(model, view, p->text, entries);

    // while only a first word is typed a list without entries would be in the way; what
    // can be opened is looked through, and has all the room there is
    int rows = count;
    if (rows > MOST_ENTRIES && view->palette.scope == SCOPE_ALL) {
        rows = MOST_ENTRIES;
    }
    if (rows > a.height - 4) {
        rows = a.height - 4;
    }
    if (rows < 1 && !p->searches) {
        return;
    }

    // a frame at the bottom of the area, with a line for words where there is no entry
    char title[64];
    const int width = s->width < MOST_WIDTH ? s->width : MOST_WIDTH;
    const int height = rows > 0 ? rows + 2 : 3;
    const area frame = {0, a.y + a.height - height, width, height};
    snprintf(title, sizeof title,
             "%d of all (\u2191 \u2193 choose, Enter takes, Esc closes)", count);
    area_frame(s, frame, INK_CURSOR, title);
    if (rows < 1) {
        area_text(s, area_inside(frame), INK_DIM, "nothing has these words");
    }

    // the lines lie over it, so a click meets them first
    const area lines = {frame.x + 1, frame.y + 1, width - 2, rows};
    layout_add_hit(lay, (hit_area){PANEL_PALETTE, PART_BODY, 0, frame});
    draw_palette_lines(model, view, lay, s, lines, entries, count);
}

// A click takes an entry, the wheel moves the selection.
static bool point_at_palette(explorer_model *model, explorer_view *view,
                             explorer_input *input, const panel_gesture *g)
{
    const int wheel = pointer_wheel(g->event);
    if (g->event.kind == POINTER_PRESS && g->hit.part == PART_LINES) {
        view->palette.selected = gesture_line(g);
        view->palette.picked = true;
        return true;
    }
    if (wheel != 0) {
        act_move_in_palette(model, view, input, wheel);
    }
    return wheel != 0;
}

const panel palette_panel = {.name = "palette", .point = point_at_palette};

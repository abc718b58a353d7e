// The page of changes: what was done to the run, in the order it was done, with its instant.
#include "ui/explorer/panels/panel.h"
#include "ui/terminal/keys.h"

static void draw_change(const explorer_state *st, screen *s, area a, int index)
{
    const session_input *in = &st->session.inputs[index];
    const bool later = in->kind != SESSION_INPUT_START && in->time > st->session.now;
    const ink colour = later ? INK_DIM : INK_TEXT;
    char text[LINE_TEXT], when[32] = "from the start";

    // what is in force from the start has no instant
    if (in->kind != SESSION_INPUT_START) {
        snprintf(when, sizeof when, "%9.5f s", in->time);
    }

    // what is still to come is hollow and dim
    state_change_text(st, index, text, sizeof text);
    screen_print(s, a.x, a.y, 5, INK_DIM, "%3d %s", index + 1, later ? "\u25cb" : "\u25cf");
    screen_text(s, a.x + 6, a.y, 15, colour, when);
    screen_text(s, a.x + 22, a.y, a.width - 22, colour, text);
    if (index == st->change) {
        screen_tint(s, a.x - 1, a.y, a.width + 2, 1, INK_SELECTED);
    }
}

static void draw(const explorer_state *st, layout *lay, screen *s, area body)
{
    const int count = st->session.input_count;
    const area a = page_area(body, 76, count < 1 ? 4 : count + 3);
    const int height = a.height - 3, first = draw_first_line(st->change, count, height);

    // the frame, with what its keys do
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 a.width < 60 ? "changes (d drops, Esc closes)"
                              : "changes (Enter edits, d drops, g goes there, Esc closes)");
    screen_text(s, a.x + 2, a.y + a.height - 2, a.width - 4, INK_DIM,
                count > 0 ? "\u25cb takes effect after the cursor"
                          : "none yet: Enter changes a value, p pushes");

    // the lines lie over the page, so a click meets them first
    const area lines = {a.x + 1, a.y + 1, a.width - 2, height};
    layout_add_hit(lay, (hit_area){PANEL_CHANGES, PART_BODY, 0, a});
    layout_add_hit(lay, (hit_area){PANEL_CHANGES, PART_LINES, first, lines});
    for (int i = first; i < count && i - first < height; i++) {
        draw_change(st, s, (area){a.x + 2, lines.y + i - first, a.width - 4, 1}, i);
    }
}

static bool list_key(explorer_state *st, int key)
{
    const session *s = &st->session;
    char number[16];

    // keys move the selection or do something with the change
    snprintf(number, sizeof number, "%d", st->change + 1);
    if (page_select(key, &st->change, s->input_count)) {
        return true;
    } else if (key == KEY_CODE_ENTER) {
        return act_change(st, number);
    } else if (key == 'd' || key == 'x' || key == KEY_CODE_DELETE) {
        return act_drop(st, number);
    } else if (key == 'u') {
        return act_undo(st, "");
    } else if (key == 'U' || key == ('r' & 0x1f)) {
        return act_redo(st, "");
    } else if (key == 'g' && st->change < s->input_count) {
        act_scrub(st, s->inputs[st->change].time);
        st->page.panel = PANEL_NONE;
    } else {
        st->page.panel = PANEL_NONE;
    }

    // the selection stays within the list
    const int last = s->input_count > 0 ? s->input_count - 1 : 0;
    st->change = st->change > last ? last : st->change;
    return true;
}

static bool point(explorer_state *st, const panel_gesture *g)
{
    return page_point_at_line(st, g, &st->change, st->session.input_count);
}

const panel changes_panel = {.name = "changes", .draw = draw, .point = point, .key = list_key};

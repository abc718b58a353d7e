// The page of notes: what was said at which instant.
#include "ui/explorer/panels/panel.h"

static void draw_line(const explorer_state *st, screen *s, area a, int index)
{
    screen_print(s, a.x, a.y, 11, INK_DIM, "%9.5f s", st->notes[index].time);
    screen_words(s, a.x + 13, a.y, a.width - 13, INK_TEXT, st->notes[index].text);
}

static void draw_rest(const explorer_state *st, screen *s, area a)
{
    if (st->note_count == 0) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "none yet: :note TEXT at an instant");
    }
}

static bool go_there(explorer_state *st, const char *number)
{
    (void)number;
    act_scrub(st, st->notes[st->note].time);
    return true;
}

static bool drop(explorer_state *st, const char *number)
{
    (void)number;
    act_drop_note(st, st->note);
    return true;
}

static const page_list list = {.title = "notes (Enter goes there, d drops, Esc closes)",
                               .empty = "notes (Esc closes)",
                               .width = 84,
                               .least = 1,
                               .needs_lines = true,
                               .count = offsetof(explorer_state, note_count),
                               .selected = offsetof(explorer_state, note),
                               .draw_line = draw_line,
                               .draw_rest = draw_rest,
                               .keys = {{KEY_CODE_ENTER, go_there, true},
                                        {'d', drop},
                                        {'x', drop},
                                        {KEY_CODE_DELETE, drop}}};

const panel notes_panel = {.name = "notes", .list = &list};

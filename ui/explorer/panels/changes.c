// The page of changes: what was done to the run, in the order it was done, with its
// instant.
#include "ui/explorer/panels/panel.h"

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
    screen_print(s, a.x, a.y, 5, INK_DIM, "%3d %s", index + 1,
                 later ? "\u25cb" : "\u25cf");
    screen_text(s, a.x + 6, a.y, 15, colour, when);
    screen_text(s, a.x + 22, a.y, a.width - 22, colour, text);
}

static void draw_rest(const explorer_state *st, screen *s, area a)
{
    screen_text(s, a.x, a.y + a.height - 1, a.width, INK_DIM,
                st->session.input_count > 0
                    ? "\u25cb takes effect after the cursor"
                    : "none yet: Enter changes a value, p pushes");
}

static bool go_there(explorer_state *st, const char *number)
{
    (void)number;
    if (st->change < st->session.input_count) {
        act_scrub(st, st->session.inputs[st->change].time);
    }
    return true;
}

static const page_list list = {
    .title = "changes (Enter edits, d drops, g goes there, Esc closes)",
    .narrow = "changes (d drops, Esc closes)",
    .width = 76,
    .foot = 1,
    .least = 1,
    .count = offsetof(explorer_state, session.input_count),
    .selected = offsetof(explorer_state, change),
    .draw_line = draw_change,
    .draw_rest = draw_rest,
    .keys = {{KEY_CODE_ENTER, act_change},
             {'d', act_drop},
             {'x', act_drop},
             {KEY_CODE_DELETE, act_drop},
             {'u', act_undo},
             {'U', act_redo},
             {'r' & 0x1f, act_redo},
             {'g', go_there, true}}};

const panel changes_panel = {.name = "changes", .list = &list};

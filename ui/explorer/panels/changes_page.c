// The page of changes: what was done to the run, in the order it was done, with its
// instant.
#include "ui/explorer/panels/panel.h"

// A change in a line: its number, a sign, its instant and what it changes.
static void draw_input(const explorer_model *model, screen *s, area a, int index)
{
    enum { WHEN_AT = 6, WHEN = 15, WHAT_AT = 22 }; // columns
    const session_input *in = &model->session.inputs[index];

    // what is in force from the start has no instant
    char text[LINE_TEXT], when[32] = "from the start";
    if (in->kind != SESSION_INPUT_START) {
        snprintf(when, sizeof when, "%9.5f s", in->time);
    }

    // what is still to come is hollow and dim
    const char *sign = "\u25cf";
    ink colour = INK_TEXT;
    if (in->kind != SESSION_INPUT_START && in->time > model->session.now) {
        sign = "\u25cb";
        colour = INK_DIM;
    }
    model_change_text(model, index, text, sizeof text);
    screen_print(s, a.x, a.y, WHEN_AT - 1, INK_DIM, "%3d %s", index + 1, sign);
    screen_text(s, a.x + WHEN_AT, a.y, WHEN, colour, when);
    area_text(s, area_right(a, WHAT_AT), colour, text);
}

// What the hollow sign means, or how to make a change.
static void draw_input_edges(const explorer_model *model, screen *s, area a)
{
    const area foot = area_row(a, a.height - 1);
    if (model->session.input_count > 0) {
        area_text(s, foot, INK_DIM, "\u25cb takes effect after the cursor");
    } else {
        area_text(s, foot, INK_DIM, "none yet: Enter changes a value, p pushes");
    }
}

// How many changes there are.
static int input_count(const explorer_model *model)
{
    return model->session.input_count;
}

static int selected_input(const explorer_model *model, const explorer_view *view)
{
    (void)model;
    return view->change;
}

static void select_input(explorer_model *model, explorer_view *view, int index)
{
    (void)model;
    view->change = index;
}

// What a key does with the selected change; any other closes the page.
static bool press_change_key(explorer_model *model, explorer_view *view,
                             explorer_input *input, int key, int index)
{
    switch (key) {
    case KEY_CODE_ENTER:
        return act_edit_change(model, view, input, index);
    case 'd':
    case 'x':
    case KEY_CODE_DELETE:
        return act_drop_change(model, view, input, index);
    case 'u':
        return act_undo(model, view, input);
    case 'U':
    case 'r' & 0x1f:
        return act_redo(model, view, input);
    case 'g':
        if (index < model->session.input_count) {
            act_scrub(model, view, model->session.inputs[index].time);
        }
        break;
    }
    view->page = PANEL_NONE;
    return true;
}

static const page_list change_list = {
    .title = "changes (Enter edits, d drops, g goes there, Esc closes)",
    .narrow_title = "changes (d drops, Esc closes)",
    .most_width = 76,
    .foot = 1,
    .least_lines = 1,
    .count = input_count,
    .selected = selected_input,
    .select = select_input,
    .draw_line = draw_input,
    .draw_edges = draw_input_edges,
    .press_key = press_change_key};

const panel changes_panel = {.name = "changes", .list = &change_list};

// The page of changes: what was done to the run, in the order it was done, with its
// instant.
#include "ui/explorer/panels/panel.h"

static void draw_change(const explorer_model *model, screen *s, area a, int index)
{
    const session_input *in = &model->session.inputs[index];
    const bool later = in->kind != SESSION_INPUT_START && in->time > model->session.now;
    const ink colour = later ? INK_DIM : INK_TEXT;
    char text[LINE_TEXT], when[32] = "from the start";

    // what is in force from the start has no instant
    if (in->kind != SESSION_INPUT_START) {
        snprintf(when, sizeof when, "%9.5f s", in->time);
    }

    // what is still to come is hollow and dim
    model_change_text(model, index, text, sizeof text);
    screen_print(s, a.x, a.y, 5, INK_DIM, "%3d %s", index + 1,
                 later ? "\u25cb" : "\u25cf");
    screen_text(s, a.x + 6, a.y, 15, colour, when);
    screen_text(s, a.x + 22, a.y, a.width - 22, colour, text);
}

static void draw_rest(const explorer_model *model, screen *s, area a)
{
    screen_text(s, a.x, a.y + a.height - 1, a.width, INK_DIM,
                model->session.input_count > 0
                    ? "\u25cb takes effect after the cursor"
                    : "none yet: Enter changes a value, p pushes");
}

static int count(const explorer_model *model)
{
    return model->session.input_count;
}

static int selected(const explorer_model *model, const explorer_view *view)
{
    (void)model;
    return view->change;
}

static void select_change(explorer_model *model, explorer_view *view, int index)
{
    (void)model;
    view->change = index;
}

static bool press_key(explorer_model *model, explorer_view *view, explorer_input *input,
                      int key, int index)
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

static const page_list list = {
    .title = "changes (Enter edits, d drops, g goes there, Esc closes)",
    .narrow = "changes (d drops, Esc closes)",
    .width = 76,
    .foot = 1,
    .least = 1,
    .count = count,
    .selected = selected,
    .select = select_change,
    .draw_line = draw_change,
    .draw_rest = draw_rest,
    .key = press_key};

const panel changes_panel = {.name = "changes", .list = &list};

// The page of notes: what was said at which instant.
#include "ui/explorer/panels/panel.h"

static void draw_line(const explorer_model *model, screen *s, area a, int index)
{
    screen_print(s, a.x, a.y, 11, INK_DIM, "%9.5f s", model->notes[index].time);
    screen_words(s, a.x + 13, a.y, a.width - 13, INK_TEXT, model->notes[index].text);
}

static void draw_rest(const explorer_model *model, screen *s, area a)
{
    if (model->note_count == 0) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "none yet: :note TEXT at an instant");
    }
}

static int count(const explorer_model *model)
{
    return model->note_count;
}

static int selected(const explorer_model *model, const explorer_view *view)
{
    (void)model;
    return view->note;
}

static void select_note(explorer_model *model, explorer_view *view, int index)
{
    (void)model;
    view->note = index;
}

static bool press_key(explorer_model *model, explorer_view *view, explorer_input *input,
                      int key, int index)
{
    (void)input;
    if (key == 'd' || key == 'x' || key == KEY_CODE_DELETE) {
        act_drop_note(model, view, index);
        return true;
    }
    if (key == KEY_CODE_ENTER) {
        act_scrub(model, view, model->notes[index].time);
    }
    view->page = PANEL_NONE;
    return true;
}

static const page_list list = {.title = "notes (Enter goes there, d drops, Esc closes)",
                               .empty = "notes (Esc closes)",
                               .width = 84,
                               .least = 1,
                               .needs_lines = true,
                               .count = count,
                               .selected = selected,
                               .select = select_note,
                               .draw_line = draw_line,
                               .draw_rest = draw_rest,
                               .key = press_key};

const panel notes_panel = {.name = "notes", .list = &list};

// The page of notes: what was said at which instant.
#include "ui/explorer/panels/panel.h"

// A note in a line: its instant, and as many of its words as there is room for.
static void draw_note(const explorer_model *model, screen *s, area a, int index)
{
    enum { WHEN = 11, WHAT_AT = 13 }; // columns
    const note *n = &model->notes[index];
    screen_print(s, a.x, a.y, WHEN, INK_DIM, "%9.5f s", n->time);
    area_words(s, area_right(a, WHAT_AT), INK_TEXT, n->text);
}

// How to make a note where there is none.
static void draw_note_edges(const explorer_model *model, screen *s, area a)
{
    if (model->note_count == 0) {
        area_text(s, a, INK_DIM, "none yet: :note TEXT at an instant");
    }
}

// How many notes there are.
static int note_count(const explorer_model *model)
{
    return model->note_count;
}

static int selected_note(const explorer_model *model, const explorer_view *view)
{
    (void)model;
    return view->note;
}

static void select_note(explorer_model *model, explorer_view *view, int index)
{
    (void)model;
    view->note = index;
}

// What a key does with the selected note; any other closes the page.
static bool press_note_key(explorer_model *model, explorer_view *view,
                           explorer_input *input, int key, int index)
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

static const page_list note_list = {.title =
                                        "notes (Enter goes there, d drops, Esc closes)",
                                    .empty_title = "notes (Esc closes)",
                                    .most_width = 84,
                                    .least_lines = 1,
                                    .needs_lines = true,
                                    .count = note_count,
                                    .selected = selected_note,
                                    .select = select_note,
                                    .draw_line = draw_note,
                                    .draw_edges = draw_note_edges,
                                    .press_key = press_note_key};

const panel notes_panel = {.name = "notes", .list = &note_list};

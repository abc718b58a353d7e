// What keys and the mouse do: in the prompt, in a page, by the table of keys; the panel
// under the mouse.
#include "ui/explorer/explorer.h"

#include <string.h>

#include "ui/terminal/keys.h"

// --- keys ------------------------------------------------------------------------------

// The key at the beginning of a text, which moves behind it: a character, or a name in
// angle brackets. 0, with the reason in f, for a name that no key has.
static int take_key(const char **text, fault *f)
{
    const char *begin = *text;
    const char *close = *begin == '<' ? strchr(begin, '>') : NULL;

    // a character by itself, unless it begins a name
    if (close == NULL && (unsigned char)*begin < 0x80) {
        *text = begin + 1;
        return *begin;
    }
    if (close == NULL) {
        return (int)glyph_decode(text);
    }

    const int key = key_of_name(begin + 1, (size_t)(close - begin - 1));
    if (key == 0) {
        fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'",
                  (int)(close - begin + 1), begin);
    }
    *text = close + 1;
    return key;
}

bool explorer_keys(explorer *ex, const char *text, fault *f)
{
    while (*text != '\0' && !ex->input.quit) {
        const int key = take_key(&text, f);
        if (key == 0) {
            return false;
        }
        explorer_key(ex, key);
    }
    return true;
}

// Carries out what a line of the prompt or the selected entry of the palette says.
static void enter_prompt(explorer *ex)
{
    static palette_entry entries[PALETTE_ENTRIES];
    const explorer_view *view = &ex->view;
    prompt *p = &ex->input.prompt;

    // a copy: the command may open the prompt again
    char line[LINE_TEXT];
    snprintf(line, sizeof line, "%s", p->text);

    // the selected entry takes the place of what was typed
    bool needs_argument = false;
    const int at = view->palette.selected;
    if (palette_shows(p) && at >= 0 &&
        at < palette_find(&ex->model, view, p->text, entries)) {
        palette_line(&ex->model, view, entries[at], line, &needs_argument);
    }
    p->open = false;
    act_clear_message(&ex->input);
    if (needs_argument) {
        prompt_open(p, NULL, "%s", line);
        return;
    }

    // the first line that fails is kept for the end
    prompt_remember(p, line);
    if (!explorer_carry_out(ex, line) && ex->first_failure[0] == '\0') {
        snprintf(ex->first_failure, sizeof ex->first_failure, "%s",
                 ex->input.message.text);
    }
}

// Whether a key leaves what is being typed.
static bool leaves(int key)
{
    return key == KEY_CODE_ESCAPE || key == ('c' & 0x1f);
}

// Whether a key moved in the palette that the prompt shows: Up leaves it at its top.
static bool key_in_palette(const explorer_model *model, explorer_view *view,
                           const explorer_input *input, int key)
{
    enum { PAGE = 10 };
    if (!palette_shows(&input->prompt) || input->prompt.recalled > 0) {
        return false;
    }
    int lines = 0;
    if (key == KEY_CODE_DOWN || key == ('n' & 0x1f)) {
        lines = 1;
    } else if (key == KEY_CODE_PAGE_DOWN) {
        lines = PAGE;
    } else if (view->palette.selected < 0) {
        return false;
    } else if (key == KEY_CODE_UP || key == ('p' & 0x1f)) {
        lines = -1;
    } else if (key == KEY_CODE_PAGE_UP) {
        lines = -PAGE;
    }
    if (lines != 0) {
        act_move_in_palette(model, view, input, lines);
    }
    return lines != 0;
}

// Gives a key to the line; what has no room is said.
static void type_in_prompt(explorer *ex, int key)
{
    prompt *p = &ex->input.prompt;
    p->recalled = 0;
    if (!prompt_type(p, key)) {
        act_warn(&ex->input, "a line has at most %d bytes: the rest is not taken",
                 LINE_TEXT - 1);
    }
}

static void key_in_prompt(explorer *ex, int key)
{
    prompt *p = &ex->input.prompt;

    // only Tab after Tab goes through what fits; words are not completed
    p->cycling = p->cycling && key == KEY_CODE_TAB;
    if (key_in_palette(&ex->model, &ex->view, &ex->input, key) ||
        (p->searches && key == KEY_CODE_TAB)) {
        return;
    }
    if (leaves(key)) {
        p->open = false;
        act_clear_message(&ex->input);
    } else if (key == KEY_CODE_ENTER) {
        enter_prompt(ex);
    } else if (key == ('p' & 0x1f)) {
        // what was typed so far is searched for everywhere
        char words[LINE_TEXT];
        snprintf(words, sizeof words, "%s", p->text);
        act_palette(&ex->view, &ex->input, words);
    } else if (key == KEY_CODE_TAB) {
        complete_prompt(&ex->model, &ex->view, &ex->input);
    } else if (!p->searches && (key == KEY_CODE_UP || key == KEY_CODE_DOWN)) {
        prompt_recall(p, key == KEY_CODE_UP ? -1 : 1);
    } else {
        // other words, another list
        type_in_prompt(ex, key);
        if (p->searches) {
            ex->view.palette.selected = 0;
            palette_take_path(&ex->view.files, p->text);
        } else {
            ex->view.palette = (palette_view){.selected = -1};
        }
    }
}

// Keys in a panel's filter: Enter keeps it and continues with the selection, Esc clears
// it.
static void key_in_filter(explorer *ex, int key)
{
    explorer_view *view = &ex->view;
    const panel_id filtered = view->filters.typing;
    char *text = view->filters.text[filtered];
    if (key == KEY_CODE_ENTER) {
        view->filters.typing = PANEL_NONE;
        if (filtered == PANEL_PARAMETERS) {
            explorer_carry_out(ex, "edit");
        }
        return;
    }
    if (key == KEY_CODE_UP) {
        act_select_line(&ex->model, view, -1);
        return;
    }
    if (key == KEY_CODE_DOWN) {
        act_select_line(&ex->model, view, 1);
        return;
    }

    // what is typed changes the filter, and what is selected then
    if (leaves(key)) {
        text[0] = '\0';
        view->filters.typing = PANEL_NONE;
    } else {
        text_type(text, key);
    }
    act_select_filtered(&ex->model, view, filtered);
}

// Esc takes back one thing at a time: what is computed, a filter, the mark.
static void escape(explorer *ex)
{
    char *filter = ex->view.filters.text[ex->view.side.panel];

    // a computation is stopped first, and nothing else; then a filter, the sweep, else
    // the mark
    if (ex->model.session.computing != NULL || ex->model.search != NULL) {
        explorer_carry_out(ex, "stop");
        return;
    }
    if (filter[0] != '\0') {
        filter[0] = '\0';
    } else if (ex->view.side.panel == PANEL_SWEEP) {
        explorer_carry_out(ex, "sweep off");
    } else if (ex->view.side.panel == PANEL_PARAMETERS && ex->view.parameters.all) {
        ex->view.parameters.all = false;
    } else {
        ex->view.mark.set = false;
    }
    act_clear_message(&ex->input);
}

// The line that a key means: the answer to what is asked, else that of the table of keys;
// NULL for none.
static const char *meaning_of_key(const explorer *ex, int key)
{
    if (key == 's' && ex->input.asked_to_quit) {
        return "session save";
    }
    if (key == 'y' && ex->model.session.run.summary.status == STATUS_NOT_ALLOWED) {
        return "allow";
    }
    return key_line(&ex->view.keys, key);
}

static void key_by_table(explorer *ex, int key)
{
    const bool asked = ex->input.asked_to_quit;
    const char *bound = meaning_of_key(ex, key);
    if (bound != NULL) {
        // a copy: the command may be one that binds keys
        char line[LINE_TEXT];
        snprintf(line, sizeof line, "%s", bound);
        act_clear_message(&ex->input);
        explorer_carry_out(ex, line);
    } else if (key == KEY_CODE_ESCAPE) {
        escape(ex);
    } else if (key > ' ' && key < KEY_CODE_FIRST) {
        char name[8];
        glyph_encode((uint32_t)key, name);
        act_warn(&ex->input, "'%s' does nothing here, ? lists the keys", name);
    }

    // the answer is the very next key
    if (asked) {
        ex->input.asked_to_quit = false;
    }
}

void explorer_key(explorer *ex, int key)
{
    if (key == '\n') {
        key = KEY_CODE_ENTER;
    } else if (key == 127 || key == 8) {
        key = KEY_CODE_BACKSPACE;
    }

    if (recovery_answer(ex, key)) {
        return;
    }
    const bool quits = key == ('c' & 0x1f);
    if (ex->input.prompt.open) {
        key_in_prompt(ex, key);
    } else if (ex->view.filters.typing != PANEL_NONE) {
        key_in_filter(ex, key);
    } else if (key == ':') {
        prompt_open(&ex->input.prompt, NULL, "%s", "");
        ex->view.palette = (palette_view){.selected = -1};
        act_clear_message(&ex->input);
    } else if (ex->view.page != PANEL_NONE && !quits) {
        panel_key(&ex->model, &ex->view, &ex->input, key);
    } else {
        key_by_table(ex, key);
    }
}

void explorer_paste(explorer *ex, int character)
{
    const explorer_view *view = &ex->view;
    const bool typing = ex->input.prompt.open || view->filters.typing != PANEL_NONE;
    if (!typing) {
        act_warn(&ex->input, "pasted text does nothing here, : opens the prompt for it");
    } else if (character == '\n' || character == '\r' || character == '\t') {
        explorer_key(ex, ' ');
    } else if (character >= ' ' && character < KEY_CODE_FIRST && character != 127) {
        explorer_key(ex, character);
    }
}

// --- the mouse -------------------------------------------------------------------------

// Passes a gesture to the panel of its hit area; false if it has no effect.
static bool give(explorer *ex, const panel_gesture *g)
{
    const bool taken = panel_point(&ex->model, &ex->view, &ex->input, g);

    // an entry of the palette that was chosen with the mouse
    if (ex->view.palette.picked && ex->input.prompt.open) {
        ex->view.palette.picked = false;
        enter_prompt(ex);
    }
    return taken;
}

// Whether a page is open and a part is not of it.
static bool is_behind_page(const explorer_view *view, panel_id id)
{
    return view->page != PANEL_NONE &&
           (id == PANEL_NONE || panel_place_of(id) < PLACE_PAGE);
}

// Carries out what a hint says: the first line of a key of its command.
static void press_hint(explorer *ex, int command)
{
    char keys[64];
    key_names_of(&ex->view.keys, explorer_command_table[command].name, keys, sizeof keys);
    const int key = key_of_name(keys, strcspn(keys, " "));
    if (key != 0) {
        explorer_key(ex, key);
    }
}

static void press(explorer *ex, pointer_event e)
{
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    ex->grip = (pointer_grip){.holding = true, .hit = hit, .x = e.x, .y = e.y};

    // outside a page: it closes, and the drag does not apply to the panel behind it
    if (is_behind_page(&ex->view, hit.panel)) {
        ex->grip.hit = (hit_area){.panel = ex->view.page};
        ex->view.page = PANEL_NONE;
        return;
    }
    if (hit.part == PART_HINT) {
        press_hint(ex, hit.index);
        return;
    }
    e.kind = POINTER_PRESS;
    give(ex, &(panel_gesture){.event = e, .hit = hit});
}

static void drag(explorer *ex, pointer_event e)
{
    pointer_grip *grip = &ex->grip;
    panel_gesture g = {.event = e,
                       .hit = grip->hit,
                       .across = e.x - grip->x,
                       .up = grip->y - e.y};
    grip->dragged |= g.across != 0 || g.up != 0;
    g.dragged = grip->dragged;
    grip->x = e.x;
    grip->y = e.y;

    // what began on nothing counts for the plot as soon as it is over the curves
    bool over_curves = area_holds(ex->layout.plot, e.x, e.y);
    if (grip->hit.panel == PANEL_NONE && ex->view.page == PANEL_NONE && over_curves) {
        g.hit = (hit_area){PANEL_CURVES, PART_BODY, 0, ex->layout.plot};
    }
    give(ex, &g);
}

static void turn_wheel(explorer *ex, pointer_event e)
{
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    if (hit.part == PART_LEGEND) {
        hit.area = ex->layout.plot; // over a legend it zooms as in the curves
    }
    const bool typing = ex->input.prompt.open && hit.panel != PANEL_PALETTE;
    if (typing || is_behind_page(&ex->view, hit.panel)) {
        return;
    }

    // where no panel takes it, it presses the keys for up and down
    if (!give(ex, &(panel_gesture){.event = e, .hit = hit})) {
        explorer_key(ex, pointer_wheel(e) < 0 ? KEY_CODE_UP : KEY_CODE_DOWN);
    }
}

void explorer_point(explorer *ex, pointer_event e)
{
    // a terminal may leave the press out, a quick click may come without
    if ((e.kind == POINTER_DRAG || e.kind == POINTER_RELEASE) && !ex->grip.holding) {
        press(ex, e);
    }

    // a gesture is a press, its drags and its release; what is left is the wheel
    switch (e.kind) {
    case POINTER_PRESS:
        press(ex, e);
        break;
    case POINTER_DRAG:
        drag(ex, e);
        break;
    case POINTER_RELEASE:
        give(ex, &(panel_gesture){.event = e,
                                  .hit = ex->grip.hit,
                                  .dragged = ex->grip.dragged});
        ex->grip = (pointer_grip){0};
        break;
    default:
        turn_wheel(ex, e);
    }
}

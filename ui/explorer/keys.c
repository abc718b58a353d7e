// What keys and the mouse do: in the prompt, in a page, by the table of keys; the panel
// under the mouse.
#include "ui/explorer/explorer.h"

#include <string.h>

#include "ui/terminal/keys.h"

// --- keys ------------------------------------------------------------------------------

bool explorer_keys(explorer *ex, const char *text, fault *f)
{
    while (*text != '\0' && !ex->state.quit) {
        // a character by itself, unless it begins a name
        const char *close = *text == '<' ? strchr(text, '>') : NULL;
        const bool plain = (unsigned char)*text < 0x80;
        int key;
        if (close != NULL) {
            key = key_of_name(text + 1, (size_t)(close - text - 1));
        } else if (plain) {
            key = *text++;
        } else {
            key = (int)glyph_decode(&text);
        }
        if (close != NULL && key == 0) {
            fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'",
                      (int)(close - text + 1), text);
            return false;
        }
        if (close != NULL) {
            text = close + 1;
        }
        explorer_key(ex, key);
    }
    return true;
}

// Carries out what a line of the prompt or the selected entry of the palette says.
static void enter_prompt(explorer *ex)
{
    explorer_state *st = &ex->state;
    static palette_entry entries[PALETTE_ENTRIES];
    prompt *p = &st->prompt;
    char line[LINE_TEXT];
    bool goes_on = false;
    const int at = palette_shows(p) ? st->palette.selected : -1;

    // a copy: the command may open the prompt again
    snprintf(line, sizeof line, "%s", p->text);
    if (at >= 0 && at < palette_find(&st->scenarios, &st->keys, p->text, entries)) {
        palette_line(&st->scenarios, &st->keys, entries[at], line, &goes_on);
    }
    p->open = false;
    act_hush(st);
    if (goes_on) {
        prompt_open(p, NULL, "%s", line);
        return;
    }
    snprintf(p->history, sizeof p->history, "%s", line);
    if (!explorer_carry_out(ex, line) && ex->first_failure[0] == '\0') {
        snprintf(ex->first_failure, sizeof ex->first_failure, "%s", st->message.text);
    }
}

// Whether a key leaves what is being typed.
static bool leaves(int key)
{
    return key == KEY_CODE_ESCAPE || key == ('c' & 0x1f);
}

// Whether a key moved in the palette that the prompt shows: Up leaves it at its top.
static bool key_in_palette(explorer_state *st, int key)
{
    const bool down = key == KEY_CODE_DOWN || key == ('n' & 0x1f);
    const bool up = key == KEY_CODE_UP || key == ('p' & 0x1f);
    const bool moves =
        palette_shows(&st->prompt) && (down || (up && st->palette.selected >= 0));
    if (moves) {
        act_move_in_palette(st, down ? 1 : -1);
    }
    return moves;
}

static void key_in_prompt(explorer *ex, int key)
{
    prompt *p = &ex->state.prompt;

    // only Tab after Tab goes through what fits; words are not completed
    p->cycling = p->cycling && key == KEY_CODE_TAB;
    if (key_in_palette(&ex->state, key) || (p->searches && key == KEY_CODE_TAB)) {
        return;
    }
    if (leaves(key)) {
        p->open = false;
        act_hush(&ex->state);
    } else if (key == KEY_CODE_ENTER) {
        enter_prompt(ex);
    } else if (key == ('p' & 0x1f)) {
        // what was typed so far is searched for everywhere
        char words[LINE_TEXT];
        snprintf(words, sizeof words, "%s", p->text);
        act_palette(&ex->state, words);
    } else if (key == KEY_CODE_TAB) {
        complete_prompt(&ex->state);
    } else if (key == KEY_CODE_UP) {
        prompt_open(p, NULL, "%s", p->history);
    } else {
        // other words, another list
        prompt_type(p, key);
        if (p->searches) {
            ex->state.palette.selected = 0;
        } else {
            ex->state.palette.selected = -1;
        }
    }
}

// Keys in a panel's filter: Enter keeps it and continues with the selection, Esc clears
// it.
static void key_in_filter(explorer *ex, int key)
{
    explorer_state *st = &ex->state;
    const panel_id filtered = st->filters.typing;
    const bool enters = key == KEY_CODE_ENTER;
    if (leaves(key)) {
        st->filters.text[filtered][0] = '\0';
    }
    if (enters || leaves(key)) {
        st->filters.typing = PANEL_NONE;
    } else {
        st->filters.typing = filtered;
    }
    if (key == KEY_CODE_UP || key == KEY_CODE_DOWN) {
        explorer_carry_out(ex, key == KEY_CODE_UP ? "select -1" : "select");
    } else if (enters && filtered == PANEL_PARAMETERS && !st->parameters.on_heading) {
        explorer_carry_out(ex, "edit");
    } else if (!enters) {
        text_type(st->filters.text[filtered], key);
        act_settle_filter(st, filtered);
    }
}

// Esc takes back one thing at a time: what is computed, a filter, the mark.
static void escape(explorer *ex)
{
    explorer_state *st = &ex->state;
    char *filter = st->filters.text[st->side.panel];

    // a computation is stopped first, and nothing else; then a filter, the sweep, else
    // the mark
    if (st->session.computing != NULL) {
        explorer_carry_out(ex, "stop");
        return;
    }
    if (filter[0] != '\0') {
        filter[0] = '\0';
    } else if (st->side.panel == PANEL_SWEEP) {
        explorer_carry_out(ex, "sweep off");
    } else {
        st->mark.set = false;
    }

    // what was only shown for a moment goes with it
    session_forget_ghost(&st->session);
    act_hush(st);
}

static void key_by_table(explorer *ex, int key)
{
    explorer_state *st = &ex->state;
    const bool asked = st->asked_to_quit;

    // the answers to what is asked come before the table
    const char *bound = "session save";
    if (!(key == 's' && asked)) {
        if (key == 'y' && st->session.run.summary.status == STATUS_NOT_ALLOWED) {
            bound = "allow";
        } else {
            bound = key_line(&st->keys, key);
        }
    }
    if (bound != NULL) {
        // a copy: the command may be one that binds keys
        char line[LINE_TEXT];
        snprintf(line, sizeof line, "%s", bound);
        act_hush(st);
        explorer_carry_out(ex, line);
    } else if (key == KEY_CODE_ESCAPE) {
        escape(ex);
    } else if (key > ' ' && key < KEY_CODE_FIRST) {
        char name[8];
        glyph_encode((uint32_t)key, name);
        act_warn(st, "'%s' does nothing here, ? lists the keys", name);
    }

    // the answer is the very next key
    st->asked_to_quit = st->asked_to_quit && !asked;
}

void explorer_key(explorer *ex, int key)
{
    explorer_state *st = &ex->state;
    if (key == '\n') {
        key = KEY_CODE_ENTER;
    } else if (key == 127 || key == 8) {
        key = KEY_CODE_BACKSPACE;
    }

    // the page of a first visit takes no key
    if (st->page == PANEL_WELCOME) {
        st->page = PANEL_NONE;
    }
    if (recovery_answer(ex, key)) {
        return;
    }
    const bool quits = key == ('c' & 0x1f) && st->page != PANEL_SCENARIOS;
    if (st->prompt.open) {
        key_in_prompt(ex, key);
    } else if (st->filters.typing != PANEL_NONE) {
        key_in_filter(ex, key);
    } else if (key == ':') {
        prompt_open(&st->prompt, NULL, "%s", "");
        st->palette.selected = -1;
        act_hush(st);
    } else if (st->page != PANEL_NONE && !quits) {
        panel_key(st, key);
    } else {
        key_by_table(ex, key);
    }
}

void explorer_paste(explorer *ex, int character)
{
    explorer_state *st = &ex->state;
    const bool typing = st->prompt.open || st->filters.typing != PANEL_NONE ||
                        (st->page == PANEL_SCENARIOS && st->scenarios.filtering);
    const bool blank = character == '\n' || character == '\r' || character == '\t';
    if (!typing) {
        act_warn(st, "pasted text does nothing here, : opens the prompt for it");
    } else if (blank ||
               (character >= ' ' && character < KEY_CODE_FIRST && character != 127)) {
        explorer_key(ex, blank ? ' ' : character);
    }
}

// --- the mouse -------------------------------------------------------------------------

// Passes a gesture to the panel of its hit area; false if it has no effect.
static bool give(explorer *ex, const panel_gesture *g)
{
    const bool taken = panel_point(&ex->state, g);

    // an entry of the palette that was chosen with the mouse
    if (ex->state.palette.picked && ex->state.prompt.open) {
        ex->state.palette.picked = false;
        enter_prompt(ex);
    }
    return taken;
}

// Whether a page is open and a part is not of it.
static bool is_behind_page(const explorer_state *st, panel_id id)
{
    return st->page != PANEL_NONE &&
           (id == PANEL_NONE || panel_place_of(id) < PLACE_PAGE);
}

static void press(explorer *ex, pointer_event e)
{
    explorer_state *st = &ex->state;
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    ex->grip = (pointer_grip){.holding = true, .hit = hit, .x = e.x, .y = e.y};

    // outside a page: it closes, and the drag does not apply to the panel behind it
    if (is_behind_page(st, hit.panel)) {
        ex->grip.hit = (hit_area){.panel = st->page};
        st->page = PANEL_NONE;
        st->scenarios.filtering = false;
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
    if (grip->hit.panel == PANEL_NONE && ex->state.page == PANEL_NONE && over_curves) {
        g.hit = (hit_area){PANEL_CURVES, PART_BODY, 0, ex->layout.plot};
    }
    give(ex, &g);
}

static void turn_wheel(explorer *ex, pointer_event e)
{
    const explorer_state *st = &ex->state;
    hit_area hit = layout_hit(&ex->layout, e.x, e.y);
    if (hit.part == PART_LEGEND) {
        hit.area = ex->layout.plot; // over a legend it zooms as in the curves
    }
    const bool typing = st->prompt.open && hit.panel != PANEL_PALETTE;
    if (typing || is_behind_page(st, hit.panel)) {
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

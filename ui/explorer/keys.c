#include "ui/explorer/keys.h"

#include <assert.h>
#include <string.h>

#include "ui/explorer/commands.h"
#include "ui/explorer/completion.h"
#include "ui/terminal/keys.h"

bool explorer_keys(explorer *ex, const char *text, fault *f)
{
    assert(ex != NULL && text != NULL);
    while (*text != '\0' && !ex->state.quit) {
        // a character by itself, unless it begins a name
        const char *close = *text == '<' ? strchr(text, '>') : NULL;
        if (close == NULL) {
            bool plain = (unsigned char)*text < 0x80;
            explorer_key(ex, plain ? *text++ : (int)glyph_decode(&text));
            continue;
        }

        // a key by its name
        int key = key_of_name(text + 1, (size_t)(close - text - 1));
        if (key == 0) {
            fault_set(f, STATUS_BAD_ARGUMENT, "there is no key '%.*s'", (int)(close - text + 1),
                      text);
            return false;
        }
        explorer_key(ex, key);
        text = close + 1;
    }
    return true;
}

// Carries out what a line of the prompt or the selected entry of the palette says.
static void enter_prompt(explorer *ex)
{
    explorer_state *st = &ex->state;
    prompt *p = &st->prompt;
    char line[LINE_TEXT];
    bool goes_on = false;

    // a copy: the command may open the prompt again
    if (!palette_shows(p) || !act_line_of_palette(st, line, &goes_on)) {
        snprintf(line, sizeof line, "%s", p->text);
    }
    p->open = false;
    message_clear(&st->message);
    if (goes_on) {
        prompt_open(p, "%s", line);
        return;
    }
    snprintf(p->history, sizeof p->history, "%s", line);
    if (!explorer_carry_out(ex, line) && ex->first_failure[0] == '\0') {
        snprintf(ex->first_failure, sizeof ex->first_failure, "%s", st->message.text);
    }
}

// Whether a key moved in the palette that the prompt shows: Up leaves it at its top.
static bool key_in_palette(explorer_state *st, int key)
{
    const bool down = key == KEY_CODE_DOWN || key == ('n' & 0x1f);
    const bool up = key == KEY_CODE_UP || key == ('p' & 0x1f);
    if (!palette_shows(&st->prompt) || (!down && !up)) {
        return false;
    }
    if (up && st->palette.selected < 0) {
        return false;
    }
    act_move_in_palette(st, down ? 1 : -1);
    return true;
}

static void key_in_prompt(explorer *ex, int key)
{
    prompt *p = &ex->state.prompt;
    message_line *message = &ex->state.message;

    // only Tab after Tab goes through what fits; words are not completed
    p->cycling = p->cycling && key == KEY_CODE_TAB;
    if (key_in_palette(&ex->state, key) || (p->searches && key == KEY_CODE_TAB)) {
        return;
    }
    switch (key) {
    case KEY_CODE_ESCAPE:
    case 'c' & 0x1f:
        p->open = false;
        message_clear(message);
        break;
    case KEY_CODE_ENTER:
    case '\n':
        enter_prompt(ex);
        break;
    case 'p' & 0x1f: {
        // what was typed so far is searched for everywhere
        char words[LINE_TEXT];
        snprintf(words, sizeof words, "%s", p->text);
        const action_result opened = act_open_palette(&ex->state, words);
        result_show(&opened, message);
        break;
    }
    case KEY_CODE_TAB: {
        action_result completed = complete_prompt(&ex->state);
        result_show(&completed, message);
        break;
    }
    case KEY_CODE_UP:
        prompt_open(p, "%s", p->history);
        break;
    default:
        // other words, another list
        prompt_type(p, key);
        ex->state.palette.selected = p->searches ? 0 : -1;
    }
}

void explorer_take_picked(explorer *ex)
{
    assert(ex != NULL);
    if (ex->state.palette.picked && ex->state.prompt.open) {
        ex->state.palette.picked = false;
        enter_prompt(ex);
    }
}

// Keys in a panel's filter: Enter keeps it and continues with the selection, Esc clears it.
static void key_in_filter(explorer *ex, int key)
{
    explorer_state *st = &ex->state;

    const panel_id filtered = st->filters.typing;
    switch (key) {
    case KEY_CODE_ESCAPE:
    case 'c' & 0x1f:
        st->filters.text[filtered][0] = '\0';
        st->filters.typing = PANEL_NONE;
        break;
    case KEY_CODE_ENTER:
    case '\n':
        st->filters.typing = PANEL_NONE;
        if (filtered == PANEL_PARAMETERS && !st->parameters.on_heading) {
            explorer_carry_out(ex, "edit");
        }
        return;
    case KEY_CODE_UP:
        explorer_carry_out(ex, "select -1");
        return;
    case KEY_CODE_DOWN:
        explorer_carry_out(ex, "select");
        return;
    default:
        text_type(st->filters.text[filtered], key);
    }
    act_settle_filter(st, filtered);
}

// Esc takes back one thing at a time: what is computed, a filter, the mark.
static void escape(explorer *ex)
{
    explorer_state *st = &ex->state;
    char *filter = st->filters.text[st->side.panel];

    // a computation is stopped first, and nothing else
    if (st->session.computing != NULL) {
        explorer_carry_out(ex, "stop");
        return;
    }

    // the nearest thing: a filter, the sweep, else the mark
    if (filter[0] != '\0') {
        filter[0] = '\0';
    } else if (st->side.panel == PANEL_SWEEP) {
        explorer_carry_out(ex, "sweep off");
    } else {
        st->mark.set = false;
    }

    // what was only shown for a moment goes with it
    session_forget_ghost(&st->session);
    message_clear(&st->message);
}

static void key_by_table(explorer *ex, int key)
{
    explorer_state *st = &ex->state;
    key = key == '\n' ? KEY_CODE_ENTER : key == 127 || key == 8 ? KEY_CODE_BACKSPACE : key;
    const char *bound = key_line(&st->keys, key);
    const bool asked = st->asked_to_quit;
    if (key == 'y' && st->session.run.summary.status == STATUS_NOT_ALLOWED) {
        bound = "allow"; // the answer to what is asked then
    }
    if (bound != NULL) {
        // a copy: the command may be one that binds keys
        char line[LINE_TEXT];
        snprintf(line, sizeof line, "%s", bound);
        message_clear(&st->message);
        explorer_carry_out(ex, line);
    } else if (key == KEY_CODE_ESCAPE) {
        escape(ex);
    } else if (key > ' ' && key < KEY_CODE_FIRST && key != 127) {
        char name[8];
        glyph_encode((uint32_t)key, name);
        message_say(&st->message, true, "'%s' does nothing here, ? lists the keys", name);
    }

    // the answer is the very next key
    if (asked) {
        st->asked_to_quit = false;
    }
}

void explorer_key(explorer *ex, int key)
{
    assert(ex != NULL);
    explorer_state *st = &ex->state;

    bool leaves = key == ('c' & 0x1f) && st->page.panel != PANEL_SCENARIOS;
    if (st->prompt.open) {
        key_in_prompt(ex, key);
    } else if (st->filters.typing != PANEL_NONE) {
        key_in_filter(ex, key);
    } else if (key == ':') {
        prompt_open(&st->prompt, "%s", "");
        st->palette.selected = -1;
        message_clear(&st->message);
    } else if (st->page.panel != PANEL_NONE && !leaves) {
        action_result result = panel_of(st->page.panel)->key(st, key);
        result_show(&result, &st->message);
    } else {
        key_by_table(ex, key);
    }
}

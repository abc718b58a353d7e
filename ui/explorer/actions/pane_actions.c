// Actions on panes of curves: which there are, and what each shows.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// --- panes of one's own ----------------------------------------------------------------

// Marks the derived signals of a pane.
static void mark_derived(const pane *p, bool used[DERIVED_SIGNALS])
{
    for (int k = 0; k < p->count; k++) {
        if (signal_is_derived(p->signals[k])) {
            used[p->signals[k] - SIGNALS_AT_MOST] = true;
        }
    }
}

// A place for a derived signal that neither a pane of the screen nor the one that is
// being made has; -1 if there is none.
static int free_place(const explorer_view *view, const pane *own)
{
    bool used[DERIVED_SIGNALS] = {false};
    for (int i = 0; i < PANES; i++) {
        mark_derived(&view->panes.pane[i], used);
    }
    mark_derived(own, used);
    for (int place = 0; place < DERIVED_SIGNALS; place++) {
        if (!used[place]) {
            return place;
        }
    }
    return -1;
}

// Computes an expression as a signal of its own; -1 after a refusal.
static int derive_signal(explorer_model *model, const explorer_view *view,
                         explorer_input *input, const char *expression, const pane *own)
{
    const int place = free_place(view, own);
    if (place < 0) {
        act_refuse(input, "%d expressions are shown already", DERIVED_SIGNALS);
        return -1;
    }
    const int signal = signal_derive(place, expression, &input->fault);
    if (signal < 0) {
        act_succeeded(input, input->fault.code);
        return -1;
    }

    // the place may have had another expression
    for (int i = 0; i < SHOWN_RUNS; i++) {
        extremes_forget(&model->extremes[i]);
    }
    return signal;
}

// Adds the signal of a name or an expression.
static bool add_signal(explorer_model *model, const explorer_view *view,
                       explorer_input *input, const char *text, pane *own)
{
    if (own->count == PANE_SIGNALS) {
        return act_refuse(input, "a pane has at most %d signals", PANE_SIGNALS);
    }
    int signal = signal_find_any(text);
    if (signal < 0 && text[strcspn(text, "+-*/(")] == '\0') {
        return act_refuse(input, "there is no signal '%s' (Tab completes)", text);
    }
    if (signal < 0) {
        signal = derive_signal(model, view, input, text, own);
    }
    if (signal < 0) {
        return false;
    }
    own->signals[own->count++] = signal;
    return true;
}

// The length of the first signal of a text: up to a comma outside brackets, or a blank
// where nothing is computed.
static size_t signal_length(const char *text, bool computes)
{
    int depth = 0;
    size_t length = 0;
    for (; text[length] != '\0'; length++) {
        const char c = text[length];
        if (c == '(') {
            depth++;
        } else if (c == ')') {
            depth--;
        }
        if ((c == ',' && depth <= 0) || (c == ' ' && !computes)) {
            break;
        }
    }
    return length;
}

// Fills a pane with the signals of an argument.
static bool read_signals(explorer_model *model, const explorer_view *view,
                         explorer_input *input, const char *argument, pane *own)
{
    const bool computes = argument[strcspn(argument, "+-*/(")] != '\0';
    while (*argument != '\0') {
        // its blanks mean nothing
        char word[LINE_TEXT];
        const size_t length = signal_length(argument, computes);
        size_t written = 0;
        for (size_t i = 0; i < length; i++) {
            if (argument[i] != ' ') {
                word[written++] = argument[i];
            }
        }
        word[written] = '\0';
        if (written > 0 && !add_signal(model, view, input, word, own)) {
            return false;
        }

        // past the separator
        argument += length;
        if (*argument != '\0') {
            argument++;
        }
    }
    return true;
}

bool act_show_pane(explorer_model *model, explorer_view *view, explorer_input *input,
                   const char *argument, pane_view kind)
{
    static const struct {
        int least, most; // signals
        const char *takes;
    } kinds[] = {
        [VIEW_TIME] = {1, PANE_SIGNALS,
                       "trace takes a number from 1 to 9 or names of signals"},
        [VIEW_PHASE] = {2, 2, "phase takes two signals: what goes up, and what across"},
        [VIEW_RESIDUAL] = {1, PANE_SIGNALS, "residual takes signals that were measured"},
        [VIEW_SPECTRUM] = {1, 1, "spectrum takes one signal"}};
    pane own = {.view = kind};
    if (!read_signals(model, view, input, argument, &own)) {
        return false;
    }
    if (own.count < kinds[kind].least || own.count > kinds[kind].most) {
        return act_refuse(input, "%s", kinds[kind].takes);
    }
    const int index = panes_add(&view->panes, &own);
    return act_tell(input, "pane %d: :trace %d hides it", index + 1, index + 1);
}

// Shows or hides a pane by number, or makes one of signals by name.
bool act_trace(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument)
{
    // a pane that there is
    if (argument[0] != '\0' && argument[strspn(argument, "0123456789")] == '\0') {
        const long number = strtol(argument, NULL, 10);
        if (number < 1 || number > PANES) {
            return act_refuse(input, "panes are numbered from 1 to %d", PANES);
        }
        const int index = (int)number - 1;
        pane *p = &view->panes.pane[index];
        if (p->count == 0) {
            return act_refuse(input, "pane %s is empty, :trace SIGNAL... fills it",
                              argument);
        }
        p->shown = !p->shown;
        view->panes.chosen = true;
        if (p->shown) {
            view->panes.focus = index;
        }
        return true;
    }

    return act_show_pane(model, view, input, argument, VIEW_TIME);
}

// Shows the panes of these numbers and no others.
bool act_panes(explorer_view *view, explorer_input *input, const char *argument)
{
    if (argument[strspn(argument, "123456789")] != '\0') {
        return act_refuse(input, "panes takes numbers from 1 to 9, such as 134");
    }
    for (int i = 0; i < PANES; i++) {
        pane *p = &view->panes.pane[i];
        p->shown =
            i < PANES_OF_TABLE && p->count > 0 && strchr(argument, '1' + i) != NULL;
    }
    view->panes.chosen = true;
    return true;
}

// --- what a pane shows -----------------------------------------------------------------

bool act_focus(explorer_view *view, explorer_input *input)
{
    int focused = panes_focused(&view->panes);
    if (focused < 0) {
        return act_refuse(input, "no pane of curves is shown, 1 to 9 show them");
    }
    view->panes.focus = (focused + 1) % PANES;
    view->panes.focus = panes_focused(&view->panes);
    return true;
}

bool act_toggle_signal(explorer_view *view, explorer_input *input, int index, int k)
{
    assert(index >= 0 && index < PANES && k >= 0 && k < PANE_SIGNALS);
    pane *p = &view->panes.pane[index];
    p->hidden ^= 1u << k;
    const char *name = signal_table[p->signals[k]].name;
    if (p->hidden >> k & 1) {
        return act_tell(input, "%s is hidden (K or a click on its legend shows it)",
                        name);
    }
    return act_tell(input, "%s is shown", name);
}

// The signal to be hidden next: the one before that which is hidden, from the last to the
// first; -1 when all are to be shown. One that is alone stays.
static int next_hidden(const pane *p)
{
    if (p->count <= 1) {
        return -1;
    }
    int next = p->count - 1;
    for (int k = 0; k < p->count; k++) {
        if (p->hidden >> k & 1) {
            next = k - 1;
        }
    }
    return next;
}

bool act_signal(explorer_view *view, explorer_input *input, const char *argument)
{
    // the pane that is named, or the one in focus
    char text[LINE_TEXT], *words[4] = {""};
    int index = panes_focused(&view->panes);
    if (act_split(argument, text, words) == 2 &&
        !act_read_pane(view, input, words[1], &index)) {
        return false;
    }
    if (index < 0) {
        return act_refuse(input, "no pane of curves is shown, 1 to 9 show them");
    }
    pane *p = &view->panes.pane[index];

    // one after the other
    if (argument[0] == '\0') {
        const int next = next_hidden(p);
        p->hidden = 0;
        if (next < 0) {
            return act_tell(input, "all signals of the pane are shown");
        }
        return act_toggle_signal(view, input, index, next);
    }

    // all of them, or one by name
    if (strcmp(words[0], "all") == 0) {
        p->hidden = 0;
        return true;
    }
    const int signal = signal_find_any(words[0]);
    for (int k = 0; k < p->count; k++) {
        if (p->signals[k] == signal) {
            return act_toggle_signal(view, input, index, k);
        }
    }
    return act_refuse(input, "the pane in focus has no signal '%.60s' (w: next pane)",
                      argument);
}

bool act_limit(explorer_model *model, explorer_input *input, const char *argument)
{
    char text[LINE_TEXT], *words[4];
    solved_limit limit = {.signal = -1, .quantity = -1};
    if (strcmp(argument, "off") == 0) {
        model->limit = limit;
        return true;
    }
    if (act_split(argument, text, words) == 2) {
        limit.signal = signal_find_any(words[0]);
    }
    if (limit.signal < 0) {
        return act_refuse(input,
                          "limit takes a signal and a value, such as force 2, or off");
    }
    if (!act_read_number(input, words[1], &limit.bound)) {
        return false;
    }
    model->limit = limit;
    return true;
}

bool act_alone(explorer_view *view)
{
    view->panes.alone = !view->panes.alone;
    return true;
}

// Actions on the list of changes: showing it, and changing or dropping single ones.
#include <stdlib.h>

#include "ui/explorer/actions/actions.h"

// Reads the number of a change, from 1, at the beginning of a text; *rest is what follows it.
static action_result read_change(const explorer_state *st, const char *text, int *index,
                                 const char **rest)
{
    const session *s = &st->session;
    char *end;
    const long number = strtol(text, &end, 10);

    // a number from 1 on, and blanks behind it
    if (s->input_count == 0) {
        return result_refused("there are no changes");
    }
    if (end == text || (*end != '\0' && *end != ' ') || number < 1 || number > s->input_count) {
        return result_refused("changes are numbered from 1 to %d (:changes lists them)",
                              s->input_count);
    }

    // what follows the blanks is the rest
    while (*end == ' ') {
        end++;
    }
    *index = (int)number - 1;
    *rest = end;
    return result_done();
}

action_result act_show_changes(explorer_state *st, const char *argument)
{
    (void)argument;
    st->page.panel = st->page.panel == PANEL_CHANGES ? PANEL_NONE : PANEL_CHANGES;
    st->change = st->session.input_count > 0 ? st->session.input_count - 1 : 0;
    return result_done();
}

action_result act_edit_change(explorer_state *st, const char *argument)
{
    const char *value = "";
    int index = 0;
    action_result read = read_change(st, argument, &index, &value);
    if (!result_ok(&read)) {
        return read;
    }
    char text[LINE_TEXT];
    const session_input *in = &st->session.inputs[index];

    // without a value it is asked for
    if (value[0] == '\0' && in->kind != SESSION_INPUT_PUSH) {
        snprintf(text, sizeof text, "change %d ", index + 1);
        prompt_open_value(&st->prompt, text, in->text);
        return result_news("%s", parameter_table[in->parameter].description);
    }
    fault f = {0};
    const status code = session_change_input(&st->session, index, value, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }
    st->change = st->session.input_count - 1;
    state_change_text(st, st->change, text, sizeof text);
    return result_news("%s at the same instant, u takes it back", text);
}

action_result act_drop_change(explorer_state *st, const char *argument)
{
    const char *rest;
    int index = 0;
    char text[LINE_TEXT];
    action_result read = read_change(st, argument, &index, &rest);
    if (!result_ok(&read)) {
        return read;
    }

    // the text first: the change is gone afterwards
    fault f = {0};
    state_change_text(st, index, text, sizeof text);
    const status code = session_drop_input(&st->session, index, &f);
    if (code != STATUS_OK) {
        return result_of(code, &f);
    }

    // the selection stays within the list
    const int last = st->session.input_count - 1;
    st->change = st->change > last ? (last < 0 ? 0 : last) : st->change;
    return result_news("without %s; U puts it in again", text);
}

// Actions on what is seen: panes, marks, pages, looks.
#include "ui/explorer/actions/actions.h"

#include <ctype.h>
#include <string.h>

action_result act_select_parameter(explorer_state *st, const char *argument)
{
    int direction = argument[0] == '-' ? -1 : 1;
    for (int i = st->side.parameter + direction; i >= 0 && i < parameter_count; i += direction) {
        if (state_parameter_applies(st, i)) {
            st->side.parameter = i;
            break;
        }
    }
    return result_done();
}

action_result act_set_mark(explorer_state *st, const char *argument)
{
    (void)argument;
    st->mark.set = !st->mark.set;
    st->mark.time = st->session.now;
    return result_news("%s",
                       st->mark.set ? "mark set: values now show the difference to it" : "no mark");
}

action_result act_other_side(explorer_state *st, const char *argument)
{
    (void)argument;
    bool narrow = st->size.width > 0 && st->size.width < SIDE_WIDTH;
    panel_id next = panel_next_on_side(st->side.panel);

    // a narrow screen: curves, each panel of the side, curves again
    if (narrow && (!st->side.in_front || next == PANEL_NONE)) {
        st->side.in_front = !st->side.in_front;
        next = PANEL_NONE;
    }
    st->side.panel = next != PANEL_NONE ? next : panel_first_on_side();
    return result_done();
}

// Shows or hides a pane by number, or makes one of signals by name.
action_result act_trace_pane(explorer_state *st, const char *argument)
{
    // a pane of the table
    if (isdigit((unsigned char)argument[0]) && argument[1] == '\0') {
        int index = (argument[0] - '0' + 9) % 10;
        pane *p = &st->panes.pane[index];
        if (p->count == 0) {
            return result_refused("pane %s is empty, :trace SIGNAL... fills it", argument);
        }
        p->shown = !p->shown;
        st->panes.chosen = true;
        st->panes.focus = p->shown ? index : st->panes.focus;
        return result_done();
    }

    // the user's own pane, of as many signals as fit
    pane own = {.shown = true, .grown = value_range_empty};
    char words[LINE_TEXT], *rest = words;
    snprintf(words, sizeof words, "%s", argument);
    for (char *word; (word = strtok_r(rest, " ,", &rest)) != NULL && own.count < PANE_SIGNALS;) {
        int signal = signal_find(word);
        if (signal < 0) {
            return result_refused("there is no signal '%s' (Tab completes)", word);
        }
        own.signals[own.count++] = signal;
    }
    if (own.count == 0) {
        return result_refused("trace takes a number from 1 to 9 or names of signals");
    }
    st->panes.pane[PANES - 1] = own;
    st->panes.focus = PANES - 1;
    return result_done();
}

// Shows the panes of these numbers and no others.
action_result act_show_panes(explorer_state *st, const char *argument)
{
    if (argument[strspn(argument, "123456789")] != '\0') {
        return result_refused("panes takes numbers from 1 to 9, such as 134");
    }
    for (int i = 0; i < PANES - 1; i++) {
        st->panes.pane[i].shown = st->panes.pane[i].count > 0 && strchr(argument, '1' + i) != NULL;
    }
    st->panes.chosen = true;
    return result_done();
}

// Opens a page at its beginning, or closes it.
static action_result toggle_page(explorer_state *st, panel_id page)
{
    st->page.panel = st->page.panel == page ? PANEL_NONE : page;
    st->scroll[page] = 0;
    return result_done();
}

action_result act_show_help(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_HELP);
}

action_result act_compare(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_COMPARISON);
}

// Reads one of the words; all of them change how the screen looks, so it is drawn anew.
static action_result read_choice(explorer_state *st, const char *argument, const char *const *words,
                                 int count, int *value)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(argument, words[i]) == 0) {
            *value = i;
            st->looks.redraw = true;
            return result_done();
        }
    }
    char all[128] = "";
    for (int i = 0; i < count; i++) {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    return result_refused("'%s' is none of %s", argument, all);
}

action_result act_set_glyphs(explorer_state *st, const char *argument)
{
    int value = (int)st->looks.glyphs;
    action_result read = read_choice(st, argument, glyph_set_words, GLYPH_SETS, &value);
    st->looks.glyphs = (glyph_set)value;
    return read;
}

action_result act_set_theme(explorer_state *st, const char *argument)
{
    int value = (int)st->looks.theme;
    action_result read = read_choice(st, argument, colour_theme_words, COLOUR_THEMES, &value);
    st->looks.theme = (colour_theme)value;
    return read;
}

action_result act_set_colours(explorer_state *st, const char *argument)
{
    int value = (int)st->looks.depth;
    action_result read = read_choice(st, argument, colour_depth_words, COLOUR_DEPTHS, &value);
    st->looks.depth = (colour_depth)value;
    return read;
}

action_result act_set_mouse(explorer_state *st, const char *argument)
{
    int value = st->looks.mouse;
    action_result read = read_choice(st, argument, mouse_words, 2, &value);
    if (!result_ok(&read)) {
        return read;
    }
    st->looks.mouse = value;
    return result_news("%s",
                       value ? "clicks move the cursor" : "the mouse is off: the terminal selects");
}

action_result act_redraw(explorer_state *st, const char *argument)
{
    (void)argument;
    st->looks.redraw = true;
    return result_done();
}

action_result act_quit(explorer_state *st, const char *argument)
{
    (void)argument;
    st->quit = true;
    return result_done();
}

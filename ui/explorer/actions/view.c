// Actions on what is seen: panes, marks, pages, looks.
#include "ui/explorer/actions/actions.h"

#include <ctype.h>
#include <string.h>

action_result act_select_parameter(explorer_state *st, const char *argument)
{
    parameter_line lines[PARAMETER_LINES];
    const int direction = argument[0] == '-' ? -1 : 1;

    // panels in which nothing is selected scroll
    if (st->side.panel == PANEL_VALUES) {
        st->scroll[PANEL_VALUES] += direction;
        return result_done();
    }
    if (st->side.panel == PANEL_STATISTICS) {
        st->scroll[PANEL_STATISTICS] += direction;
        return result_done();
    }

    // the sweep selects among its runs
    if (st->side.panel == PANEL_SWEEP) {
        act_select_swept(st, direction);
        return result_done();
    }

    // the parameters end at both ends, without a way around
    const int count = state_parameter_lines(st, lines);
    const int next = parameter_list_selected(&st->parameters, lines, count) + direction;
    if (next >= 0 && next < count) {
        parameter_list_select(&st->parameters, lines[next]);
    }
    return result_done();
}

// The group of a name, that of the selected parameter without one, or all of them.
action_result act_fold(explorer_state *st, const char *argument)
{
    parameter_list *list = &st->parameters;

    // all groups at once, the one of the selected parameter, or one by name
    if (strcmp(argument, "all") == 0 || strcmp(argument, "none") == 0) {
        for (int i = 0; i < PARAMETER_GROUPS; i++) {
            list->folded[i] = argument[0] == 'a';
        }
        list->on_heading = argument[0] == 'a';
        return result_done();
    }
    if (argument[0] == '\0') {
        parameter_list_fold(list, list->parameter);
        return result_done();
    }
    for (int i = 0; i < parameter_count; i++) {
        char name[PARAMETER_NAME];
        parameter_group_name(i, name, sizeof name);
        if (strcmp(name, argument) == 0) {
            parameter_list_fold(list, i);
            return result_done();
        }
    }
    return result_refused("there is no group '%s' of parameters", argument);
}

// The panel to whose filter `/` applies: the open page, or the side panel.
static panel_id filtered_panel(const explorer_state *st)
{
    return st->page.panel != PANEL_NONE ? st->page.panel : st->side.panel;
}

action_result act_filter(explorer_state *st, const char *argument)
{
    const panel_id panel = filtered_panel(st);
    char *text = st->filters.text[panel];
    snprintf(text, FILTER_TEXT, "%s", argument);
    st->filters.typing = argument[0] == '\0' ? panel : PANEL_NONE;
    st->scroll[panel] = 0;
    act_settle_filter(st, panel);
    return result_done();
}

void act_settle_filter(explorer_state *st, panel_id panel)
{
    parameter_line lines[PARAMETER_LINES];
    st->scroll[panel] = 0;
    if (panel != PANEL_PARAMETERS || st->filters.text[panel][0] == '\0') {
        return;
    }

    // the selected parameter if it is still there, else the first that has an effect, else the
    // first
    const int count = state_parameter_lines(st, lines);
    const parameter_list *list = &st->parameters;
    const int selected = parameter_list_selected(list, lines, count);
    const bool there =
        count > 0 && !lines[selected].heading && lines[selected].parameter == list->parameter;
    int best = -1;
    for (int i = 0; i < count && !there; i++) {
        const bool better = best < 0 || state_inert_reason(st, lines[best].parameter) != NULL;
        const bool acts = state_inert_reason(st, lines[i].parameter) == NULL;
        if (!lines[i].heading && better && (best < 0 || acts)) {
            best = i;
        }
    }
    if (best >= 0) {
        parameter_list_select(&st->parameters, lines[best]);
    }
}

action_result act_set_mark(explorer_state *st, const char *argument)
{
    (void)argument;
    st->mark.set = !st->mark.set;
    st->mark.time = st->session.now;
    return result_news(
        "%s", st->mark.set ? "mark set: values now show the difference to it, X statistics from "
                             "it to the cursor"
                           : "no mark");
}

action_result act_other_side(explorer_state *st, const char *argument)
{
    (void)argument;
    bool narrow = st->size.width > 0 && st->size.width < SIDE_WIDTH;
    panel_id next = panel_next_on_side(st->side.panel);
    while (next == PANEL_SWEEP && !lab_sweep_is_on(&st->sweep)) {
        next = panel_next_on_side(next);
    }

    // a narrow screen: curves, each panel of the side, curves again
    if (narrow && (!st->side.in_front || next == PANEL_NONE)) {
        st->side.in_front = !st->side.in_front;
        next = PANEL_NONE;
    }
    st->side.panel = next != PANEL_NONE ? next : panel_first_on_side();
    return result_done();
}

// Fills a pane with the signals of an argument, as many as fit.
static action_result read_signals(const char *argument, pane *own)
{
    char words[LINE_TEXT], *rest = words;
    snprintf(words, sizeof words, "%s", argument);
    for (char *word; (word = strtok_r(rest, " ,", &rest)) != NULL && own->count < PANE_SIGNALS;) {
        const int signal = signal_find(word);
        if (signal < 0) {
            return result_refused("there is no signal '%s' (Tab completes)", word);
        }
        own->signals[own->count++] = signal;
    }
    return result_done();
}

// Shows a pane in the place of the user's own.
static action_result show_own(explorer_state *st, pane own)
{
    own.shown = true;
    own.grown = value_range_empty;
    st->panes.pane[PANES - 1] = own;
    st->panes.chosen = true;
    st->panes.focus = PANES - 1;
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
    pane own = {.view = VIEW_TIME};
    const action_result read = read_signals(argument, &own);
    if (!result_ok(&read)) {
        return read;
    }
    if (own.count == 0) {
        return result_refused("trace takes a number from 1 to 9 or names of signals");
    }
    return show_own(st, own);
}

action_result act_phase_pane(explorer_state *st, const char *argument)
{
    pane own = {.view = VIEW_PHASE};
    const action_result read = read_signals(argument, &own);
    if (!result_ok(&read)) {
        return read;
    }
    return own.count == 2
               ? show_own(st, own)
               : result_refused("phase takes two signals: what goes up, and what across");
}

action_result act_spectrum_pane(explorer_state *st, const char *argument)
{
    pane own = {.view = VIEW_SPECTRUM};
    const action_result read = read_signals(argument, &own);
    if (!result_ok(&read)) {
        return read;
    }
    return own.count == 1 ? show_own(st, own) : result_refused("spectrum takes one signal");
}

action_result act_statistics(explorer_state *st, const char *argument)
{
    (void)argument;
    const bool there = st->side.panel == PANEL_STATISTICS;
    st->side.panel = there ? panel_first_on_side() : PANEL_STATISTICS;
    st->side.in_front = !there;
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
    st->filters.text[page][0] = '\0';
    return result_done();
}

action_result act_show_help(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_HELP);
}

action_result act_show_info(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_INFO);
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

    // none of them: the refusal names them all
    char all[128] = "";
    for (int i = 0; i < count; i++) {
        size_t used = strlen(all);
        snprintf(all + used, sizeof all - used, "%s%s", i > 0 ? ", " : "", words[i]);
    }
    return result_refused("'%s' is none of %s", argument, all);
}

// Goes on to the next choice, or to the one that is named.
static action_result next_or_named(explorer_state *st, const char *argument,
                                   const char *const *words, int count, int *value)
{
    if (argument[0] != '\0') {
        return read_choice(st, argument, words, count, value);
    }
    *value = (*value + 1) % count;
    return result_done();
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

action_result act_set_pixels(explorer_state *st, const char *argument)
{
    int value = st->looks.pixels;
    action_result read = read_choice(st, argument, pixel_words, 2, &value);
    if (!result_ok(&read)) {
        return read;
    }
    st->looks.pixels = value;
    return result_news("%s", value ? "pictures where the terminal says that it draws them"
                                   : "characters only");
}

action_result act_set_close_up(explorer_state *st, const char *argument)
{
    int value = (int)st->looks.close_up;
    action_result read = next_or_named(st, argument, close_up_words, CLOSE_UP_CHOICES, &value);
    if (!result_ok(&read)) {
        return read;
    }
    st->looks.close_up = (close_up_choice)value;
    return result_news("the contact from near by: %s", close_up_words[value]);
}

action_result act_set_bending(explorer_state *st, const char *argument)
{
    enum { MOST = 100 };
    double factor = 1;
    action_result read = act_read_optional(argument, &factor);
    if (!result_ok(&read)) {
        return read;
    }
    if (!(factor >= 1 && factor <= MOST)) {
        return result_refused("bending is drawn 1 to %d times as large", MOST);
    }
    st->looks.bending = factor;
    return factor == 1 ? result_news("bending is drawn as it is")
                       : result_news("bending is drawn %g times as large", factor);
}

action_result act_set_lanes(explorer_state *st, const char *argument)
{
    int value = (int)st->looks.lanes;
    action_result read = next_or_named(st, argument, lane_choice_words, LANE_CHOICES, &value);
    if (!result_ok(&read)) {
        return read;
    }
    st->looks.lanes = (lane_choice)value;
    return result_news("lanes: %s", lane_choice_words[value]);
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
    const session *s = &st->session;
    const bool unsaved = s->input_count > 0 && st->saved_version != state_run_id(st);

    // changes are lost only if quitting is requested twice
    if (!unsaved || st->asked_to_quit) {
        st->quit = true;
        return result_done();
    }
    st->asked_to_quit = true;
    return result_warning("%d change%s would be lost: q leaves all the same, :save NAME.yaml keeps "
                          "%s, Esc stays",
                          s->input_count, s->input_count == 1 ? "" : "s",
                          s->input_count == 1 ? "it" : "them");
}

action_result act_quit_now(explorer_state *st, const char *argument)
{
    (void)argument;
    st->quit = true;
    return result_done();
}

action_result act_interrupt(explorer_state *st, const char *argument)
{
    return st->session.computing != NULL ? act_stop(st, "") : act_quit(st, argument);
}

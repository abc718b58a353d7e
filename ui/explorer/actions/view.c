// Actions on what is seen: marks, pages, notes, looks, the palette.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

bool act_select(explorer_state *st, const char *argument)
{
    parameter_line lines[PARAMETER_LINES];
    const lab_sweep *sweep = &st->sweep;
    const int direction = argument[0] == '-' ? -1 : 1;

    // the sweep selects among its runs, panels in which nothing is selected scroll
    if (st->side.panel == PANEL_SWEEP) {
        int by = direction;
        if (lab_sweep_is_map(sweep)) {
            by = -direction * (int)sweep->axis.count;
        }
        act_select_swept(st, by);
    } else if (st->side.panel != PANEL_PARAMETERS) {
        st->drawn.scroll[st->side.panel] += direction;
    } else {
        // the parameters end at both ends, without a way around
        int next;
        const int count = state_parameter_lines(st, lines, &next);
        next += direction;
        if (next >= 0 && next < count) {
            parameter_list_select(&st->parameters, lines[next]);
        }
    }
    return true;
}

// The group of a name, that of the selected parameter without one, or all of them.
bool act_fold(explorer_state *st, const char *argument)
{
    parameter_list *list = &st->parameters;

    // all groups at once, the one of the selected parameter, or one by name
    if (strcmp(argument, "all") == 0 || strcmp(argument, "none") == 0) {
        list->on_heading = argument[0] == 'a';
        for (int i = 0; i < parameter_count; i++) {
            list->folded[i] = list->on_heading;
        }
        return true;
    }
    int found = argument[0] == '\0' ? list->parameter : -1;
    for (int i = 0; i < parameter_count && found < 0; i++) {
        char name[PARAMETER_NAME];
        parameter_group_name(i, name, sizeof name);
        if (strcmp(name, argument) == 0) {
            found = i;
        }
    }
    if (found < 0) {
        return act_refuse(st, "there is no group '%s' of parameters", argument);
    }
    parameter_list_fold(list, found);
    return true;
}

bool act_filter(explorer_state *st, const char *argument)
{
    // of the open page, or of the side panel
    const panel_id panel = st->page != PANEL_NONE ? st->page : st->side.panel;
    char *text = st->filters.text[panel];
    snprintf(text, LINE_TEXT, "%s", argument);
    if (argument[0] == '\0') {
        st->filters.typing = panel;
    } else {
        st->filters.typing = PANEL_NONE;
    }
    act_settle_filter(st, panel);
    return true;
}

void act_settle_filter(explorer_state *st, panel_id panel)
{
    parameter_line lines[PARAMETER_LINES];
    st->drawn.scroll[panel] = 0;
    if (panel != PANEL_PARAMETERS || st->filters.text[panel][0] == '\0') {
        return;
    }

    // the selected parameter if it is still there, else the first that has an effect,
    // else the first
    int selected;
    const int count = state_parameter_lines(st, lines, &selected);
    const parameter_list *list = &st->parameters;
    const bool there = count > 0 && !lines[selected].heading &&
                       lines[selected].parameter == list->parameter;
    int best = -1;
    bool best_acts = false;
    for (int i = 0; i < count && !there && !best_acts; i++) {
        best_acts =
            !lines[i].heading && state_inert_reason(st, lines[i].parameter) == NULL;
        if (best_acts || (best < 0 && !lines[i].heading)) {
            best = i;
        }
    }
    if (best >= 0) {
        parameter_list_select(&st->parameters, lines[best]);
    }
}

bool act_mark(explorer_state *st, const char *argument)
{
    const session *s = &st->session;
    double time = s->now;
    if (!act_read_number_or(st, argument, "", &time)) {
        return false;
    }
    const double duration = s->effective.parameters.run.duration;
    if (!(time >= 0 && time <= duration)) {
        return act_refuse(st, "the run goes from 0 to %g s", duration);
    }
    const size_t side = argument[0] != '\0' ? 0 : trace_side(&s->run.trace, s->row);
    st->mark = (time_mark){argument[0] != '\0' || !st->mark.set, time, side};
    if (!st->mark.set) {
        return act_tell(st, "no mark");
    }
    return act_tell(st, "mark set: values now show the difference to it, X statistics "
                        "from it to the cursor");
}

// Whether Tab passes over a panel: one of the side with nothing to show, or one of the
// stack that has room there.
static bool is_passed_over(const explorer_state *st, panel_id id)
{
    if (panel_place_of(id) == PLACE_SIDE) {
        return id == PANEL_SWEEP && !lab_sweep_is_on(&st->sweep);
    }
    return !st->drawn.folded[id];
}

bool act_side(explorer_state *st, const char *argument)
{
    (void)argument;
    bool narrow = st->size.width > 0 && st->size.width < SIDE_WIDTH;

    // the panels of the side, then those that are folded for want of room
    panel_id next = st->side.panel;
    do {
        if (next + 1 == PANEL_IDS) {
            next = PANEL_NONE;
        } else {
            next = (panel_id)(next + 1);
        }
    } while (next != PANEL_NONE && is_passed_over(st, next));

    // a narrow screen: curves, each panel of the side, curves again
    if (narrow && (!st->side.in_front || next == PANEL_NONE)) {
        st->side.in_front = !st->side.in_front;
        next = PANEL_NONE;
    }
    if (next != PANEL_NONE) {
        st->side.panel = next;
    } else {
        st->side.panel = PANEL_PARAMETERS;
    }
    return true;
}

bool act_statistics(explorer_state *st, const char *argument)
{
    (void)argument;
    const bool there = st->side.panel == PANEL_STATISTICS;
    if (there) {
        st->side.panel = PANEL_PARAMETERS;
    } else {
        st->side.panel = PANEL_STATISTICS;
    }
    st->side.in_front = !there;
    return true;
}

// Opens a page at its beginning, or closes it.
static bool toggle_page(explorer_state *st, panel_id page)
{
    if (st->page == page) {
        st->page = PANEL_NONE;
    } else {
        st->page = page;
    }
    st->drawn.scroll[page] = 0;
    st->filters.text[page][0] = '\0';
    return true;
}

bool act_help(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_HELP);
}

bool act_info(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_INFO);
}

bool act_explain(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_EXPLAIN);
}

bool act_poles(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_POLES);
}

bool act_compare(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_COMPARISON);
}

bool act_runs(explorer_state *st, const char *argument)
{
    (void)argument;
    return toggle_page(st, PANEL_RUN_LIST);
}

bool act_why(explorer_state *st, const char *argument)
{
    (void)argument;
    return act_need_whole_run(st) && toggle_page(st, PANEL_WHY);
}

void act_drop_note(explorer_state *st, int index)
{
    assert(index >= 0 && index < st->note_count);
    st->note_count--;
    memmove(&st->notes[index], &st->notes[index + 1],
            (size_t)(st->note_count - index) * sizeof st->notes[0]);
    st->note -= st->note > 0 && st->note >= st->note_count;
}

bool act_note(explorer_state *st, const char *argument)
{
    double time = st->session.now;
    const char *text = argument;

    // at the cursor, or at an instant of its own
    if (*text == '@') {
        char *end;
        time = strtod(text + 1, &end);
        if (end == text + 1 || (*end != ' ' && *end != '\0') || !isfinite(time)) {
            return act_refuse(st, "'%.40s' is no instant, such as @0.35", text);
        }
        text = end + strspn(end, " ");
    }

    // in the order of instants; another text at one instant takes the place of the first
    int at = 0;
    while (at < st->note_count && st->notes[at].time < time &&
           !same_instant(st->notes[at].time, time)) {
        at++;
    }
    const bool there = at < st->note_count && same_instant(st->notes[at].time, time);
    if (*text == '\0') {
        if (!there) {
            return act_refuse(st, "note takes a text; there is none at %.5f s", time);
        }
        act_drop_note(st, at);
        return act_tell(st, "no note at %.5f s", time);
    }
    if (!there && st->note_count == NOTES) {
        return act_refuse(st, "%d notes are the most there can be (:notes drops some)",
                          NOTES);
    }
    if (!there) {
        memmove(&st->notes[at + 1], &st->notes[at],
                (size_t)(st->note_count++ - at) * sizeof st->notes[0]);
    }
    st->notes[at].time = time;
    snprintf(st->notes[at].text, sizeof st->notes[at].text, "%s", text);
    return act_tell(st, "noted at %.5f s; :notes lists them, figures show them", time);
}

bool act_notes(explorer_state *st, const char *argument)
{
    (void)argument;
    st->note = 0;
    return toggle_page(st, PANEL_NOTES);
}

bool act_changes(explorer_state *st, const char *argument)
{
    (void)argument;
    if (st->session.input_count > 0) {
        st->change = st->session.input_count - 1;
    } else {
        st->change = 0;
    }
    return toggle_page(st, PANEL_CHANGES);
}

// Goes on to the next value of a choice, or to the one that is named: the screen is drawn
// anew.
static bool choose(explorer_state *st, const look_choice *c, const char *argument)
{
    char all[128] = "";
    int *value = look_value(&st->looks, c), count = 0, found = -1;
    for (; c->words[count] != NULL; count++) {
        text_add(all, sizeof all, "%s%s", count > 0 ? ", " : "", c->words[count]);
        if (strcmp(argument, c->words[count]) == 0) {
            found = count;
        }
    }
    if (found < 0 && (argument[0] != '\0' || !c->goes_round)) {
        return act_refuse(st, "'%s' is none of %s", argument, all);
    }
    if (found >= 0) {
        *value = found;
    } else {
        *value = (*value + 1) % count;
    }
    st->looks.redraw |= found >= 0;
    const char *says = c->says[c->says[1] != NULL ? *value : 0];
    return says == NULL || act_tell(st, says, c->words[*value]);
}

bool act_theme(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("theme"), argument);
}

bool act_glyphs(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("glyphs"), argument);
}

bool act_colours(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("colours"), argument);
}

bool act_pixels(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("pixels"), argument);
}

bool act_closeup(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("closeup"), argument);
}

bool act_mouse(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("mouse"), argument);
}

bool act_lanes(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("lanes"), argument);
}

bool act_colourby(explorer_state *st, const char *argument)
{
    return choose(st, look_choice_of("colourby"), argument);
}

bool act_rate(explorer_state *st, const char *argument)
{
    double rate = 0;
    if (!act_read_number_or(st, argument, "off", &rate)) {
        return false;
    }
    if (rate < 0 || (rate > 0 && rate < 1)) {
        return act_refuse(st, "a rate is at least 1 kB/s, or off");
    }
    st->looks.rate = rate;
    if (rate > 0) {
        return act_tell(st, "pictures take at most %g kB/s", rate);
    }
    return act_tell(st, "pictures as fast as they are drawn");
}

bool act_bending(explorer_state *st, const char *argument)
{
    enum { MOST = 100 };
    double factor = 1;
    if (!act_read_number_or(st, argument, "", &factor)) {
        return false;
    }
    if (!(factor >= 1 && factor <= MOST)) {
        return act_refuse(st, "bending is drawn 1 to %d times as large", MOST);
    }
    st->looks.bending = factor;
    if (factor == 1) {
        return act_tell(st, "bending is drawn as it is");
    }
    return act_tell(st, "bending is drawn %g times as large", factor);
}

bool act_redraw(explorer_state *st, const char *argument)
{
    (void)argument;
    return st->looks.redraw = true;
}

bool act_quit_now(explorer_state *st, const char *argument)
{
    (void)argument;
    return st->quit = true;
}

bool act_quit(explorer_state *st, const char *argument)
{
    (void)argument;
    const session *s = &st->session;
    const int pins = st->kept_pins == st->pinned.pinned ? 0 : st->pinned.count;
    int changes = st->saved_version == state_run_id(st) ? 0 : s->input_count;
    for (int i = 0; i < st->visit_count; i++) {
        changes += st->visits[i].from.input_count;
    }

    // work is lost only if quitting is requested twice
    if (changes + pins == 0 || st->asked_to_quit) {
        return act_quit_now(st, "");
    }
    char lost[96] = "", pinned[48] = "";
    if (changes > 0) {
        snprintf(lost, sizeof lost, "%d change%s", changes, changes == 1 ? "" : "s");
    }
    if (pins > 0) {
        snprintf(pinned, sizeof pinned, "%d pinned run%s", pins, pins == 1 ? "" : "s");
    }
    st->asked_to_quit = true;
    return act_warn(st,
                    "%s%s%s would be lost: q leaves all the same, s keeps all, Esc stays",
                    lost, changes > 0 && pins > 0 ? " and " : "", pinned);
}

bool act_interrupt(explorer_state *st, const char *argument)
{
    if (st->session.computing != NULL) {
        return act_stop(st, "");
    }
    return act_quit(st, argument);
}

// --- the palette -----------------------------------------------------------------------

bool act_palette(explorer_state *st, const char *argument)
{
    scenario_menu_read_titles(&st->scenarios);
    prompt_open(&st->prompt, NULL, "%s", argument);
    st->prompt.searches = true;
    st->palette = (palette_view){0};
    return act_hush(st);
}

void act_move_in_palette(explorer_state *st, int direction)
{
    assert(direction == 1 || direction == -1);
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(&st->scenarios, &st->keys, st->prompt.text, entries);
    const int least = st->prompt.searches ? 0 : -1;
    int at = st->palette.selected + direction;
    if (at >= count) {
        at = count - 1;
    }
    if (at < least) {
        st->palette.selected = least;
    } else {
        st->palette.selected = at;
    }
}

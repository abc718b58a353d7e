// Actions on what is seen: marks, pages, notes, looks, the palette.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

bool act_select(explorer_model *model, explorer_view *view, const char *argument)
{
    parameter_line lines[PARAMETER_LINES];
    const lab_sweep *sweep = &model->sweep;
    const int direction = argument[0] == '-' ? -1 : 1;

    // the sweep selects among its runs, panels in which nothing is selected scroll
    if (view->side.panel == PANEL_SWEEP) {
        int by = direction;
        if (lab_sweep_is_map(sweep)) {
            by = -direction * (int)sweep->axis.count;
        }
        act_select_swept(model, by);
    } else if (view->side.panel != PANEL_PARAMETERS) {
        view->drawn.scroll[view->side.panel] += direction;
    } else {
        // the parameters end at both ends, without a way around
        int next;
        const int count = view_parameter_lines(view, lines, &next);
        next += direction;
        if (next >= 0 && next < count) {
            parameter_list_select(&view->parameters, lines[next]);
        }
    }
    return true;
}

// The group of a name, that of the selected parameter without one, or all of them.
bool act_fold(explorer_view *view, explorer_input *input, const char *argument)
{
    parameter_list *list = &view->parameters;

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
        return act_refuse(input, "there is no group '%s' of parameters", argument);
    }
    parameter_list_fold(list, found);
    return true;
}

bool act_filter(const explorer_model *model, explorer_view *view, const char *argument)
{
    // of the open page, or of the side panel
    const panel_id panel = view->page != PANEL_NONE ? view->page : view->side.panel;
    char *text = view->filters.text[panel];
    snprintf(text, LINE_TEXT, "%s", argument);
    if (argument[0] == '\0') {
        view->filters.typing = panel;
    } else {
        view->filters.typing = PANEL_NONE;
    }
    act_select_filtered(model, view, panel);
    return true;
}

void act_select_filtered(const explorer_model *model, explorer_view *view, panel_id panel)
{
    parameter_line lines[PARAMETER_LINES];
    view->drawn.scroll[panel] = 0;
    if (panel != PANEL_PARAMETERS || view->filters.text[panel][0] == '\0') {
        return;
    }

    // the selected parameter if it is still there, else the first that has an effect,
    // else the first
    int selected;
    const int count = view_parameter_lines(view, lines, &selected);
    const parameter_list *list = &view->parameters;
    const bool there = count > 0 && !lines[selected].heading &&
                       lines[selected].parameter == list->parameter;
    int best = -1;
    bool best_acts = false;
    for (int i = 0; i < count && !there && !best_acts; i++) {
        best_acts =
            !lines[i].heading && model_inert_reason(model, lines[i].parameter) == NULL;
        if (best_acts || (best < 0 && !lines[i].heading)) {
            best = i;
        }
    }
    if (best >= 0) {
        parameter_list_select(&view->parameters, lines[best]);
    }
}

bool act_mark(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const session *s = &model->session;
    double time = s->now;
    if (!act_read_number_or(input, argument, "", &time)) {
        return false;
    }
    const double duration = s->effective.parameters.run.duration;
    if (!(time >= 0 && time <= duration)) {
        return act_refuse(input, "the run goes from 0 to %g s", duration);
    }
    const size_t side = argument[0] != '\0' ? 0 : trace_side(&s->run.trace, s->row);
    view->mark = (time_mark){argument[0] != '\0' || !view->mark.set, time, side};
    if (!view->mark.set) {
        return act_tell(input, "no mark");
    }
    return act_tell(input, "mark set: values now show the difference to it, X statistics "
                           "from it to the cursor");
}

// Whether Tab passes over a panel: one of the side with nothing to show, or one of the
// stack that has room there.
static bool is_passed_over(const explorer_model *model, const explorer_view *view,
                           panel_id id)
{
    if (panel_place_of(id) == PLACE_SIDE) {
        return id == PANEL_SWEEP && !lab_sweep_is_on(&model->sweep);
    }
    return !view->drawn.folded[id];
}

bool act_side(const explorer_model *model, explorer_view *view)
{
    bool narrow = view->size.width > 0 && view->size.width < SIDE_WIDTH;

    // the panels of the side, then those that are folded for want of room
    panel_id next = view->side.panel;
    do {
        if (next + 1 == PANEL_IDS) {
            next = PANEL_NONE;
        } else {
            next = (panel_id)(next + 1);
        }
    } while (next != PANEL_NONE && is_passed_over(model, view, next));

    // a narrow screen: curves, each panel of the side, curves again
    if (narrow && (!view->side.in_front || next == PANEL_NONE)) {
        view->side.in_front = !view->side.in_front;
        next = PANEL_NONE;
    }
    if (next != PANEL_NONE) {
        view->side.panel = next;
    } else {
        view->side.panel = PANEL_PARAMETERS;
    }
    return true;
}

bool act_statistics(explorer_view *view)
{
    const bool there = view->side.panel == PANEL_STATISTICS;
    if (there) {
        view->side.panel = PANEL_PARAMETERS;
    } else {
        view->side.panel = PANEL_STATISTICS;
    }
    view->side.in_front = !there;
    return true;
}

// Opens a page at its beginning, or closes it.
static bool toggle_page(explorer_view *view, panel_id page)
{
    if (view->page == page) {
        view->page = PANEL_NONE;
    } else {
        view->page = page;
    }
    view->drawn.scroll[page] = 0;
    view->filters.text[page][0] = '\0';
    return true;
}

bool act_help(explorer_view *view)
{
    return toggle_page(view, PANEL_HELP);
}

bool act_info(explorer_view *view)
{
    return toggle_page(view, PANEL_INFO);
}

bool act_explain(explorer_view *view)
{
    return toggle_page(view, PANEL_EXPLAIN);
}

bool act_poles(explorer_view *view)
{
    return toggle_page(view, PANEL_POLES);
}

bool act_compare(explorer_view *view)
{
    return toggle_page(view, PANEL_COMPARISON);
}

bool act_runs(explorer_view *view)
{
    return toggle_page(view, PANEL_RUN_LIST);
}

bool act_why(const explorer_model *model, explorer_view *view, explorer_input *input)
{
    return act_need_whole_run(model, input) && toggle_page(view, PANEL_WHY);
}

void act_drop_note(explorer_model *model, explorer_view *view, int index)
{
    assert(index >= 0 && index < model->note_count);
    model->note_count--;
    memmove(&model->notes[index], &model->notes[index + 1],
            (size_t)(model->note_count - index) * sizeof model->notes[0]);
    view->note -= view->note > 0 && view->note >= model->note_count;
}

bool act_note(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double time = model->session.now;
    const char *text = argument;

    // at the cursor, or at an instant of its own
    if (*text == '@') {
        char *end;
        time = strtod(text + 1, &end);
        if (end == text + 1 || (*end != ' ' && *end != '\0') || !isfinite(time)) {
            return act_refuse(input, "'%.40s' is no instant, such as @0.35", text);
        }
        text = end + strspn(end, " ");
    }

    // in the order of instants; another text at one instant takes the place of the first
    int at = 0;
    while (at < model->note_count && model->notes[at].time < time &&
           !same_instant(model->notes[at].time, time)) {
        at++;
    }
    const bool there =
        at < model->note_count && same_instant(model->notes[at].time, time);
    if (*text == '\0') {
        if (!there) {
            return act_refuse(input, "note takes a text; there is none at %.5f s", time);
        }
        act_drop_note(model, view, at);
        return act_tell(input, "no note at %.5f s", time);
    }
    if (!there && model->note_count == NOTES) {
        return act_refuse(input, "%d notes are the most there can be (:notes drops some)",
                          NOTES);
    }
    if (!there) {
        memmove(&model->notes[at + 1], &model->notes[at],
                (size_t)(model->note_count++ - at) * sizeof model->notes[0]);
    }
    model->notes[at].time = time;
    snprintf(model->notes[at].text, sizeof model->notes[at].text, "%s", text);
    return act_tell(input, "noted at %.5f s; :notes lists them, figures show them", time);
}

bool act_notes(explorer_view *view)
{
    view->note = 0;
    return toggle_page(view, PANEL_NOTES);
}

bool act_changes(const explorer_model *model, explorer_view *view)
{
    if (model->session.input_count > 0) {
        view->change = model->session.input_count - 1;
    } else {
        view->change = 0;
    }
    return toggle_page(view, PANEL_CHANGES);
}

// Goes on to the next value of a choice, or to the one that is named: the screen is drawn
// anew.
static bool choose(explorer_view *view, explorer_input *input, const look_choice *c,
                   const char *argument)
{
    char all[128] = "";
    int *value = look_value(&view->looks, c), count = 0, found = -1;
    for (; c->words[count] != NULL; count++) {
        text_add(all, sizeof all, "%s%s", count > 0 ? ", " : "", c->words[count]);
        if (strcmp(argument, c->words[count]) == 0) {
            found = count;
        }
    }
    if (found < 0 && (argument[0] != '\0' || !c->goes_round)) {
        return act_refuse(input, "'%s' is none of %s", argument, all);
    }
    if (found >= 0) {
        *value = found;
    } else {
        *value = (*value + 1) % count;
    }
    view->looks.redraw |= found >= 0;
    const char *says = c->says[c->says[1] != NULL ? *value : 0];
    return says == NULL || act_tell(input, says, c->words[*value]);
}

bool act_theme(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("theme"), argument);
}

bool act_glyphs(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("glyphs"), argument);
}

bool act_colours(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("colours"), argument);
}

bool act_pixels(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("pixels"), argument);
}

bool act_closeup(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("closeup"), argument);
}

bool act_mouse(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("mouse"), argument);
}

bool act_lanes(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("lanes"), argument);
}

bool act_colourby(explorer_view *view, explorer_input *input, const char *argument)
{
    return choose(view, input, look_choice_of("colourby"), argument);
}

bool act_rate(explorer_view *view, explorer_input *input, const char *argument)
{
    double rate = 0;
    if (!act_read_number_or(input, argument, "off", &rate)) {
        return false;
    }
    if (rate < 0 || (rate > 0 && rate < 1)) {
        return act_refuse(input, "a rate is at least 1 kB/s, or off");
    }
    view->looks.rate = rate;
    if (rate > 0) {
        return act_tell(input, "pictures take at most %g kB/s", rate);
    }
    return act_tell(input, "pictures as fast as they are drawn");
}

bool act_bending(explorer_view *view, explorer_input *input, const char *argument)
{
    enum { MOST = 100 };
    double factor = 1;
    if (!act_read_number_or(input, argument, "", &factor)) {
        return false;
    }
    if (!(factor >= 1 && factor <= MOST)) {
        return act_refuse(input, "bending is drawn 1 to %d times as large", MOST);
    }
    view->looks.bending = factor;
    if (factor == 1) {
        return act_tell(input, "bending is drawn as it is");
    }
    return act_tell(input, "bending is drawn %g times as large", factor);
}

bool act_redraw(explorer_view *view)
{
    return view->looks.redraw = true;
}

bool act_quit_now(explorer_input *input)
{
    return input->quit = true;
}

bool act_quit(const explorer_model *model, explorer_input *input)
{
    const session *s = &model->session;
    const int pins = model->kept_pins == model->pinned.pinned ? 0 : model->pinned.count;
    int changes = model->saved_version == model_run_id(model) ? 0 : s->input_count;
    for (int i = 0; i < model->visit_count; i++) {
        changes += model->visits[i].from.input_count;
    }

    // work is lost only if quitting is requested twice
    if (changes + pins == 0 || input->asked_to_quit) {
        return act_quit_now(input);
    }
    char lost[96] = "", pinned[48] = "";
    if (changes > 0) {
        snprintf(lost, sizeof lost, "%d change%s", changes, changes == 1 ? "" : "s");
    }
    if (pins > 0) {
        snprintf(pinned, sizeof pinned, "%d pinned run%s", pins, pins == 1 ? "" : "s");
    }
    input->asked_to_quit = true;
    return act_warn(input,
                    "%s%s%s would be lost: q leaves all the same, s keeps all, Esc stays",
                    lost, changes > 0 && pins > 0 ? " and " : "", pinned);
}

bool act_interrupt(explorer_model *model, explorer_input *input)
{
    if (model->session.computing != NULL) {
        return act_stop(model, input);
    }
    return act_quit(model, input);
}

// --- the palette -----------------------------------------------------------------------

bool act_palette(explorer_view *view, explorer_input *input, const char *argument)
{
    scenario_menu_read_titles(&view->scenarios);
    prompt_open(&input->prompt, NULL, "%s", argument);
    input->prompt.searches = true;
    view->palette = (palette_view){0};
    return act_clear_message(input);
}

void act_move_in_palette(explorer_view *view, const explorer_input *input, int direction)
{
    assert(direction == 1 || direction == -1);
    static palette_entry entries[PALETTE_ENTRIES];
    const int count =
        palette_find(&view->scenarios, &view->keys, input->prompt.text, entries);
    const int least = input->prompt.searches ? 0 : -1;
    int at = view->palette.selected + direction;
    if (at >= count) {
        at = count - 1;
    }
    if (at < least) {
        view->palette.selected = least;
    } else {
        view->palette.selected = at;
    }
}

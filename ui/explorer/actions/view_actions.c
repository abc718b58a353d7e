// Actions on what is seen: marks, pages, notes, looks, the palette.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/instant.h"

void act_select_line(explorer_model *model, explorer_view *view, int direction)
{
    assert(direction == 1 || direction == -1);
    const lab_sweep *sweep = &model->sweep;

    // the sweep selects among its runs, of a map the next row up or down
    if (view->side.panel == PANEL_SWEEP) {
        int by = direction;
        if (lab_sweep_is_map(sweep)) {
            by = -direction * (int)sweep->axis.count;
        }
        act_select_swept(model, by);
        return;
    }

    // panels in which nothing is selected scroll
    if (view->side.panel != PANEL_PARAMETERS) {
        view->drawn.scroll[view->side.panel] += direction;
        return;
    }

    // the list of parameters has two ends, without a way around; headings are passed over
    parameter_line lines[PARAMETER_LINES];
    int selected;
    const int count = view_parameter_lines(view, lines, &selected);
    int next = selected + direction;
    while (next >= 0 && next < count && lines[next].heading) {
        next += direction;
    }
    if (next >= 0 && next < count) {
        view->parameters.parameter = lines[next].parameter;
    }
}

bool act_select(explorer_model *model, explorer_view *view, const char *argument)
{
    act_select_line(model, view, argument[0] == '-' ? -1 : 1);
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

// The line to select in a filtered list: the first parameter that has an effect, else the
// first parameter; -1 if there is none.
static int first_useful_line(const explorer_model *model,
                             const parameter_line lines[PARAMETER_LINES], int count)
{
    int first = -1;
    for (int i = 0; i < count; i++) {
        if (lines[i].heading) {
            continue;
        }
        if (model_inert_reason(model, lines[i].parameter) == NULL) {
            return i;
        }
        if (first < 0) {
            first = i;
        }
    }
    return first;
}

void act_select_filtered(const explorer_model *model, explorer_view *view, panel_id panel)
{
    view->drawn.scroll[panel] = 0;
    if (panel != PANEL_PARAMETERS || view->filters.text[panel][0] == '\0') {
        return;
    }

    // the selected parameter stays selected if it is among those that are shown
    parameter_line lines[PARAMETER_LINES];
    int selected;
    const int count = view_parameter_lines(view, lines, &selected);
    if (count > 0 && !lines[selected].heading) {
        return;
    }
    const int line = first_useful_line(model, lines, count);
    if (line >= 0) {
        view->parameters.parameter = lines[line].parameter;
    }
}

bool act_mark(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const session *s = &model->session;
    const bool at_cursor = argument[0] == '\0';
    double time = s->now;
    if (!at_cursor && !act_read_quantity(input, argument, "s", &time)) {
        return false;
    }
    const double duration = s->effective.parameters.run.duration;
    if (!(time >= 0 && time <= duration)) {
        return act_refuse(input, "the run goes from 0 to %g s", duration);
    }

    // at the cursor it is set and taken away in turn
    if (at_cursor && view->mark.set) {
        view->mark.set = false;
        return act_tell(input, "no mark");
    }
    view->mark = (time_mark){.set = true, .time = time};
    if (at_cursor) {
        view->mark.side = trace_side(&s->run.trace, s->row);
    }
    return act_tell(input, "mark set: values now show the difference to it, X statistics "
                           "from it to the cursor");
}

// Whether Tab passes over a panel: one that is not of the side, or has nothing to show.
static bool is_passed_over(const explorer_model *model, panel_id id)
{
    return panel_place_of(id) != PLACE_SIDE ||
           (id == PANEL_SWEEP && !lab_sweep_is_on(&model->sweep));
}

bool act_side(const explorer_model *model, explorer_view *view)
{
    const bool narrow = view->size.width > 0 && view->size.width < SIDE_WIDTH;

    // behind the knobs come all parameters
    const bool seen = !narrow || view->side.in_front;
    if (seen && view->side.panel == PANEL_PARAMETERS && !view->parameters.all) {
        view->parameters.all = true;
        return true;
    }
    view->parameters.all = false;

    // the panels of the side
    panel_id next = view->side.panel;
    do {
        if (next + 1 == PANEL_IDS) {
            next = PANEL_NONE;
        } else {
            next = (panel_id)(next + 1);
        }
    } while (next != PANEL_NONE && is_passed_over(model, next));

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

bool act_page(explorer_view *view, panel_id page, const char *filter)
{
    if (view->page == page) {
        view->page = PANEL_NONE;
    } else {
        view->page = page;
    }
    view->drawn.scroll[page] = 0;
    snprintf(view->filters.text[page], LINE_TEXT, "%s", filter);
    return true;
}

void act_drop_note(explorer_model *model, explorer_view *view, int index)
{
    assert(index >= 0 && index < model->note_count);
    model->note_count--;
    memmove(&model->notes[index], &model->notes[index + 1],
            (size_t)(model->note_count - index) * sizeof model->notes[0]);

    // the selection stays within the list
    if (view->note > 0 && view->note >= model->note_count) {
        view->note--;
    }
}

// Puts a text at an instant, before the note that has `index`, or in its place if it is
// of the same instant.
static bool put_note(explorer_model *model, explorer_input *input, int index, bool there,
                     double time, const char *text)
{
    if (!there && model->note_count == NOTES) {
        return act_refuse(input, "%d notes are the most there can be (:notes drops some)",
                          NOTES);
    }
    note *put = &model->notes[index];
    if (!there) {
        memmove(put + 1, put, (size_t)(model->note_count - index) * sizeof *put);
        model->note_count++;
    }
    put->time = time;
    snprintf(put->text, sizeof put->text, "%s", text);
    return act_tell(input, "noted at %.5f s; :notes lists them, figures show them", time);
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

    // its place in the order of instants
    const note *notes = model->notes;
    int at = 0;
    while (at < model->note_count && notes[at].time < time &&
           !same_instant(notes[at].time, time)) {
        at++;
    }
    const bool there = at < model->note_count && same_instant(notes[at].time, time);
    if (*text != '\0') {
        return put_note(model, input, at, there, time, text);
    }

    // without a text it is taken out
    if (!there) {
        return act_refuse(input, "note takes a text; there is none at %.5f s", time);
    }
    act_drop_note(model, view, at);
    return act_tell(input, "no note at %.5f s", time);
}

bool act_notes(explorer_view *view)
{
    view->note = 0;
    return act_page(view, PANEL_NOTES, "");
}

bool act_changes(const explorer_model *model, explorer_view *view)
{
    const int last = model->session.input_count - 1;
    view->change = last > 0 ? last : 0;
    return act_page(view, PANEL_CHANGES, "");
}

bool act_look(explorer_view *view, explorer_input *input, const char *command,
              const char *argument)
{
    const look_choice *c = look_choice_of(command);
    char all[128] = "";
    int count = 0, named = -1;
    for (; c->words[count] != NULL; count++) {
        const char *separator = count > 0 ? ", " : "";
        text_add(all, sizeof all, "%s%s", separator, c->words[count]);
        if (strcmp(argument, c->words[count]) == 0) {
            named = count;
        }
    }

    if (named < 0) {
        return act_refuse(input, "'%s' is none of %s", argument, all);
    }
    *look_value(&view->looks, c) = named;
    view->looks.redraw = true;

    // what is said of this value, or of any
    const char *says = c->says[0];
    if (c->says[1] != NULL) {
        says = c->says[named];
    }
    return says == NULL || act_tell(input, says, c->words[named]);
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
    view->looks.redraw = true;
    return true;
}

bool act_quit_now(explorer_input *input)
{
    input->quit = true;
    return true;
}

// --- the palette -----------------------------------------------------------------------

void act_open_palette(explorer_view *view, explorer_input *input, palette_scope scope,
                      const char *words)
{
    scenario_menu_read_titles(&view->scenarios);
    palette_read_files(&view->files);
    palette_take_path(&view->files, words);
    prompt_open(&input->prompt, NULL, "%s", words);
    input->prompt.searches = true;
    view->palette = (palette_view){.scope = scope};
    act_clear_message(input);
}

bool act_palette(explorer_view *view, explorer_input *input, const char *argument)
{
    act_open_palette(view, input, SCOPE_ALL, argument);
    return true;
}

void act_move_in_palette(const explorer_model *model, explorer_view *view,
                         const explorer_input *input, int lines)
{
    static palette_entry entries[PALETTE_ENTRIES];
    const int count = palette_find(model, view, input->prompt.text, entries);
    const int least = input->prompt.searches ? 0 : -1;
    int at = view->palette.selected + lines;
    if (at >= count) {
        at = count - 1;
    }
    if (at < least) {
        view->palette.selected = least;
    } else {
        view->palette.selected = at;
    }
}

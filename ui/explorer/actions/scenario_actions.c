// Actions on scenarios and lessons: opening one, its run as it is computed, answers.
#include "ui/explorer/actions/actions.h"

#include <string.h>

#include "ui/explorer/state/user_files.h"

// --- scenarios -------------------------------------------------------------------------

// Opens a scenario of a name as a session of its own.
static status open_session(const explorer_model *model, const char *name, session *fresh,
                           fault *f)
{
    scenario s;
    TRY(scenario_open(&s, name, keep_first_fault, f));
    s.parameters.code_allowed = consent_needed(&s) && consent_remembered(&s);
    return session_open(fresh, &s, model->session.patience, f);
}

bool act_open_scenario(explorer_model *model, explorer_view *view, explorer_input *input,
                       const char *name)
{
    session fresh;
    if (!act_succeeded(input, open_session(model, name, &fresh, &input->fault))) {
        return false;
    }

    // the new session takes the old one's place, to which u returns
    const int changes = model->session.input_count;
    const status code = state_take_session(model, view, &fresh, &input->fault);
    if (code != STATUS_OK) {
        session_finish(&fresh);
        return act_succeeded(input, code);
    }
    view->playback.playing = true;

    // its title, unless there is something to be said of its run
    if (act_tell_failed_run(model, input)) {
        return true;
    }
    const char *title = model->session.base.title ? model->session.base.title : "";
    if (changes == 0) {
        return act_tell(input, "%s", title);
    }
    return act_tell(input, "%s (u returns to %s and its changes)", title,
                    model->visits[model->present_visit - 1].from.base.name);
}

// The list of what can be opened, with the present scenario selected.
static void open_list(const explorer_model *model, explorer_view *view,
                      explorer_input *input)
{
    static palette_entry entries[PALETTE_ENTRIES];
    act_open_palette(view, input, SCOPE_SCENARIOS, "");
    const int present = scenario_menu_find(&view->scenarios, model->session.base.name);
    for (int i = palette_find(model, view, "", entries); i-- > 0;) {
        if (entries[i].kind != PALETTE_FILE && entries[i].index == present) {
            view->palette.selected = i;
        }
    }
}

bool act_open(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    const scenario_menu *menu = &view->scenarios;
    if (argument[0] == '\0') {
        open_list(model, view, input);
        return true;
    }

    // the neighbour in the list, or one by name
    int by = 0;
    if (strcmp(argument, "+1") == 0) {
        by = 1;
    } else if (strcmp(argument, "-1") == 0) {
        by = -1;
    }
    if (by == 0 || menu->count == 0) {
        return act_open_scenario(model, view, input, argument);
    }
    const int at = scenario_menu_find(menu, model->session.base.name) + by;
    return act_open_scenario(model, view, input,
                             menu->names[(at + 2 * menu->count) % menu->count]);
}

bool act_stop(explorer_model *model, explorer_input *input)
{
    session *s = &model->session;
    if (s->computing == NULL && model->search != NULL) {
        return act_end_search(model, input);
    }
    if (s->computing == NULL) {
        return act_refuse(input, "nothing is being computed");
    }
    if (session_stop(s)) {
        act_tell(input,
                 "stopped at %.4g s: Space at its end goes on, u takes the last change "
                 "back",
                 session_end(s));
    }
    return true;
}

bool act_allow(explorer_model *model, explorer_view *view, explorer_input *input)
{
    session *s = &model->session;
    if (s->run.summary.status != STATUS_NOT_ALLOWED) {
        return act_refuse(input, "the run asks for no permission");
    }
    if (!act_succeeded(input, session_allow_code(s, &input->fault))) {
        return false;
    }

    // a visit's changes are the user's own: what is remembered is the scenario as it was
    // opened
    bool kept;
    const bool done =
        act_succeeded(input, consent_remember(&s->base, &kept, &input->fault));
    view->playback.playing = true;

    // a run that fails all the same is said first
    if (act_tell_failed_run(model, input)) {
        return true;
    }
    if (!done) {
        return false;
    }
    if (kept) {
        return act_tell(input,
                        "allowed, and remembered for just this scenario and program");
    }
    return act_tell(input, "allowed for this visit");
}

// --- lessons ---------------------------------------------------------------------------

// The present step; NULL without a lesson.
static const lesson_step *present_step(const explorer_model *model)
{
    const lesson *l = &model->session.base.lesson;
    if (model->lesson.on && model->lesson.step < l->step_count) {
        return &l->steps[model->lesson.step];
    }
    return NULL;
}

// The scenario of a lesson's name, the whole one or its last part; NULL if there is none.
static const char *lesson_named(explorer_view *view, const char *name)
{
    const scenario_menu *menu = &view->scenarios;
    const char *found = NULL;
    scenario_menu_read_titles(&view->scenarios);
    for (int i = 0; i < menu->count; i++) {
        const char *whole = menu->names[i];
        const bool same =
            strcmp(whole, name) == 0 || strcmp(scenario_leaf(whole), name) == 0;
        if (same && scenario_menu_text(menu, i).is_lesson) {
            found = whole;
        }
    }
    return found;
}

bool act_lesson(explorer_model *model, explorer_view *view, explorer_input *input,
                const char *argument)
{
    // without a name the list of them, or the word that ends one
    if (argument[0] == '\0') {
        act_open_palette(view, input, SCOPE_LESSONS, "");
        return true;
    }
    if (strcmp(argument, "off") == 0) {
        model->lesson.on = false;
        return true;
    }

    // its scenario brings the lesson along
    const char *name = lesson_named(view, argument);
    if (name == NULL) {
        return act_refuse(input, "there is no lesson '%.60s' (:lesson lists them)",
                          argument);
    }
    return act_open_scenario(model, view, input, name) && act_clear_message(input);
}

void act_follow_lesson(explorer_model *model)
{
    lesson_progress *progress = &model->lesson;
    const lesson_step *step = present_step(model);
    if (step != NULL && step->check != LESSON_READ &&
        lesson_step_is_done(step, progress, &model->session, &model->pinned)) {
        progress->passed = true;
    }
}

bool act_answer(explorer_model *model, explorer_input *input, const char *argument)
{
    const lesson_step *step = present_step(model);
    if (step == NULL) {
        return act_refuse(input, "there is no lesson here (:lesson lists them)");
    }
    const bool choice = step->check == LESSON_CHOICE;
    if (step->check != LESSON_NUMBER && !choice) {
        return act_refuse(input, "this step wants no answer: do what it says");
    }

    // without an answer it is asked for
    if (argument[0] == '\0') {
        prompt_open(&input->prompt, NULL, "answer ");
        if (choice) {
            return act_tell(input, "the number of an answer");
        }
        return act_tell(input, "a number");
    }
    double value;
    if (!act_read_number(input, argument, &value)) {
        return false;
    }

    // a wrong one may be followed by another
    model->lesson.answered = true;
    model->lesson.answer = value;
    act_follow_lesson(model);
    if (model->lesson.passed) {
        return act_clear_message(input);
    }
    return act_warn(input, "not %g. %s", value, step->hint);
}

bool act_continue(explorer_model *model, explorer_input *input)
{
    const lesson *l = &model->session.base.lesson;
    const lesson_step *step = present_step(model);
    if (step == NULL) {
        return act_refuse(input, "there is no lesson here (:lesson lists them)");
    }
    act_follow_lesson(model);
    if (step->check != LESSON_READ && !model->lesson.passed) {
        return act_warn(input, "not yet. %s", step->hint);
    }

    // after the last one the lab is as it always is
    if (model->lesson.step + 1 == l->step_count) {
        model->lesson.on = false;
        return act_tell(input, "that was the lesson '%s'; :lesson lists the others",
                        model->session.base.title);
    }

    // a step may ask for what the event at the cursor says
    model->lesson = (lesson_progress){.on = true, .step = model->lesson.step + 1};
    return act_clear_message(input) && act_tell_event(model, input);
}

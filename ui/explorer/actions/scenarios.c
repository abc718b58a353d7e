// Actions on scenarios and lessons: opening one, its run as it is computed, answers.
#include "ui/explorer/actions/actions.h"

#include <string.h>

#include "src/rig/external/process_lines.h"
#include "ui/explorer/state/user_files.h"

// --- scenarios -------------------------------------------------------------------------

bool act_open_scenario(explorer_state *st, const char *name)
{
    scenario s;
    session fresh;
    status code = scenario_open(&s, name, keep_first_fault, &st->fault);
    if (code == STATUS_OK) {
        s.parameters.code_allowed = consent_needed(&s) && consent_remembered(&s);
        code = session_open(&fresh, &s, st->session.patience, &st->fault);
    }
    if (code != STATUS_OK) {
        return act_worked(st, code);
    }

    // the new session takes the old one's place, to which u returns
    const int changes = st->session.input_count;
    code = state_take_session(st, &fresh, &st->fault);
    if (code != STATUS_OK) {
        session_finish(&fresh);
        return act_worked(st, code);
    }
    st->playback.playing = true;
    const char *title = st->session.base.title ? st->session.base.title : "";
    if (act_tell_failed_run(st)) {
        return true;
    }
    if (changes == 0) {
        return act_tell(st, "%s", title);
    }
    return act_tell(st, "%s (u returns to %s and its changes)", title,
                    st->visits[st->present_visit - 1].from.base.name);
}

// The list of scenarios with the present one selected.
static void open_list(explorer_state *st)
{
    scenario_menu *menu = &st->scenarios;
    int at = scenario_menu_find(menu, st->session.base.name);
    st->page = PANEL_SCENARIOS;
    if (at < 0) {
        menu->selected = 0;
    } else {
        menu->selected = at;
    }
    st->drawn.first_scenario = -1;
    menu->filter[0] = '\0';
    scenario_menu_read_titles(menu);
}

bool act_open(explorer_state *st, const char *argument)
{
    const scenario_menu *menu = &st->scenarios;
    if (argument[0] == '\0') {
        open_list(st);
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
        return act_open_scenario(st, argument);
    }
    const int at = scenario_menu_find(menu, st->session.base.name) + by;
    return act_open_scenario(st, menu->names[(at + 2 * menu->count) % menu->count]);
}

bool act_find(explorer_state *st, const char *argument)
{
    open_list(st);
    snprintf(st->scenarios.filter, sizeof st->scenarios.filter, "%s", argument);
    st->scenarios.filtering = true;
    scenario_menu_move(&st->scenarios, 0);
    return true;
}

bool act_stop(explorer_state *st, const char *argument)
{
    (void)argument;
    session *s = &st->session;
    if (s->computing == NULL) {
        return act_refuse(st, "nothing is being computed");
    }
    return !session_stop(s) || act_tell(st,
                                        "stopped at %.4g s: Space at its end goes on, u "
                                        "takes the last change back",
                                        session_end(s));
}

bool act_allow(explorer_state *st, const char *argument)
{
    (void)argument;
    session *s = &st->session;
    bool kept;
    if (s->run.summary.status != STATUS_NOT_ALLOWED) {
        return act_refuse(st, "the run asks for no permission");
    }

    // a visit's changes are the user's own: what is remembered is the scenario as it was
    // opened
    if (!act_worked(st, session_allow_code(s, &st->fault))) {
        return false;
    }
    const bool done = act_worked(st, consent_remember(&s->base, &kept, &st->fault));
    st->playback.playing = true;
    if (act_tell_failed_run(st)) {
        return true;
    }
    if (!done) {
        return false;
    }
    if (kept) {
        return act_tell(st, "allowed, and remembered for just this scenario and program");
    }
    return act_tell(st, "allowed for this visit");
}

void act_tell_replay(explorer_state *st)
{
    const process_replay again = session_take_replay(&st->session);
    const message_line before = st->message;
    if (again.restarted) {
        act_tell(st,
                 "%.600s%sthe program was started anew and went through its %d "
                 "samples up to %.4g s once more",
                 before.text, before.text[0] ? "; " : "", again.samples, again.time);
        st->message.warning = before.text[0] != '\0' && before.warning;
    }
}

// --- lessons ---------------------------------------------------------------------------

// The present step; NULL without a lesson.
static const lesson_step *present_step(const explorer_state *st)
{
    const lesson *l = &st->session.base.lesson;
    if (st->lesson.on && st->lesson.step < l->step_count) {
        return &l->steps[st->lesson.step];
    }
    return NULL;
}

// The scenario of a lesson's name: the full name, or an ending that only one lesson has.
static const char *lesson_named(explorer_state *st, const char *name)
{
    const scenario_menu *menu = &st->scenarios;
    const char *found = NULL;
    scenario_menu_read_titles(&st->scenarios);
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

bool act_lesson(explorer_state *st, const char *argument)
{
    // without a name the list of them, or the word that ends one
    if (argument[0] == '\0') {
        act_find(st, "lesson");
        st->scenarios.filtering = false;
        return true;
    }
    if (strcmp(argument, "off") == 0) {
        st->lesson.on = false;
        return true;
    }

    // its scenario brings the lesson along
    const char *name = lesson_named(st, argument);
    if (name == NULL) {
        return act_refuse(st, "there is no lesson '%.60s' (:lesson lists them)",
                          argument);
    }
    return act_open_scenario(st, name) && act_hush(st);
}

void act_follow_lesson(explorer_state *st)
{
    const lesson_step *step = present_step(st);
    st->lesson.passed =
        st->lesson.passed ||
        (step != NULL && step->check != LESSON_READ &&
         lesson_step_is_done(step, &st->lesson, &st->session, &st->pinned));
}

bool act_answer(explorer_state *st, const char *argument)
{
    const lesson_step *step = present_step(st);
    double value;
    if (step == NULL) {
        return act_refuse(st, "there is no lesson here (:lesson lists them)");
    }
    const bool choice = step->check == LESSON_CHOICE;
    if (step->check != LESSON_NUMBER && !choice) {
        return act_refuse(st, "this step wants no answer: do what it says");
    }
    if (argument[0] == '\0') {
        prompt_open(&st->prompt, NULL, "answer ");
        if (choice) {
            return act_tell(st, "the number of an answer");
        }
        return act_tell(st, "a number");
    }
    if (!act_read_number(st, argument, &value)) {
        return false;
    }

    // a wrong one may be followed by another
    st->lesson.answered = true;
    st->lesson.answer = value;
    act_follow_lesson(st);
    if (st->lesson.passed) {
        return act_hush(st);
    }
    return act_warn(st, "not %g. %s", value, step->hint);
}

bool act_continue(explorer_state *st, const char *argument)
{
    (void)argument;
    const lesson *l = &st->session.base.lesson;
    const lesson_step *step = present_step(st);
    if (step == NULL) {
        return act_refuse(st, "there is no lesson here (:lesson lists them)");
    }
    act_follow_lesson(st);
    if (step->check != LESSON_READ && !st->lesson.passed) {
        return act_warn(st, "not yet. %s", step->hint);
    }

    // after the last one the lab is as it always is
    if (st->lesson.step + 1 == l->step_count) {
        st->lesson.on = false;
        return act_tell(st, "that was the lesson '%s'; :lesson lists the others",
                        st->session.base.title);
    }
    // a step may ask for what the event at the cursor says
    st->lesson = (lesson_progress){.on = true, .step = st->lesson.step + 1};
    return act_hush(st) && act_tell_event(st);
}

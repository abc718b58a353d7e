// Actions on lessons: opening one, answering, going on.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// The present step; NULL without a lesson.
static const lesson_step *present_step(const explorer_state *st)
{
    const lesson *l = &st->session.base.lesson;
    return st->lesson.on && st->lesson.step < l->step_count ? &l->steps[st->lesson.step] : NULL;
}

// The scenario of a lesson's name: the full name, or an ending that only one lesson has.
static const char *lesson_named(explorer_state *st, const char *name)
{
    const scenario_menu *menu = &st->scenarios;
    const char *found = NULL;
    scenario_menu_read_titles(&st->scenarios);
    for (int i = 0; i < menu->count; i++) {
        const char *slash = strrchr(menu->names[i], '/');
        const char *leaf = slash != NULL ? slash + 1 : menu->names[i];
        if (scenario_menu_is_lesson(menu, i) &&
            (strcmp(menu->names[i], name) == 0 || strcmp(leaf, name) == 0)) {
            found = menu->names[i];
        }
    }
    return found;
}

action_result act_open_lesson(explorer_state *st, const char *argument)
{
    // without a name the list of them
    if (argument[0] == '\0') {
        const action_result listed = act_find_scenario(st, "lesson");
        st->scenarios.filtering = false;
        return listed;
    }

    // the word that ends one
    if (strcmp(argument, "off") == 0) {
        st->lesson.on = false;
        return result_done();
    }

    // its scenario brings the lesson along
    const char *name = lesson_named(st, argument);
    if (name == NULL) {
        return result_refused("there is no lesson '%.60s' (:lesson lists them)", argument);
    }
    const action_result opened = act_open_scenario(st, name);
    return result_ok(&opened) ? result_quiet() : opened;
}

action_result act_follow_lesson(explorer_state *st)
{
    assert(st != NULL);
    const lesson_step *step = present_step(st);
    if (step == NULL || st->lesson.passed || step->check == LESSON_READ ||
        !lesson_step_is_done(step, &st->lesson, &st->session, &st->pinned)) {
        return result_done();
    }
    st->lesson.passed = true;
    return result_done();
}

action_result act_answer(explorer_state *st, const char *argument)
{
    const lesson_step *step = present_step(st);
    if (step == NULL) {
        return result_refused("there is no lesson here (:lesson lists them)");
    }
    if (step->check != LESSON_NUMBER && step->check != LESSON_CHOICE) {
        return result_refused("this step wants no answer: do what it says");
    }
    if (argument[0] == '\0') {
        prompt_open(&st->prompt, "answer ");
        return result_news("%s",
                           step->check == LESSON_CHOICE ? "the number of an answer" : "a number");
    }
    double value;
    const action_result read = act_read_number(argument, &value);
    if (!result_ok(&read)) {
        return read;
    }

    // a wrong one may be followed by another
    st->lesson.answered = true;
    st->lesson.answer = value;
    act_follow_lesson(st);
    return st->lesson.passed ? result_quiet() : result_warning("not %g. %s", value, step->hint);
}

action_result act_go_on(explorer_state *st, const char *argument)
{
    (void)argument;
    const lesson *l = &st->session.base.lesson;
    const lesson_step *step = present_step(st);
    if (step == NULL) {
        return result_refused("there is no lesson here (:lesson lists them)");
    }
    act_follow_lesson(st);
    if (step->check != LESSON_READ && !st->lesson.passed) {
        return result_warning("not yet. %s", step->hint);
    }

    // after the last one the lab is as it always is
    if (st->lesson.step + 1 == l->step_count) {
        st->lesson.on = false;
        return result_news("that was the lesson '%s'; :lesson lists the others",
                           st->session.base.title);
    }
    st->lesson = (lesson_progress){.on = true, .step = st->lesson.step + 1};
    return result_quiet();
}

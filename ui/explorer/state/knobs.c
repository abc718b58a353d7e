// The knobs: the few parameters that a run is about, so that a newcomer need not know
// all.
#include <string.h>

#include "src/rig/controller.h"
#include "src/scenario/effect.h"
#include "ui/explorer/state/state.h"

// The number of a law's own that it begins with, or what it presses with if it does; -1
// if it has none.
static int parameter_of_law(const controller *law)
{
    const int force = PARAMETER_INDEX(control.force);
    int first = -1;
    for (int i = 0; i < law->parameter_count; i++) {
        char path[PARAMETER_NAME];
        snprintf(path, sizeof path, "control.%s", law->parameters[i].name);
        const int own = parameter_find(path);
        if (own == force) {
            return force;
        }
        if (i == 0) {
            first = own;
        }
    }
    return first;
}

int model_main_parameter(const explorer_model *model)
{
    const int kind = model->session.effective.parameters.control.law;
    const controller *law = controller_of(kind);
    const int own = law != NULL ? parameter_of_law(law) : -1;
    if (own >= 0) {
        return own;
    }
    if (kind != LAW_NONE) {
        return PARAMETER_INDEX(control.rate);
    }
    return PARAMETER_INDEX(motor.voltage);
}

// Whether a parameter is about how a run is computed or written down, and not about the
// arm, its wall and its law.
static bool is_about_computing(int parameter)
{
    char group[PARAMETER_NAME];
    parameter_group_name(parameter, group, sizeof group);
    return strcmp(group, "method") == 0 || strcmp(group, "run") == 0 ||
           strcmp(group, "printed") == 0 || strcmp(group, "belief") == 0;
}

// Adds a parameter to the knobs, `most` at most, unless it is one, or turning it would
// change nothing.
static void add_knob(const scenario *s, parameter_list *list, int most, int parameter)
{
    for (int i = 0; i < list->knob_count; i++) {
        if (list->knobs[i] == parameter) {
            return;
        }
    }
    if (list->knob_count < most && effect_none(s, parameter) == NULL) {
        list->knobs[list->knob_count++] = parameter;
    }
}

// Adds what a scenario gives, as far as a number or a word can be turned in a run of it.
static void add_given(const scenario *s, const scenario *run, parameter_list *list,
                      int most)
{
    for (int i = 0; i < parameter_count; i++) {
        const bool given = s->parameters.set[i] != 0;
        if (given && !parameter_is_text(&parameter_table[i]) && !is_about_computing(i)) {
            add_knob(run, list, most, i);
        }
    }
}

// Adds what the law has of its own, in its order.
static void add_of_law(const scenario *s, parameter_list *list, int most)
{
    const controller *law = controller_of(s->parameters.control.law);
    for (int i = 0; law != NULL && i < law->parameter_count; i++) {
        char path[PARAMETER_NAME];
        snprintf(path, sizeof path, "control.%s", law->parameters[i].name);
        const int own = parameter_find(path);
        if (own >= 0) {
            add_knob(s, list, most, own);
        }
    }
}

// Whether the selected parameter is among the knobs.
static bool knob_is_selected(const parameter_list *list)
{
    for (int i = 0; i < list->knob_count; i++) {
        if (list->knobs[i] == list->parameter) {
            return true;
        }
    }
    return false;
}

// Fills in the knobs of a run.
static void find_knobs(const explorer_model *model, parameter_list *list)
{
    const int usual[] = {PARAMETER_INDEX(motor.voltage),   PARAMETER_INDEX(arm.k2),
                         PARAMETER_INDEX(control.law),     PARAMETER_INDEX(wall.angle),
                         PARAMETER_INDEX(wall.stiffness),  PARAMETER_INDEX(arm.EI),
                         PARAMETER_INDEX(wall.restitution)};
    enum { USUAL = sizeof usual / sizeof usual[0] };
    const session *s = &model->session;
    const scenario *run = &s->effective;
    const lesson *l = &s->base.lesson;
    list->knob_count = 0;

    // what the run is about; in a lesson what that is about
    if (model->lesson.on && l->parameter_count > 0) {
        for (int i = 0; i < l->parameter_count; i++) {
            add_knob(run, list, MOST_KNOBS, l->parameters[i]);
        }
        return;
    }
    add_knob(run, list, MOST_KNOBS, model_main_parameter(model));

    // what was changed keeps its place behind what is there before any change
    enum { BEFORE_CHANGES = 7 };
    add_given(&s->base, run, list, BEFORE_CHANGES - 3);
    add_of_law(run, list, BEFORE_CHANGES - 2);
    for (int i = 0; i < USUAL; i++) {
        add_knob(run, list, BEFORE_CHANGES, usual[i]);
    }
    for (int i = s->input_count; i-- > 0;) {
        if (s->inputs[i].kind != SESSION_INPUT_PUSH) {
            add_knob(run, list, MOST_KNOBS, s->inputs[i].parameter);
        }
    }
}

void model_choose_knobs(const explorer_model *model, parameter_list *list)
{
    const bool selected = knob_is_selected(list);
    find_knobs(model, list);
    if (selected && !knob_is_selected(list) && list->knob_count > 0) {
        list->parameter = list->knobs[0];
    }
}

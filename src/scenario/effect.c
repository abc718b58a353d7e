#include "src/scenario/effect.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/engines/motion_create.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/tables/features.h"
#include "src/tables/settings.h"

// --- features of a scenario ------------------------------------------------------------

// Whether an action happens, and sets a parameter.
static bool sets(const scenario *s, const action *a, int parameter)
{
    return a->kind == ACTION_SET && a->parameter == parameter &&
           a->time <= s->parameters.run.duration;
}

// Some features, if a condition holds.
static feature_set when(bool condition, feature_set bits)
{
    if (condition) {
        return bits;
    }
    return 0;
}

// Which of its engines the event method integrates with, as far as it may choose.
static feature_set engine_features(const parameters *p, feature_set features)
{
    const bool able = features_suit_pair(features);
    if ((features & HAS(EVENT)) == 0) {
        return 0;
    }
    if (!able || p->method.engine == ENGINE_STIFF) {
        return HAS(STIFF) | when(able, HAS(PAIR));
    }

    // the engine `pair`, unless the arm itself is beyond it
    arm a;
    arm_init(&a, p);
    const bool chosen = p->method.engine == ENGINE_AUTO && !motion_suits_pair(&a);
    return HAS(PAIR) | when(chosen, HAS(STIFF));
}

// Whether a law has a parameter control.NAME and reads it; of one from outside nobody
// knows.
static bool law_reads(int law, const char *name)
{
    char word[ACTION_PATH];
    const controller *own = controller_of(law);
    snprintf(word, sizeof word, " %s ", name);
    return own == NULL || (controller_find_parameter(own, name) >= 0 &&
                           strstr(control_law_table[law].ignored, word) == NULL);
}

// What a parameter control.NAME is to the law.
static feature_set own_features(const parameters *p, int parameter)
{
    const char *name = strchr(parameter_table[parameter].path, '.') + 1;
    double given;
    const bool replaced = p->control.law != LAW_PROCESS && settings_get(p, name, &given);
    return when(law_reads(p->control.law, name), HAS(READ)) | when(!replaced, HAS(ALONE));
}

static feature_set law_features(const scenario *s, const parameters *p)
{
    const control_law_info *law = &control_law_table[p->control.law];
    const controller *own = controller_of(p->control.law);
    bool steps = false;
    for (int i = 0; i < s->action_count; i++) {
        steps = steps || sets(s, &s->actions[i], PARAMETER_INDEX(control.force));
    }

    // with a limit the rig predicts the force of a touch, by the same model
    const bool forecasts = p->control.law != LAW_NONE && p->control.force_limit > 0;
    const bool moves = steps || p->control.force_amplitude > 0;
    return law->told | when(moves, law->told_where_force_moves) |
           when(forecasts, TOLD_ARM | HAS(TOLD_HUB_SPRING) | HAS(TOLD_DAMPING)) |
           when(own == NULL || own->lockable, HAS(LOCKABLE)) |
           when(law_reads(p->control.law, "force"), HAS(FORCE_READ)) |
           when(steps, HAS(FORCE_STEPS));
}

// --- effects ---------------------------------------------------------------------------

// Why a parameter has no effect as long as the parameters are these.
static const char *inert_with(const scenario *s, const parameters *p, int parameter)
{
    const feature_set own = features_of(p);
    return features_inert(own | law_features(s, p) | own_features(p, parameter) |
                              engine_features(p, own),
                          parameter);
}

// The path that action `first` of the script sets, or that of a parameter if that is -1.
static const char *path_set(const scenario *s, int parameter, int first,
                            char path[ACTION_PATH])
{
    if (first < 0) {
        return parameter_table[parameter].path;
    }
    return action_path(&s->actions[first], path);
}

// Whether an action gives another value to what action `first` sets, or to a parameter if
// that is -1.
static bool sets_again(const scenario *s, const action *a, int parameter, int first)
{
    char path[ACTION_PATH], again[ACTION_PATH];
    return sets(s, a, parameter) &&
           strcmp(action_path(a, again), path_set(s, parameter, first, path)) == 0;
}

// Whether other actions follow at the instant of action i (-1: the start), with which it
// goes together.
static bool others_at_once(const scenario *s, int i)
{
    double now = 0;
    if (i >= 0) {
        now = s->actions[i].time;
    }
    return i + 1 < s->action_count && s->actions[i + 1].time <= now;
}

const char *effect_none_from(const scenario *s, int parameter, int first)
{
    assert(parameter >= 0 && parameter < parameter_count && first < s->action_count);
    const char *why = "the run has ended";
    if (first < 0) {
        why = "the script gives it another value at once";
    }

    // from the start on, until it gets another value or the run ends
    parameters p = s->parameters;
    for (int i = -1; i < s->action_count; i++) {
        if (i >= 0) {
            const action *a = &s->actions[i];
            if (a->time > p.run.duration ||
                (i > first && sets_again(s, a, parameter, first))) {
                break;
            }
            action_apply(a, &p, NULL);
        }

        if (i >= first && !others_at_once(s, i)) {
            why = inert_with(s, &p, parameter);
        }
        if (why == NULL) {
            return NULL;
        }
    }
    return why;
}

const char *effect_none(const scenario *s, int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const char *why = NULL;
    parameters p = s->parameters;
    for (int i = -1; i < s->action_count; i++) {
        if (i >= 0) {
            action_apply(&s->actions[i], &p, NULL);
        }
        why = inert_with(s, &p, parameter);
        if (why == NULL) {
            return NULL;
        }
    }
    return why;
}

// Whether a place, among the parameters and then the actions, gives a parameter a value.
static bool gives_value(const scenario *s, int place)
{
    if (place < parameter_count) {
        return s->parameters.set[place] != 0;
    }
    return s->actions[place - parameter_count].kind == ACTION_SET;
}

// What is given there: whether that has no effect, and why.
static bool look_at(const scenario *s, int place, idle_value *idle)
{
    if (place < parameter_count) {
        idle->why = effect_none_from(s, place, -1);
        idle->line = s->lines[place];
        snprintf(idle->path, sizeof idle->path, "%s", parameter_table[place].path);
    } else {
        const int number = place - parameter_count;
        const action *a = &s->actions[number];
        idle->why = effect_none_from(s, a->parameter, number);
        idle->line = a->line;
        action_path(a, idle->path);
    }
    return idle->why != NULL;
}

bool effect_next_idle(const scenario *s, int *place, idle_value *idle)
{
    while (*place < parameter_count + s->action_count) {
        const int here = (*place)++;
        if (gives_value(s, here) && look_at(s, here, idle)) {
            return true;
        }
    }
    return false;
}

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

// Whether an action sets a parameter before the run ends.
static bool sets(const scenario *s, const action *a, int parameter)
{
    return a->kind == ACTION_SET && a->parameter == parameter &&
           a->time <= s->parameters.run.duration;
}

// The features `bits` if a condition holds, else none.
static feature_set when(bool condition, feature_set bits)
{
    if (condition) {
        return bits;
    }
    return 0;
}

// The features that say which of its engines the event method integrates with: PAIR where
// the fast engine for two links can take the arm, STIFF where the general one takes it.
// Both are set where the choice matters.
static feature_set engine_features(const parameters *p, feature_set features)
{
    const bool able = features_suit_pair(features);
    if ((features & HAS(EVENT)) == 0) {
        return 0;
    }
    if (!able || p->method.engine == ENGINE_STIFF) {
        return HAS(STIFF) | when(able, HAS(PAIR));
    }

    // the engine `pair`, unless method.engine = auto and the arm's values are beyond it
    arm a;
    arm_init(&a, p);
    const bool chosen = p->method.engine == ENGINE_AUTO && !motion_suits_pair(&a);
    return HAS(PAIR) | when(chosen, HAS(STIFF));
}

// Whether a law has a parameter control.NAME and reads it. A law from outside (plug-in or
// process) may read any.
static bool law_reads(int law, const char *name)
{
    const controller *own = controller_of(law);
    if (own == NULL) {
        return true;
    }

    // `ignored` lists names with blanks around each
    char word[ACTION_PATH];
    snprintf(word, sizeof word, " %s ", name);
    return controller_find_parameter(own, name) >= 0 &&
           strstr(control_law_table[law].ignored, word) == NULL;
}

// The features of one parameter control.NAME under the law in force: whether the law
// reads it, and whether it is the only one to give its value, as control.settings may
// replace it.
static feature_set own_features(const parameters *p, int parameter)
{
    const char *name = strchr(parameter_table[parameter].path, '.') + 1;
    double given;
    const bool replaced = p->control.law != LAW_PROCESS && settings_get(p, name, &given);
    return when(law_reads(p->control.law, name), HAS(READ)) | when(!replaced, HAS(ALONE));
}

// The features that follow from the control law: which values of the arm it is told,
// whether its mode can be held, and how it uses the commanded force.
static feature_set law_features(const scenario *s, const parameters *p)
{
    const control_law_info *law = &control_law_table[p->control.law];
    const controller *own = controller_of(p->control.law);

    // whether the script changes the commanded force
    bool steps = false;
    for (int i = 0; i < s->action_count; i++) {
        steps = steps || sets(s, &s->actions[i], PARAMETER_INDEX(control.force));
    }

    // with a force limit the rig predicts the force of a touch, from what the law is told
    const bool forecasts = p->control.law != LAW_NONE && p->control.force_limit > 0;
    const bool moves = steps || p->control.force_amplitude > 0;
    return law->told | when(moves, law->told_where_force_moves) |
           when(forecasts, TOLD_ARM | HAS(TOLD_HUB_SPRING) | HAS(TOLD_DAMPING)) |
           when(own == NULL || own->lockable, HAS(LOCKABLE)) |
           when(law_reads(p->control.law, "force"), HAS(FORCE_READ)) |
           when(steps, HAS(FORCE_STEPS));
}

// --- effects ---------------------------------------------------------------------------

// Why a parameter has no effect while the parameters are `p`; NULL if it has one.
static const char *inert_with(const scenario *s, const parameters *p, int parameter)
{
    const feature_set own = features_of(p);
    return features_inert(own | law_features(s, p) | own_features(p, parameter) |
                              engine_features(p, own),
                          parameter);
}

// The path that action `first` of the script sets; for first = -1, the start of the run,
// the path of the parameter.
static const char *path_set(const scenario *s, int parameter, int first,
                            char path[ACTION_PATH])
{
    if (first < 0) {
        return parameter_table[parameter].path;
    }
    return action_path(&s->actions[first], path);
}

// Whether an action replaces the value that action `first` of the script has set (-1:
// that of the parameter at the start), which it does if it sets the same path.
static bool sets_again(const scenario *s, const action *a, int parameter, int first)
{
    char path[ACTION_PATH], again[ACTION_PATH];
    return sets(s, a, parameter) &&
           strcmp(action_path(a, again), path_set(s, parameter, first, path)) == 0;
}

// Whether more actions follow at the instant of action i (-1: at the start), so that only
// the values after the last of them count.
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
    if (s->action_count == 0) {
        return inert_with(s, &s->parameters, parameter);
    }

    const char *why = "the run has ended";
    if (first < 0) {
        why = "the script gives it another value at once";
    }

    // follow the script from the start until the value is replaced or the run ends; the
    // value is in force from action `first` on
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

// Places count the parameters and after them the actions of the script. Whether a place
// gives a parameter a value.
static bool gives_value(const scenario *s, int place)
{
    if (place < parameter_count) {
        return s->parameters.set[place] != 0;
    }
    return s->actions[place - parameter_count].kind == ACTION_SET;
}

// Whether the value that is given at a place has no effect. Fills in why, its path and
// its line in the file.
static bool is_idle(const scenario *s, int place, idle_value *idle)
{
    if (place < parameter_count) {
        idle->why = effect_none_from(s, place, -1);
        idle->line = s->written != NULL ? s->written->lines[place] : 0;
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
        const int present_place = (*place)++;
        if (gives_value(s, present_place) && is_idle(s, present_place, idle)) {
            return true;
        }
    }
    return false;
}

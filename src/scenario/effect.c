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

// Which of its engines the event method integrates with, as far as it may choose.
static feature_set engine_features(const parameters *p, feature_set features)
{
    const bool able = features_suit_pair(features);
    if ((features & HAS(EVENT)) == 0) {
        return 0;
    }
    if (!able || p->method.engine == ENGINE_STIFF) {
        return HAS(STIFF) | (able ? HAS(PAIR) : 0);
    }
    arm a;
    arm_init(&a, p);
    return HAS(PAIR) |
           (p->method.engine == ENGINE_AUTO && !motion_suits_pair(&a) ? HAS(STIFF) : 0);
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
    return (law_reads(p->control.law, name) ? HAS(READ) : 0) |
           (replaced ? 0 : HAS(ALONE));
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
    const feature_set forecast = TOLD_ARM | HAS(TOLD_HUB_SPRING) | HAS(TOLD_DAMPING);
    return law->told |
           (steps || p->control.force_amplitude > 0 ? law->told_where_force_moves : 0) |
           (p->control.law != LAW_NONE && p->control.force_limit > 0 ? forecast : 0) |
           (own == NULL || own->lockable ? HAS(LOCKABLE) : 0) |
           (law_reads(p->control.law, "force") ? HAS(FORCE_READ) : 0) |
           (steps ? HAS(FORCE_STEPS) : 0);
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

// Whether an action gives another value to what action `first` sets, or to a parameter if
// that is
// -1.
static bool sets_again(const scenario *s, const action *a, int parameter, int first)
{
    char own[ACTION_PATH], other[ACTION_PATH];
    if (!sets(s, a, parameter)) {
        return false;
    }
    return strcmp(action_path(a, own), first >= 0 ? action_path(&s->actions[first], other)
                                                  : parameter_table[parameter].path) == 0;
}

const char *effect_none_from(const scenario *s, int parameter, int first)
{
    assert(parameter >= 0 && parameter < parameter_count && first < s->action_count);
    const char *why =
        first < 0 ? "the script gives it another value at once" : "the run has ended";
    parameters p = s->parameters;
    for (int i = -1; i < s->action_count; i++) {
        const action *a = i >= 0 ? &s->actions[i] : NULL;
        if (a != NULL && (a->time > p.run.duration ||
                          (i > first && sets_again(s, a, parameter, first)))) {
            break;
        }
        if (a != NULL) {
            action_apply(a, &p, NULL);
        }

        // what is set at one instant goes together
        const double now = a != NULL ? a->time : 0;
        const bool last = i + 1 == s->action_count || s->actions[i + 1].time > now;
        if (i >= first && last) {
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

bool effect_next_idle(const scenario *s, int *place, idle_value *idle)
{
    for (; *place < parameter_count + s->action_count; ++*place) {
        const int first = *place < parameter_count ? -1 : *place - parameter_count;
        const action *a = first >= 0 ? &s->actions[first] : NULL;
        const int parameter = a != NULL ? a->parameter : *place;
        if (a != NULL ? a->kind != ACTION_SET : !s->parameters.set[parameter]) {
            continue;
        }
        idle->why = effect_none_from(s, parameter, first);
        if (idle->why != NULL) {
            if (a != NULL) {
                idle->line = a->line;
            } else {
                idle->line = s->lines[parameter];
            }
            snprintf(idle->path, sizeof idle->path, "%s",
                     parameter_table[parameter].path);
            if (a != NULL) {
                action_path(a, idle->path);
            }
            ++*place;
            return true;
        }
    }
    return false;
}

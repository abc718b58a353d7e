// The actions of a script: their order, and what they set.
#include <assert.h>
#include <math.h>

#include "src/scenario/scenario.h"
#include "src/rig/rig.h"

void scenario_insert_action(scenario *s, action a)
{
    assert(s != NULL && s->actions != NULL);
    int i = s->action_count++;
    for (; i > 0 && s->actions[i - 1].time > a.time; i--) {
        s->actions[i] = s->actions[i - 1];
    }
    s->actions[i] = a;
}

status action_apply(const action *a, parameters *p, fault *f)
{
    assert(a != NULL && p != NULL);

    // other actions change no parameter
    if (a->kind != ACTION_SET) {
        return STATUS_OK;
    }
    if (parameter_is_text(&parameter_table[a->parameter])) {
        return parameter_set_text(p, a->parameter, a->text, f);
    }

    // a number may change others with it
    status code = parameter_set_number(p, a->parameter, a->value, f);
    if (code == STATUS_OK) {
        parameters_follow(p, a->parameter);
    }
    return code;
}

void action_format_value(const action *a, char *text, size_t size)
{
    assert(a != NULL && a->kind == ACTION_SET && text != NULL && size > 0);

    // by way of a parameter, so that it reads as in a scenario file
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    action_apply(a, &p, NULL);
    parameter_format(&p, a->parameter, text, size);
}

bool expectation_is_met(const expectation *e, double value)
{
    assert(e != NULL);
    return e->is_null ? isnan(value) : fabs(value - e->value) <= e->tolerance;
}

parameters scenario_parameters_at(const scenario *s, double time)
{
    assert(s != NULL && !isnan(time));
    parameters p = s->parameters;
    for (int i = 0; i < s->action_count && s->actions[i].time <= time; i++) {
        action_apply(&s->actions[i], &p, NULL);
    }
    return p;
}

status scenario_check_locks(const scenario *s, const controller *law, fault *f)
{
    assert(s != NULL);
    const int lock = PARAMETER_INDEX(control.lock);
    int mode;
    if (law == NULL) {
        return STATUS_OK;
    }

    // the lock from the start, then those of the script
    status code = rig_find_mode(law, s->parameters.control.lock, &mode, f);
    for (int i = 0; i < s->action_count && code == STATUS_OK; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_SET && a->parameter == lock) {
            code = rig_find_mode(law, a->text, &mode, f);
        }
    }
    return code;
}

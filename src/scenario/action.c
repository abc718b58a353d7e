// The actions of a script: their order, and what they set; what is another than in the
// file.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/scenario/scenario.h"
#include "src/base/numbers.h"
#include "src/rig/rig.h"
#include "src/tables/settings.h"

void scenario_insert_action(scenario *s, action a)
{
    int i = s->action_count++;
    for (; i > 0 && s->actions[i - 1].time > a.time; i--) {
        s->actions[i] = s->actions[i - 1];
    }
    s->actions[i] = a;
}

// Whether it gives one number of control.settings a value.
static bool is_setting(const action *a)
{
    return a->parameter == PARAMETER_INDEX(control.settings) && a->text[0] == '.';
}

action action_of(double time, const parameters *p, int parameter, const char *text)
{
    action a = {.time = time, .kind = ACTION_SET, .parameter = parameter};
    a.value = parameter_get(p, parameter);
    if (parameter_is_text(&parameter_table[parameter])) {
        parameter_format(p, parameter, a.text, sizeof a.text);
    }

    // one of the settings stays one, whatever the others will be
    if (parameter == PARAMETER_INDEX(control.settings) && text[0] == '.') {
        char name[PARAMETER_TEXT_SIZE], number[NUMBER_TEXT];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(text + 1, "="), text + 1);
        settings_get(p, name, &a.value);
        number_format_short(number, a.value);
        snprintf(a.text, sizeof a.text, ".%.*s=%s", PARAMETER_TEXT_SIZE - NUMBER_TEXT - 3,
                 name, number);
    }
    return a;
}

const char *action_path(const action *a, char path[ACTION_PATH])
{
    assert(a->kind == ACTION_SET);
    snprintf(path, ACTION_PATH, "%s%.*s", parameter_table[a->parameter].path,
             is_setting(a) ? (int)strcspn(a->text, "=") : 0, a->text);
    return path;
}

bool action_is_text(const action *a)
{
    assert(a->kind == ACTION_SET);
    return parameter_is_text(&parameter_table[a->parameter]) && !is_setting(a);
}

status action_apply(const action *a, parameters *p, fault *f)
{
    // other actions change no parameter
    if (a->kind != ACTION_SET) {
        return STATUS_OK;
    }
    if (parameter_is_text(&parameter_table[a->parameter])) {
        return parameter_set_text(p, a->parameter, a->text, f);
    }

    // a number may change others with it
    TRY(parameter_set_number(p, a->parameter, a->value, f));
    parameters_follow(p, a->parameter);
    return STATUS_OK;
}

void action_format_value(const action *a, char *text, size_t size)
{
    assert(a->kind == ACTION_SET && size > 0);

    if (is_setting(a)) {
        snprintf(text, size, "%s", strchr(a->text, '=') + 1);
        return;
    }

    // by way of a parameter, so that it reads as in a scenario file
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    action_apply(a, &p, NULL);
    parameter_format(&p, a->parameter, text, size);
}

bool expectation_is_met(const expectation *e, double value)
{
    if (e->is_null) {
        return isnan(value);
    }
    return fabs(value - e->value) <= e->tolerance;
}

parameters scenario_parameters_at(const scenario *s, double time)
{
    assert(!isnan(time));
    parameters p = s->parameters;
    for (int i = 0; i < s->action_count && s->actions[i].time <= time; i++) {
        action_apply(&s->actions[i], &p, NULL);
    }
    return p;
}

status scenario_check_timing(const scenario *s, fault *f)
{
    parameters now = s->parameters;
    for (int i = 0; i < s->action_count; i++) {
        const double time = s->actions[i].time;
        TRY(action_apply(&s->actions[i], &now, f));

        // those of one instant go together
        fault wrong;
        const bool last = i + 1 == s->action_count || s->actions[i + 1].time > time;
        if (last && parameters_check_timing(&now, &wrong) != STATUS_OK) {
            return fault_set_at(f, wrong.code, wrong.path, "from %g s on %s", time,
                                wrong.text);
        }
    }
    return STATUS_OK;
}

status scenario_check_locks(const scenario *s, const controller *law, fault *f)
{
    const int lock = PARAMETER_INDEX(control.lock);
    int mode;
    if (law == NULL) {
        return STATUS_OK;
    }

    // the lock from the start, then those of the script
    TRY(rig_find_mode(law, s->parameters.control.lock, &mode, f));
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        if (a->kind == ACTION_SET && a->parameter == lock) {
            TRY(rig_find_mode(law, a->text, &mode, f));
        }
    }
    return STATUS_OK;
}

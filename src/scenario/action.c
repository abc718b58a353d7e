// The actions of a script: their order, what they set, and whether they go with the
// parameters. Also what the parameters are at an instant of the script.
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

// Whether the action sets a single number of control.settings: its text is then ".NAME".
static bool is_setting(const action *a)
{
    return a->parameter == PARAMETER_INDEX(control.settings) && a->text[0] == '.';
}

action action_of(double time, const parameters *p, int parameter, const char *text)
{
    action a = {.time = time,
                .kind = ACTION_SET,
                .parameter = parameter,
                .value = parameter_get(p, parameter)};

    // a single setting is kept by its name, so that the action leaves the others alone
    if (parameter == PARAMETER_INDEX(control.settings) && text[0] == '.') {
        snprintf(a.text, sizeof a.text, "%.*s", (int)strcspn(text, "="), text);
        settings_get(p, a.text + 1, &a.value);
    } else if (parameter_is_text(&parameter_table[parameter])) {
        parameter_format(p, parameter, a.text, sizeof a.text);
    }
    return a;
}

const char *action_path(const action *a, char path[ACTION_PATH])
{
    assert(a->kind == ACTION_SET);
    const char *name = is_setting(a) ? a->text : "";
    snprintf(path, ACTION_PATH, "%s%.*s", parameter_table[a->parameter].path,
             PARAMETER_TEXT_SIZE, name);
    return path;
}

bool action_is_text(const action *a)
{
    assert(a->kind == ACTION_SET);
    return parameter_is_text(&parameter_table[a->parameter]) && !is_setting(a);
}

status action_give(const action *a, parameters *p, fault *f)
{
    if (a->kind != ACTION_SET) {
        return STATUS_OK;
    }
    if (is_setting(a)) {
        return settings_set(p, a->text + 1, a->value, f);
    }
    if (parameter_is_text(&parameter_table[a->parameter])) {
        return parameter_set_text(p, a->parameter, a->text, f);
    }
    return parameter_set_number(p, a->parameter, a->value, f);
}

status action_apply(const action *a, parameters *p, fault *f)
{
    TRY(action_give(a, p, f));
    if (a->kind == ACTION_SET) {
        parameters_follow(p, a->parameter);
    }
    return STATUS_OK;
}

void action_format_value(const action *a, char *text, size_t size)
{
    assert(a->kind == ACTION_SET && size > 0);
    if (is_setting(a)) {
        char number[NUMBER_TEXT];
        number_format_short(number, a->value);
        snprintf(text, size, "%s", number);
        return;
    }

    // as a parameter with that value, so that it reads as in a scenario file
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    action_give(a, &p, NULL);
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
    // the parameters themselves were checked when they were resolved
    if (s->action_count == 0) {
        return STATUS_OK;
    }

    parameters now = s->parameters;
    for (int i = 0; i < s->action_count; i++) {
        const double time = s->actions[i].time;
        TRY(action_apply(&s->actions[i], &now, f));

        // actions at one instant count together, so that the last of them is checked
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

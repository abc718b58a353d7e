// Changes of the rig during a run: its clock, its sensors, and what its controller was told.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/arm/motor.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"
#include "src/base/extremes.h"
#include "src/base/sincos.h"

static const double turn = 2 * 3.14159265358979323846; // [rad]

// Whether any parameter of a group differs; the lock is the rig's own affair.
static bool group_differs(const parameters *a, const parameters *b, const char *group)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        const bool number = !parameter_is_text(info);
        if (number && strncmp(info->path, group, strlen(group)) == 0 &&
            parameter_get(a, i) != parameter_get(b, i)) {
            return true;
        }
    }
    return false;
}

// Whether parameters say something else of what the controller is told than it was told last.
static bool tells_anew(const rig *r, const parameters *p)
{
    const parameters *told = &r->told;
    return group_differs(told, p, "control.") || group_differs(told, p, "belief.") ||
           told->motor.voltage_limit != p->motor.voltage_limit;
}

status rig_takes(const rig *r, const parameters *p, fault *f)
{
    assert(r != NULL && p != NULL);
    return r->law->tune != NULL || !tells_anew(r, p)
               ? STATUS_OK
               : fault_set(f, STATUS_BAD_SCENARIO,
                           "the controller '%s' takes its parameters at the start only: they "
                           "cannot change during the run",
                           r->law->name);
}

// Gives the controller what it is told now. STATUS_BAD_SCENARIO, with a sentence in f, if it
// refuses.
static status tell_controller(rig *r, const parameters *p, fault *f)
{
    // its parameters, and the rig as it is to believe it
    status s = controller_values(r->law, p, r->values, f);
    if (s != STATUS_OK) {
        return s;
    }
    if (r->process != NULL) {
        process_tell(r->memory, &p->control);
    }
    const controller_setup setup = rig_believed_setup(r, p);
    if (p->control.force_limit > 0) {
        touch_forecast_tell(&r->forecast, p, &setup);
    }

    const char *refusal = r->law->tune(r->memory, &setup);
    if (refusal != NULL) {
        return fault_set(f, STATUS_BAD_SCENARIO, "the controller '%s' refuses: %.600s",
                         r->law->name, refusal);
    }
    return STATUS_OK;
}

status rig_retune(rig *r, const parameters *p, double time, fault *f)
{
    assert(r != NULL && p != NULL);
    parameters *told = &r->told;
    const bool changes = tells_anew(r, p);
    const status taken = rig_takes(r, p, f);
    if (taken != STATUS_OK) {
        return taken;
    }
    if (group_differs(told, p, "sensor.")) {
        told->sensor = p->sensor;
        sensors_retune(&r->sensors, &p->sensor);
        r->dac = converter_of(r->sensors.p.dac_bits, r->voltage_limit);
    }
    if (!changes) {
        return STATUS_OK;
    }

    // the arm as it was at the start is what the controller knows, whatever has changed since
    told->control = p->control;
    told->belief = p->belief;
    told->motor.voltage_limit = p->motor.voltage_limit;
    memcpy(told->set, p->set, sizeof told->set);
    r->voltage_limit = motor_command_limit(&p->motor);
    r->dac = converter_of(r->sensors.p.dac_bits, r->voltage_limit);
    r->jitter = p->control.jitter;

    // the next sample comes one new period after the last
    const double period = 1 / p->control.rate;
    if (r->samples > 0 && period != r->period) {
        r->clock_start += (double)(r->samples - 1 - r->clock_samples) * r->period;
        r->clock_samples = r->samples - 1;
        r->sample_time = r->clock_start + period;

        // the clock goes on from now where that sample would have been due earlier
        if (r->sample_time < time) {
            r->sample_time = time;
            r->clock_start = time;
            r->clock_samples = r->samples;
        }
    }
    r->period = period;
    r->delay = p->control.delay + p->control.delay_periods * r->period;
    return tell_controller(r, told, f);
}

status rig_follow_setpoint(rig *r, double time, fault *f)
{
    const control_parameters *c = &r->told.control;

    // the ramp towards the setpoint, and the wave upon it
    const double way = c->force - r->ramp, most = c->force_rate * (time - r->ramp_time);
    r->ramp = c->force_rate > 0 && fabs(way) > most ? r->ramp + copysign(most, way) : c->force;
    r->ramp_time = time;
    const double wave = c->force_amplitude > 0
                            ? c->force_amplitude * inline_sin(turn * c->force_frequency * time)
                            : 0;
    const double wanted = larger(r->ramp + wave, 0);

    // the controller hears of a change only
    if (wanted == r->wanted_force) {
        return STATUS_OK;
    }
    parameters now = r->told;
    now.control.force = r->wanted_force = wanted;
    now.set[PARAMETER_INDEX(control.force)] = 1;
    return tell_controller(r, &now, f);
}

bool rig_can_change(const parameters *p, int parameter)
{
    assert(p != NULL && parameter >= 0 && parameter < parameter_count);
    const char *path = parameter_table[parameter].path;
    const controller *law = controller_of(p->control.law);
    const bool told = strncmp(path, "control.", 8) == 0 || strncmp(path, "belief.", 7) == 0 ||
                      parameter == PARAMETER_INDEX(motor.voltage_limit);
    if (!parameter_table[parameter].timed) {
        return false;
    }
    return p->control.law == LAW_NONE || p->control.law == LAW_PROCESS || !told ||
           parameter == PARAMETER_INDEX(control.lock) || (law != NULL && law->tune != NULL);
}

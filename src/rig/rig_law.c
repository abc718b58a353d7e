// Which controller a rig has, with its modes, and what it is told: the nominal model at
// the start and every change during the run.
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/rig/rig.h"
#include "src/arm/motor.h"
#include "src/rig/controller_values.h"
#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/arm/arm.h"
#include "src/tables/k2_table.h"
#include "src/rig/laws/laws.h"

const controller *controller_of(int law)
{
#define LAW(name, prefix, ...) [LAW_##name] = &prefix##_law,
    static const controller *const built_in[LAW_COUNT] = {[LAW_PLAYBACK] = &playback_law,
                                                          CONTROL_LAWS(LAW)};
#undef LAW
    assert(law >= 0 && law < LAW_COUNT);
    return built_in[law];
}

// --- modes ---

// Writes the names of a law's modes into a text: "approach, impact or force".
static void list_modes(const controller *law, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; law->modes != NULL && law->modes[i] != NULL && used < size; i++) {
        const char *separator = ", ";
        if (i == 0) {
            separator = "";
        } else if (law->modes[i + 1] == NULL) {
            separator = " or ";
        }
        used += (size_t)snprintf(text + used, size - used, "%s%.40s", separator,
                                 law->modes[i]);
    }
}

status rig_find_mode(const controller *law, const char *lock, int *mode, fault *f)
{
    *mode = -1;
    if (lock[0] == '\0' || strcmp(lock, "none") == 0) {
        return STATUS_OK;
    }
    if (!law->lockable || law->modes == NULL) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, "control.lock",
                            "control.lock = '%.60s', but the law '%s' cannot be held in "
                            "a mode, expected none",
                            lock, law->name);
    }

    // the mode of that name
    for (int i = 0; law->modes[i] != NULL; i++) {
        if (strcmp(law->modes[i], lock) == 0) {
            *mode = i;
            return STATUS_OK;
        }
    }

    // no mode has that name: say which modes there are
    char modes[256];
    list_modes(law, modes, sizeof modes);
    return fault_set_at(
        f, STATUS_BAD_SCENARIO, "control.lock",
        "control.lock = '%.60s' is no mode of the law '%s', expected none, %s", lock,
        law->name, modes);
}

status rig_lock(rig *r, const char *lock, fault *f)
{
    int mode;
    status s = rig_find_mode(r->law, lock, &mode, f);
    if (s == STATUS_OK) {
        r->lock = mode;
    }
    return s;
}

int rig_mode_names(const parameters *p, char names[][MODE_NAME_SIZE], int most,
                   bool *lockable)
{
    fault ignored;
    plugin opened = {0};
    const controller *law = controller_of(p->control.law);
    if (p->control.law == LAW_PLUGIN && p->code_allowed &&
        plugin_open(&opened, p->control.plugin, &ignored) == STATUS_OK) {
        law = opened.law;
    }

    // names are copied, since those of a plug-in vanish when it is closed
    int count = 0;
    *lockable = law != NULL && law->lockable;
    const char *const *modes = law != NULL ? law->modes : NULL;
    for (; modes != NULL && modes[count] != NULL && count < most; count++) {
        snprintf(names[count], MODE_NAME_SIZE, "%s", modes[count]);
    }
    plugin_close(&opened);
    return count;
}

// --- the nominal model, and changes ---

controller_setup rig_nominal_setup(const rig *r, const parameters *p)
{
    const nominal_model_parameters *b = &p->belief;

    // the beam in two links, whatever the arm is
    const double m = p->arm.mass / 2, l = p->arm.length / 2;
    const double link_inertia = p->arm.links == 2 ? p->arm.link_inertia : m * l * l / 12;

    // the stiffness of the joint, if it was measured that at the wanted force
    double k2 = p->arm.k2;
    k2_table measured;
    if (k2_table_read(&measured, p->control.k2_table, NULL) == STATUS_OK &&
        measured.count > 0) {
        k2 = k2_table_at(&measured, p->control.force);
    }

    // the motor, with the torque constant and friction that the model believes in
    motor_parameters motor = p->motor;
    motor.torque_constant *= b->torque_factor;
    motor.viscous_friction *= b->friction_factor;
    motor.stiction *= b->friction_factor;

    return (controller_setup){
        .period = r->period,
        .delay = fmax(0, r->delay + b->delay_error),
        .voltage_limit = r->voltage_limit,
        .torque_per_volt = motor_torque_per_volt(&motor),
        .hub_damping = motor_damping(&motor),
        .stiction = motor.stiction,
        .hub_inertia = p->arm.hub_inertia * b->inertia_factor,
        .link_mass = m * b->mass_factor,
        .link_length = l,
        .link_inertia = link_inertia * b->mass_factor,
        .k2 = k2 * b->k2_factor,
        .wall_angle = p->wall.angle + b->wall_error,
        .links = b->links,
        .hub_spring =
            p->arm.hub_joint == HUB_SPRING ? p->arm.k1 * b->hub_spring_factor : HUGE_VAL,
        .damping_ratio = p->arm.damping_ratio,
        .parameters = r->values,
    };
}

void rig_take_delay(rig *r, const parameters *p)
{
    r->delay = p->control.delay + p->control.delay_periods * r->period;
    const double periods = r->delay / r->period;
    r->pending_most = (int)larger(ceil(periods - 1e-9) - 1, 0);
}

// Whether any number of a group of parameters differs. Texts are compared elsewhere.
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

// Whether parameters differ from those that the controller knows.
static bool controller_is_concerned(const rig *r, const parameters *p)
{
    const parameters *known = &r->known;
    return group_differs(known, p, "control.") || group_differs(known, p, "belief.") ||
           known->motor.voltage_limit != p->motor.voltage_limit ||
           strcmp(known->control.settings, p->control.settings) != 0;
}

status rig_takes(const rig *r, const parameters *p, fault *f)
{
    if (r->law->tune == NULL && controller_is_concerned(r, p)) {
        return fault_set(
            f, STATUS_BAD_SCENARIO,
            "the controller '%s' takes its parameters at the start only: they "
            "cannot change during the run",
            r->law->name);
    }
    return STATUS_OK;
}

// Tells the controller parameters that hold from an instant [s] on, by its function tune.
// STATUS_BAD_SCENARIO, with a sentence in f, if it refuses them.
static status tell_controller(rig *r, const parameters *p, double time, fault *f)
{
    // its parameters, and the nominal model
    TRY(controller_values(r->law, p, r->values, f));
    if (r->process != NULL) {
        process_tell(r->process, &p->control);
    }
    const controller_setup setup = rig_nominal_setup(r, p);
    if (p->control.force_limit > 0) {
        touch_forecast_tell(&r->forecast, p, &setup);
    }

    const char *refusal = r->law->tune(r->memory, &setup);
    FAULT_IF(refusal != NULL, f, STATUS_BAD_SCENARIO,
             "at t = %.9g s the controller '%s' refuses: %.600s", time, r->law->name,
             refusal);
    return STATUS_OK;
}

status rig_retune(rig *r, const parameters *p, double time, fault *f)
{
    parameters *known = &r->known;
    const bool changes = controller_is_concerned(r, p);
    TRY(rig_takes(r, p, f));
    if (group_differs(known, p, "sensor.")) {
        known->sensor = p->sensor;
        sensors_retune(&r->sensors, &p->sensor);
        r->dac = converter_of(r->sensors.p.dac_bits, r->voltage_limit);
    }
    if (!changes) {
        return STATUS_OK;
    }

    // The controller is told of control, belief and voltage limit; it goes on knowing the
    // arm as it was at the start, whatever has changed since
    known->control = p->control;
    known->belief = p->belief;
    known->motor.voltage_limit = p->motor.voltage_limit;
    memcpy(known->set, p->set, sizeof known->set);
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
    rig_take_delay(r, p);
    return tell_controller(r, known, time, f);
}

status rig_follow_setpoint(rig *r, double time, fault *f)
{
    const control_parameters *c = &r->known.control;

    // the ramp towards the set-point, by no more than its rate allows
    const double left = c->force - r->ramp, most = c->force_rate * (time - r->ramp_time);
    if (c->force_rate > 0 && fabs(left) > most) {
        r->ramp = r->ramp + copysign(most, left);
    } else {
        r->ramp = c->force;
    }
    r->ramp_time = time;

    // a sine is added to it, and no force is below 0
    double wave = 0;
    if (c->force_amplitude > 0) {
        wave = c->force_amplitude * inline_sin(2 * M_PI * c->force_frequency * time);
    }
    const double wanted = larger(r->ramp + wave, 0);

    // the controller is told only when the force has changed
    if (wanted == r->wanted_force) {
        return STATUS_OK;
    }
    parameters now = r->known;
    now.control.force = r->wanted_force = wanted;
    now.set[PARAMETER_INDEX(control.force)] = 1;
    return tell_controller(r, &now, time, f);
}

bool rig_can_change(const parameters *p, int parameter)
{
    assert(parameter >= 0 && parameter < parameter_count);
    const char *path = parameter_table[parameter].path;
    const controller *law = controller_of(p->control.law);
    if (!parameter_table[parameter].timed) {
        return false;
    }

    // a parameter that no controller knows may change; so may the lock, which the rig
    // handles itself
    const bool known = strncmp(path, "control.", 8) == 0 ||
                       strncmp(path, "belief.", 7) == 0 ||
                       parameter == PARAMETER_INDEX(motor.voltage_limit);
    if (!known || parameter == PARAMETER_INDEX(control.lock)) {
        return true;
    }

    // the others may change where there is no law, or one that can be tuned
    if (p->control.law == LAW_NONE || p->control.law == LAW_PROCESS) {
        return true;
    }
    return law != NULL && law->tune != NULL;
}

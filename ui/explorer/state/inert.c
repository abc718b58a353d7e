#include "ui/explorer/state/inert.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "src/rig/controller.h"
#include "src/rig/rig.h"

// Whether a parameter is a field of struct parameters, or one of a group that is.
#define IS_OF(parameter, field)                                                                    \
    lies_in(parameter, offsetof(parameters, field), sizeof(((parameters *)0)->field))

static bool lies_in(int parameter, size_t from, size_t size)
{
    const size_t offset = parameter_table[parameter].offset;
    return offset >= from && offset < from + size;
}

// What the arm, its wall and the method leave aside.
static const char *reason_of_arm(const parameters *p, int parameter)
{
    const bool of_newmark = IS_OF(parameter, method.beta) || IS_OF(parameter, method.gamma);

    // parts of the arm that this one does not have
    if (IS_OF(parameter, printed) && p->arm.model != ARM_PRINTED) {
        return "it belongs to arm.model = printed";
    }
    if (IS_OF(parameter, arm.k1) && p->arm.hub_joint != HUB_SPRING) {
        return "the hub joint is rigid (arm.hub_joint)";
    }
    if (IS_OF(parameter, arm.link_inertia) && p->arm.links != 2) {
        return "it is for two links";
    }
    const bool of_joints =
        IS_OF(parameter, arm.k2) || IS_OF(parameter, arm.EI) || IS_OF(parameter, arm.stiffening);
    const bool of_springs =
        IS_OF(parameter, arm.damping_ratio) || IS_OF(parameter, arm.modal_ratios);
    if (p->arm.links == 1 && ((of_joints && p->arm.hub_joint != HUB_BEAM) ||
                              (of_springs && p->arm.hub_joint == HUB_RIGID))) {
        return "one link has no joint";
    }
    if (IS_OF(parameter, wall) && !IS_OF(parameter, wall.kind) && p->wall.kind == WALL_NONE) {
        return "there is no wall (wall.kind)";
    }
    if (IS_OF(parameter, motor.transconductance) && p->motor.drive != DRIVE_CURRENT) {
        return "it belongs to motor.drive = current";
    }

    // numbers of other methods
    if (of_newmark && p->method.name != METHOD_NEWMARK) {
        return "it belongs to method.name = newmark";
    }
    if (IS_OF(parameter, method.spectral_radius) && p->method.name != METHOD_GENERALIZED_ALPHA) {
        return "it belongs to method.name = generalized-alpha";
    }
    return NULL;
}

// Whether a parameter of the controller means the same under every law.
static bool is_of_every_law(int parameter)
{
    const size_t fields[] = {offsetof(parameters, control.law),
                             offsetof(parameters, control.settings),
                             offsetof(parameters, control.rate),
                             offsetof(parameters, control.delay),
                             offsetof(parameters, control.delay_periods),
                             offsetof(parameters, control.jitter),
                             offsetof(parameters, control.seed),
                             offsetof(parameters, control.force),
                             offsetof(parameters, control.k2_table),
                             offsetof(parameters, control.force_rate),
                             offsetof(parameters, control.force_amplitude),
                             offsetof(parameters, control.force_frequency)};

    // a parameter is known by where it lies
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        if (parameter_table[parameter].offset == fields[i]) {
            return true;
        }
    }
    return false;
}

// What the control law does not read.
static const char *reason_of_control(const parameters *p, int parameter)
{
    const controller *law = controller_of(p->control.law);
    const char *name = strchr(parameter_table[parameter].path, '.') + 1;
    if (IS_OF(parameter, control.plugin)) {
        return p->control.law == LAW_PLUGIN ? NULL : "it belongs to control.law = plugin";
    }
    if (IS_OF(parameter, control.command) || IS_OF(parameter, control.answer_time)) {
        return p->control.law == LAW_PROCESS ? NULL : "it belongs to control.law = process";
    }
    if (law == NULL || is_of_every_law(parameter)) {
        return NULL;
    }
    if (IS_OF(parameter, control.lock)) {
        return law->lockable ? NULL : "this law cannot be held in a mode";
    }

    // what this one says it reads
    for (int i = 0; i < law->parameter_count; i++) {
        if (strcmp(law->parameters[i].name, name) == 0) {
            return NULL;
        }
    }
    return "the control law does not use it";
}

// Whether a parameter is a fault of sensors or converters, which ideal ones do not have.
static bool is_imperfection(int parameter)
{
    return IS_OF(parameter, sensor.encoder_counts) || IS_OF(parameter, sensor.tachometer_ripple) ||
           IS_OF(parameter, sensor.tachometer_ripple_count) ||
           IS_OF(parameter, sensor.tachometer_noise) || IS_OF(parameter, sensor.fsr_noise) ||
           IS_OF(parameter, sensor.piezo_noise) || IS_OF(parameter, sensor.film_noise) ||
           IS_OF(parameter, sensor.accelerometer_noise) || IS_OF(parameter, sensor.adc_bits) ||
           IS_OF(parameter, sensor.dac_bits) || IS_OF(parameter, sensor.fsr_rise_time) ||
           IS_OF(parameter, sensor.piezo_rise_time) || IS_OF(parameter, sensor.piezo_leak_time) ||
           IS_OF(parameter, sensor.piezo_range) || IS_OF(parameter, sensor.film_leak_time) ||
           IS_OF(parameter, sensor.accelerometer_rise_time) ||
           IS_OF(parameter, sensor.accelerometer_range);
}

// What sensors that are not fitted, or are ideal, make no use of.
static const char *reason_of_sensor(const parameters *p, int parameter)
{
    const bool piezo = IS_OF(parameter, sensor.piezo_gain) ||
                       IS_OF(parameter, sensor.piezo_rise_time) ||
                       IS_OF(parameter, sensor.piezo_leak_time) ||
                       IS_OF(parameter, sensor.piezo_range) || IS_OF(parameter, sensor.piezo_noise);
    const bool film = IS_OF(parameter, sensor.film_gain) ||
                      IS_OF(parameter, sensor.film_leak_time) ||
                      IS_OF(parameter, sensor.film_noise);
    const bool accelerometer = IS_OF(parameter, sensor.accelerometer_gain) ||
                               IS_OF(parameter, sensor.accelerometer_rise_time) ||
                               IS_OF(parameter, sensor.accelerometer_range) ||
                               IS_OF(parameter, sensor.accelerometer_noise);

    // not fitted, or without the fault
    if (piezo && !p->sensor.piezo) {
        return "no piezo sensor is fitted (sensor.piezo)";
    }
    if (film && !p->sensor.film) {
        return "no piezo film is fitted (sensor.film)";
    }
    if (accelerometer && !p->sensor.accelerometer) {
        return "none is fitted (sensor.accelerometer)";
    }
    if (p->sensor.ideal && is_imperfection(parameter)) {
        return "the sensors are ideal (sensor.ideal)";
    }
    return NULL;
}

const char *inert_reason(const parameters *p, int parameter)
{
    assert(p != NULL && parameter >= 0 && parameter < parameter_count);
    const bool law = p->control.law != LAW_NONE;
    const bool control = IS_OF(parameter, control), sensor = IS_OF(parameter, sensor);
    const bool of_rig = sensor || control || IS_OF(parameter, belief);

    // without a law nothing of the rig matters, with one it has the voltage
    if (of_rig && !law) {
        return IS_OF(parameter, control.law) ? NULL : "no control law is on (control.law)";
    }
    if (law && parameter == PARAMETER_INDEX(motor.voltage)) {
        return "the control law commands the voltage";
    }
    return control  ? reason_of_control(p, parameter)
           : sensor ? reason_of_sensor(p, parameter)
                    : reason_of_arm(p, parameter);
}

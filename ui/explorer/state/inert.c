#include "ui/explorer/state/inert.h"

#include <assert.h>
#include <string.h>

#include "src/rig/controller.h"
#include "src/rig/rig.h"

static bool begins_with(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

static bool is_one_of(const char *name, const char *const *names)
{
    for (; *names != NULL; names++) {
        if (strcmp(name, *names) == 0) {
            return true;
        }
    }
    return false;
}

// What the arm, its wall and the method leave aside.
static const char *reason_of_arm(const parameters *p, const char *path)
{
    if (begins_with(path, "printed.") && p->arm.model != ARM_PRINTED) {
        return "it belongs to arm.model = printed";
    }
    if (strcmp(path, "arm.k1") == 0 && p->arm.hub_joint != HUB_SPRING) {
        return "the hub joint is rigid (arm.hub_joint)";
    }
    if (strcmp(path, "arm.link_inertia") == 0 && p->arm.links != 2) {
        return "it is for two links";
    }
    if (strcmp(path, "arm.k2") == 0 && p->arm.links == 1) {
        return "one link has no joint";
    }
    if (begins_with(path, "wall.") && strcmp(path, "wall.kind") != 0 && p->wall.kind == WALL_NONE) {
        return "there is no wall (wall.kind)";
    }
    if ((strcmp(path, "method.beta") == 0 || strcmp(path, "method.gamma") == 0) &&
        p->method.name != METHOD_NEWMARK) {
        return "it belongs to method.name = newmark";
    }
    if (strcmp(path, "method.spectral_radius") == 0 && p->method.name != METHOD_GENERALIZED_ALPHA) {
        return "it belongs to method.name = generalized-alpha";
    }
    return NULL;
}

// What the law that is on does not ask for.
static const char *reason_of_control(const parameters *p, const char *name)
{
    static const char *const of_every_law[] = {
        "law",   "settings", "rate",       "delay",           "delay_periods",   "jitter", "seed",
        "force", "k2_table", "force_rate", "force_amplitude", "force_frequency", NULL};
    const controller *law = controller_of(p->control.law);
    if (strcmp(name, "plugin") == 0) {
        return law == NULL ? NULL : "it belongs to control.law = plugin";
    }
    if (law == NULL || is_one_of(name, of_every_law)) {
        return NULL;
    }
    if (strcmp(name, "lock") == 0) {
        return law->lockable ? NULL : "this law cannot be held in a mode";
    }
    for (int i = 0; i < law->parameter_count; i++) {
        if (strcmp(law->parameters[i].name, name) == 0) {
            return NULL;
        }
    }
    return "the control law does not use it";
}

static const char *reason_of_sensor(const parameters *p, const char *name)
{
    static const char *const imperfections[] = {"encoder_counts",
                                                "tachometer_ripple",
                                                "tachometer_ripple_count",
                                                "tachometer_noise",
                                                "fsr_noise",
                                                "piezo_noise",
                                                "film_noise",
                                                "accelerometer_noise",
                                                "adc_bits",
                                                "dac_bits",
                                                "fsr_rise_time",
                                                "piezo_rise_time",
                                                "piezo_leak_time",
                                                "piezo_range",
                                                "film_leak_time",
                                                "accelerometer_rise_time",
                                                "accelerometer_range",
                                                NULL};
    if (begins_with(name, "piezo_") && !p->sensor.piezo) {
        return "no piezo sensor is fitted (sensor.piezo)";
    }
    if (begins_with(name, "film_") && !p->sensor.film) {
        return "no piezo film is fitted (sensor.film)";
    }
    if (begins_with(name, "accelerometer_") && !p->sensor.accelerometer) {
        return "none is fitted (sensor.accelerometer)";
    }
    if (p->sensor.ideal && is_one_of(name, imperfections)) {
        return "the sensors are ideal (sensor.ideal)";
    }
    return NULL;
}

const char *inert_reason(const parameters *p, int parameter)
{
    assert(p != NULL && parameter >= 0 && parameter < parameter_count);
    const char *path = parameter_table[parameter].path, *name = strchr(path, '.') + 1;
    const bool law = p->control.law != LAW_NONE, control = begins_with(path, "control.");
    const bool sensor = begins_with(path, "sensor.");
    const bool belief = begins_with(path, "belief.");
    if ((sensor || belief || (control && strcmp(name, "law") != 0)) && !law) {
        return "no control law is on (control.law)";
    }
    if (law && parameter == PARAMETER_INDEX(motor.voltage)) {
        return "the control law commands the voltage";
    }
    return control  ? (law ? reason_of_control(p, name) : NULL)
           : sensor ? reason_of_sensor(p, name)
                    : reason_of_arm(p, path);
}

// Draws a rig: arm, motor, wall, law, sensors and what changes during the run.
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

__attribute__((format(printf, 2, 3))) void set(rig *r, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(r->settings[r->count], LONGEST_SETTING, format, values);
    va_end(values);
    r->count++;
}

double between(rig *r, double from, double to)
{
    return from * exp(random_uniform(&r->chance) * log(to / from));
}

static double evenly(rig *r, double from, double to)
{
    return from + (to - from) * random_uniform(&r->chance);
}

bool happens(rig *r, double share)
{
    return random_uniform(&r->chance) < share;
}

static const char *one_of(rig *r, const char *const *words, uint64_t count)
{
    return words[random_below(&r->chance, count)];
}

#define ONE_OF(r, words) one_of(r, words, sizeof(words) / sizeof(words)[0])

// Sets a number in a share of the rigs.
static void may_set(rig *r, double share, const char *path, double from, double to)
{
    const double value = between(r, from, to);
    if (happens(r, share)) {
        set(r, "%s=%.6g", path, value);
    }
}

static void may_set_evenly(rig *r, double share, const char *path, double from, double to)
{
    const double value = evenly(r, from, to);
    if (happens(r, share)) {
        set(r, "%s=%.6g", path, value);
    }
}

static void draw_arm(rig *r)
{
    static const char *const hubs[] = {"rigid", "rigid", "spring", "beam"};
    const char *hub = ONE_OF(r, hubs);
    set(r, "arm.links=%d", 1 + (int)random_below(&r->chance, 4));
    set(r, "arm.hub_joint=%s", hub);
    if (strcmp(hub, "spring") == 0) {
        set(r, "arm.k1=%.6g", between(r, 20, 2e4));
    }
    may_set(r, 0.5, "arm.k2", 1, 50);
    may_set(r, 0.5, "arm.damping_ratio", 1e-3, 0.05);
    may_set(r, 0.3, "arm.mass", 0.1, 1);
    may_set(r, 0.3, "arm.length", 0.4, 1.5);
    may_set(r, 0.2, "arm.tip_mass", 0.005, 0.1);
    may_set(r, 0.2, "arm.air_drag", 0.01, 1);
    may_set_evenly(r, 0.15, "arm.tilt", -0.2, 0.2);
    may_set(r, 0.15, "arm.stiffening", 0.1, 30);
    if (happens(r, 0.15)) {
        set(r, "method.engine=stiff");
    }
}

static void draw_motor(rig *r)
{
    if (happens(r, 0.15)) {
        set(r, "motor.drive=current");
    } else {
        may_set(r, 0.4, "motor.inductance", 1e-3, 0.1);
    }
    may_set(r, 0.35, "motor.current_limit", 0.05, 1);
    may_set(r, 0.5, "motor.stiction", 1e-3, 0.3);
    may_set(r, 0.2, "motor.viscous_friction", 1e-3, 0.1);
    may_set(r, 0.3, "motor.voltage_limit", 0.5, 20);
    set(r, "motor.voltage=%.6g", between(r, 0.3, 5));
}

static void draw_wall(rig *r)
{
    static const char *const kinds[] = {"point", "plane"};
    static const char *const contacts[] = {"rigid", "rigid", "kelvin-voigt",
                                           "hunt-crossley"};
    const char *contact = ONE_OF(r, contacts);
    const double angle = evenly(r, -0.5, 0.5), way = between(r, 0.005, 0.1);
    set(r, "wall.kind=%s", ONE_OF(r, kinds));
    set(r, "wall.contact=%s", contact);
    set(r, "wall.angle=%.6g", angle);
    set(r, "initial.angle=%.6g", angle - way);
    may_set(r, 0.4, "initial.velocity", 0.05, 2);
    if (strcmp(contact, "rigid") == 0) {
        may_set_evenly(r, 0.4, "wall.restitution", 0, 0.9);
    } else if (strcmp(contact, "kelvin-voigt") == 0) {
        may_set(r, 0.7, "wall.stiffness", 1e3, 3e5);
        may_set(r, 0.7, "wall.damping", 1, 50);
        may_set(r, 0.3, "wall.mass", 0.01, 1);
    } else {
        may_set(r, 0.7, "wall.stiffness", 1e4, 3e6);
    }
    if (happens(r, 0.1)) {
        set(r, "wall.motion=%s", happens(r, 0.5) ? "sine" : "step");
        set(r, "wall.motion_amplitude=%.6g", between(r, 1e-5, 5e-4));
        set(r, "wall.motion_frequency=%.6g", between(r, 1, 20));
    }
}

static void draw_law(rig *r)
{
    static const char *const laws[] = {"none",        "open-loop",      "hybrid",
                                       "force-pd",    "force-integral", "reverse-torque",
                                       "speed-limit", "bang-bang",      "impedance",
                                       "admittance",  "recovering",     "discontinuous",
                                       "open-loop",   "observer"};
    static const char *const rates[] = {"100",  "200",  "200", "500",
                                        "1000", "2000", "3000"};
    const char *law = ONE_OF(r, laws), *rate = ONE_OF(r, rates);
    const double period = 1 / atof(rate);
    set(r, "control.law=%s", law);
    set(r, "control.rate=%s", rate);
    set(r, "control.force=%.6g", between(r, 0.2, 4));
    set(r, "control.approach_voltage=%.6g", between(r, 0.3, 5));
    set(r, "control.seed=%d", (int)random_below(&r->chance, 1000));
    may_set(r, 0.3, "control.delay", 1e-4, 2 * period);
    if (happens(r, 0.3)) {
        set(r, "control.delay_periods=%.2g", evenly(r, 0, 2));
    }
    may_set(r, 0.1, "control.force_rate", 0.1, 100);
    if (happens(r, 0.1)) {
        set(r, "control.force_amplitude=%.6g", between(r, 0.01, 0.3));
        set(r, "control.force_frequency=%.6g", between(r, 0.1, 50));
    }
    may_set(r, 0.3, "control.jitter", 1e-2 * period, 0.9 * period);
}

static void draw_sensors(rig *r)
{
    static const char *const bits[] = {"0", "0", "6", "8", "12", "16"};
    static const char *const counts[] = {"0", "500", "8000", "100000"};
    static const char *const fits[] = {"sensor.piezo", "sensor.film",
                                       "sensor.accelerometer"};
    static const char *const noises[] = {"sensor.fsr_noise", "sensor.tachometer_noise",
                                         "sensor.piezo_noise", "sensor.film_noise",
                                         "sensor.accelerometer_noise"};
    for (int k = 0; k < 5; k++) {
        set(r, "%s=0", noises[k]);
    }
    if (happens(r, 0.15)) {
        set(r, "sensor.ideal=true");
    }
    for (int k = 0; k < 3; k++) {
        if (happens(r, 0.5)) {
            set(r, "%s=true", fits[k]);
        }
    }
    if (happens(r, 0.2)) {
        set(r, "sensor.force=piezo");
    }
    set(r, "sensor.adc_bits=%s", ONE_OF(r, bits));
    set(r, "sensor.dac_bits=%s", ONE_OF(r, bits));
    set(r, "sensor.encoder_counts=%s", ONE_OF(r, counts));
    may_set(r, 0.3, "sensor.adc_range", 1, 20);
    may_set_evenly(r, 0.3, "sensor.encoder_gain_error", -0.2, 0.2);
    may_set_evenly(r, 0.3, "sensor.encoder_offset", -0.1, 0.1);
    may_set(r, 0.3, "sensor.tachometer_gain", 0.5, 5);
    may_set(r, 0.3, "sensor.tachometer_ripple", 1e-3, 0.2);
    may_set_evenly(r, 0.3, "sensor.tachometer_gain_error", -0.2, 0.2);
    may_set_evenly(r, 0.3, "sensor.tachometer_offset", -0.1, 0.1);
    if (happens(r, 0.15)) {
        set(r, "sensor.fsr_rise_time=0");
    } else {
        may_set(r, 0.5, "sensor.fsr_rise_time", 1e-4, 1e-2);
    }
    may_set(r, 0.3, "sensor.fsr_resistance", 3e3, 3e5);
    may_set(r, 0.3, "sensor.fsr_exponent", 0.5, 1.5);
    may_set(r, 0.3, "sensor.fsr_gain", 0.5, 4);
    may_set(r, 0.3, "sensor.fsr_saturation", 1, 100);
    may_set_evenly(r, 0.3, "sensor.fsr_gain_error", -0.3, 0.3);
    may_set_evenly(r, 0.3, "sensor.fsr_offset", -0.2, 0.2);
    may_set_evenly(r, 0.4, "sensor.fsr_hysteresis", 0, 0.5);
    may_set(r, 0.3, "sensor.piezo_rise_time", 2e-5, 1e-3);
    may_set(r, 0.3, "sensor.piezo_leak_time", 0.02, 5);
    may_set(r, 0.3, "sensor.piezo_range", 1, 1000);
    may_set_evenly(r, 0.3, "sensor.piezo_gain_error", -0.3, 0.3);
    may_set_evenly(r, 0.3, "sensor.piezo_offset", -0.2, 0.2);
    may_set(r, 0.5, "sensor.film_leak_time", 0.02, 5);
    may_set(r, 0.5, "sensor.accelerometer_rise_time", 1e-4, 2e-3);
    may_set(r, 0.3, "sensor.accelerometer_range", 10, 1e5);
}

void fail(const char *what, const impactlab_error *error)
{
    fprintf(stderr, "%s: %s\n", what, error->sentence);
    exit(2);
}

double number(const rig *r, const char *path)
{
    double value;
    impactlab_error error;
    if (impactlab_scenario_number(r->scenario, path, &value, &error) != IMPACTLAB_OK) {
        fail(path, &error);
    }
    return value;
}

bool is(const rig *r, const char *path, const char *word)
{
    char text[64];
    impactlab_error error;
    if (impactlab_scenario_text(r->scenario, path, text, sizeof text, &error) !=
        IMPACTLAB_OK) {
        fail(path, &error);
    }
    return strcmp(text, word) == 0;
}

// What changes during the run: errors of sensors, and pushes.
static void draw_changes(rig *r)
{
    static const char *const paths[] = {"sensor.encoder_gain_error",
                                        "sensor.encoder_offset",
                                        "sensor.tachometer_gain_error",
                                        "sensor.tachometer_offset",
                                        "sensor.fsr_gain_error",
                                        "sensor.fsr_offset",
                                        "sensor.piezo_gain_error",
                                        "sensor.piezo_offset",
                                        "",
                                        "sensor.tachometer_ripple",
                                        "control.force",
                                        "sensor.fsr_rise_time"};
    impactlab_error error;
    const double duration = number(r, "run.duration");
    double at = 0;
    while (r->change_count < MOST_CHANGES && happens(r, 0.4)) {
        struct change *c = &r->changes[r->change_count++];
        at += evenly(r, 0, duration / MOST_CHANGES);
        c->at = at;
        snprintf(c->path, sizeof c->path, "%s", ONE_OF(r, paths));
        c->value = evenly(r, 0, 0.2);
        if (*c->path == '\0') {
            c->value = evenly(r, -0.01, 0.01);
        } else if (strcmp(c->path, "sensor.fsr_rise_time") == 0) {
            c->value = between(r, 1e-4, 1e-2);
        }
        char text[32];
        snprintf(text, sizeof text, "%.17g", c->value);
        const int status =
            *c->path != '\0'
                ? impactlab_scenario_add_change(r->scenario, at, c->path, text, &error)
                : impactlab_scenario_add_push(r->scenario, at, c->value, &error);
        if (status != IMPACTLAB_OK) {
            fail("change", &error);
        }
    }
}

double number_at(const rig *r, const char *path, double t)
{
    double value = number(r, path);
    for (int k = 0; k < r->change_count; k++) {
        if (r->changes[k].at <= t + INSTANT && strcmp(r->changes[k].path, path) == 0) {
            value = r->changes[k].value;
        }
    }
    return value;
}

bool draw(rig *r, uint64_t which)
{
    const char *all[MOST_SETTINGS];
    impactlab_error error;

    // the settings
    *r = (rig){.number = which};
    random_seed(&r->chance, which);
    set(r, "method.step=%g", spacing);

    // two digits more than by default: the ledger is summed up at the ends of steps, and
    // rows between them must be as exact
    set(r, "method.tolerance=1e-10");
    draw_arm(r);
    draw_motor(r);
    draw_wall(r);
    draw_law(r);
    draw_sensors(r);
    set(r, "run.duration=%.6g", between(r, 0.15, 0.6));

    // the scenario
    for (int k = 0; k < given_count; k++) {
        set(r, "%s", given[k]);
    }
    for (int k = 0; k < r->count; k++) {
        all[k] = r->settings[k];
    }
    if (impactlab_scenario_create(&r->scenario, &error) != IMPACTLAB_OK) {
        fail("create", &error);
    }
    const int status =
        impactlab_scenario_set_all(r->scenario, all, (size_t)r->count, &error);
    if (status != IMPACTLAB_OK) {
        printf("%" PRIu64 ": refused: %s\n", which, error.sentence);
    }
    if (status == IMPACTLAB_OK) {
        draw_changes(r);
    }
    return status == IMPACTLAB_OK;
}

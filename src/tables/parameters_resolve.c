// Resolves parameters: fills in those that follow from others, and refuses those that
// contradict one another.
#include <math.h>

#include "src/tables/features.h"
#include "src/tables/k2_table.h"
#include "src/tables/parameters_parts.h"

// The share of the energy put in that the ledger may be off by under the methods with
// fixed steps, whose errors are an object of study.
#define STUDY_RESIDUAL_BOUND 1e-2

// The smallest mass of a wall's face, if it has one [kg].
#define LEAST_FACE 1e-9

// Walls nobody has measured: docs/explanation/model.md says where these come from.
#define SOFT_STIFFNESS   75e3 // Kelvin-Voigt [N/m]
#define SOFT_DAMPING     20.0 // [N s/m]
#define HERTZ_STIFFNESS  1e6  // Hunt-Crossley [N/m^1.5]
#define RESTITUTION_LOSS 0.2  // restitution lost by speed, Hunt-Crossley's alpha [s/m]

// Fills in the wall's stiffness and damping for its law of contact, and checks its face
// and its motion. The damping of Hunt-Crossley's law is 1.5 alpha times the stiffness.
static status resolve_wall(parameters *p, fault *f)
{
    wall_parameters *w = &p->wall;
    const bool hertz = w->contact == WALL_HUNT_CROSSLEY, gives = w->contact != WALL_RIGID;
    const bool moves = w->motion != MOTION_NONE && w->kind != WALL_NONE;

    // defaults that depend on the law of contact
    if (isnan(w->stiffness)) {
        if (hertz) {
            w->stiffness = HERTZ_STIFFNESS;
        } else {
            w->stiffness = SOFT_STIFFNESS;
        }
    }
    if (isnan(w->damping)) {
        if (hertz) {
            w->damping = 1.5 * RESTITUTION_LOSS * w->stiffness;
        } else {
            w->damping = SOFT_DAMPING;
        }
    }

    // the face
    if (w->mass > 0 && w->mass < LEAST_FACE) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.mass),
                            "wall.mass = %g kg, expected 0 (none) or at least %g kg",
                            w->mass, LEAST_FACE);
    }

    // what a moving wall needs, and what it cannot be combined with
    if (moves && w->motion == MOTION_FILE && w->motion_file[0] == '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, wall.motion, wall.motion_file),
                            "wall.motion = file needs a CSV file in wall.motion_file");
    }
    if (moves && w->mass > 0 && w->kind != WALL_PLANE) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, wall.kind),
            "wall.motion shakes along the wall's normal, but the face of a point "
            "(wall.mass) gives across the last link, which turns: expected "
            "wall.kind = plane");
    }
    if (moves && p->arm.links == 1 && p->arm.hub_joint == HUB_RIGID && !gives &&
        p->motor.stiction > 0) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, motor.stiction),
            "a rigid wall that moves would drive a single link against the hub's "
            "stiction, whose force is not determined: expected motor.stiction = "
            "0, more links or a wall that gives");
    }
    return STATUS_OK;
}

// Checks that the engine `pair`, if it is asked for by name, can integrate this arm.
static status check_engine(const parameters *p, fault *f)
{
    if (p->method.engine == ENGINE_PAIR && !features_suit_pair(features_of(p))) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME1(p, method.engine),
            "method.engine = pair takes two equal bare links in a level plane on "
            "a rigid wall at rest, with a motor whose current follows at once; "
            "expected auto or stiff");
    }
    return STATUS_OK;
}

status parameters_check_timing(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    const double period = 1 / c->rate;
    if (c->delay * c->rate + c->delay_periods > CONTROL_MOST_DELAY) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO,
            BLAME3(p, control.delay_periods, control.delay, control.rate),
            "control.delay_periods = %g and control.delay = %g s are together "
            "longer than %d periods of %g s (control.rate)",
            c->delay_periods, c->delay, CONTROL_MOST_DELAY, period);
    }
    if (c->jitter * c->rate > 1) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.jitter, control.rate),
            "control.jitter = %g s is more than the period of %g s (control.rate)",
            c->jitter, period);
    }
    return STATUS_OK;
}

// Checks that a law has the file or program it needs, the table of k2, and the timing.
static status check_control(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    k2_table table;
    if (c->law == LAW_PLUGIN && c->plugin[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.plugin),
            "control.law = plugin needs the file of a shared object in control.plugin");
    }
    if (c->law == LAW_PROCESS && c->command[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.command),
            "control.law = process needs the program to start in control.command");
    }
    if (c->law == LAW_PLAYBACK && c->playback_file[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.playback_file),
            "control.law = playback needs a CSV file in control.playback_file");
    }
    TRY(k2_table_read(&table, c->k2_table, f));
    return parameters_check_timing(p, f);
}

// Fits a sensor if the controller is to read it (`wanted`), and refuses if it was left
// out on purpose. `sensor` is the index of the parameter that fits the sensor, `chosen`
// that of the choice which makes the controller read it.
static status fit_sensor(parameters *p, bool wanted, int chosen, int sensor, bool *fitted,
                         fault *f)
{
    if (!wanted || *fitted) {
        return STATUS_OK;
    }
    if (p->set[sensor]) {
        char word[PARAMETER_TEXT_SIZE];
        parameter_format(p, chosen, word, sizeof word);
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            first_given(p, (const int[]){chosen, sensor, -1}),
                            "%s = %s needs the sensor that %s = false leaves out",
                            parameter_table[chosen].path, word,
                            parameter_table[sensor].path);
    }
    *fitted = true;
    return STATUS_OK;
}

// Fits the sensors that the chosen sources of impact angle and force need, and checks the
// piezo sensor's times.
static status resolve_sensors(parameters *p, fault *f)
{
    // the sensors that are read
    const int source = p->control.impact_angle;
    const int angle = PARAMETER_INDEX(control.impact_angle);
    TRY(fit_sensor(p, source == IMPACT_ANGLE_BY_FILM, angle, PARAMETER_INDEX(sensor.film),
                   &p->sensor.film, f));
    TRY(fit_sensor(p, source == IMPACT_ANGLE_BY_ACCELEROMETER, angle,
                   PARAMETER_INDEX(sensor.accelerometer), &p->sensor.accelerometer, f));
    TRY(fit_sensor(p, p->sensor.force == FORCE_BY_PIEZO, PARAMETER_INDEX(sensor.force),
                   PARAMETER_INDEX(sensor.piezo), &p->sensor.piezo, f));

    // the piezo sensor is a band-pass, with a lower edge at 1 / leak time and an upper
    // one at 1 / rise time
    const double leak = p->sensor.piezo_leak_time, rise = p->sensor.piezo_rise_time;
    if (leak > 0 && leak < rise) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, sensor.piezo_leak_time, sensor.piezo_rise_time),
                            "sensor.piezo_leak_time = %g s is shorter than "
                            "sensor.piezo_rise_time = %g s, expected a longer one or 0",
                            leak, rise);
    }
    return STATUS_OK;
}

// Checks that the printed model has the one arm, method and wall that its equations are
// for.
static status check_printed(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    if (a->links != 2) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.links),
                            "the printed model has two links, but arm.links = %d",
                            a->links);
    }
    if (a->hub_joint != HUB_SPRING) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.hub_joint),
                            "the printed model has a hub spring, but arm.hub_joint = %s",
                            a->hub_joint == HUB_BEAM ? "beam" : "rigid");
    }
    if (p->method.name != METHOD_NEWMARK) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, method.name),
                            "the printed model runs with method.name = newmark only");
    }
    if (p->wall.kind == WALL_PLANE) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME1(p, wall.kind),
            "the printed model knows wall.kind = point or none, not plane");
    }
    return STATUS_OK;
}

// Sets what the program listing of the thesis does differently (errata C3, C5), unless
// the parameter for it is given.
static void follow_listing(printed_parameters *printed, const parameters *p)
{
    if (!IS_SET(p, printed.reevaluation)) {
        printed->reevaluation = REEVALUATE_LISTING;
    }
    if (!IS_SET(p, printed.feed_newmark_acceleration)) {
        printed->feed_newmark_acceleration = true;
    }
}

status parameters_resolve(parameters *p, fault *f)
{
    // defaults, of which some depend on program and method
    parameters_restore_defaults(p);
    if (p->printed.program == PROGRAM_LISTING) {
        follow_listing(&p->printed, p);
    }
    if (!IS_SET(p, method.residual_bound) && p->method.name != METHOD_EVENT) {
        p->method.residual_bound = STUDY_RESIDUAL_BOUND;
    }

    // group by group, then all together
    TRY(parameters_resolve_arm(p, f));
    if (isnan(p->motor.transconductance)) {
        p->motor.transconductance = p->motor.amplifier_gain / p->motor.resistance;
    }
    TRY(resolve_wall(p, f));
    TRY(check_engine(p, f));
    TRY(check_control(p, f));
    TRY(resolve_sensors(p, f));
    TRY(features_check(p, f));
    if (p->arm.model == ARM_PRINTED) {
        return check_printed(p, f);
    }
    return STATUS_OK;
}

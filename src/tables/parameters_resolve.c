// What follows from other parameters, and which of them contradict one another.
#include <assert.h>
#include <math.h>

#include "src/tables/k2_table.h"
#include "src/tables/parameters_parts.h"

// What the ledger may lack under the methods whose steps are the object of study.
#define STUDY_RESIDUAL_BOUND 1e-2

// What was not given follows the model, and the inertia of a link its shape.
static void resolve_defaults(parameters *p)
{
    parameters_restore_defaults(p);
    if (!IS_SET(p, method.residual_bound) && p->method.name != METHOD_EVENT) {
        p->method.residual_bound = STUDY_RESIDUAL_BOUND;
    }
}

// A current drive has a gain and a limit of its own, a voltage drive has neither.
static status resolve_motor(parameters *p, fault *f)
{
    motor_parameters *m = &p->motor;
    if (isnan(m->transconductance)) {
        m->transconductance = m->amplifier_gain / m->resistance;
    }
    const bool electric = m->inductance > 0 || (m->current_limit > 0 && m->drive == DRIVE_VOLTAGE);
    if (electric && p->method.name != METHOD_EVENT) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME3(p, motor.inductance, motor.current_limit, method.name),
            "%s runs with method.name = event only",
            m->inductance > 0 ? "motor.inductance" : "motor.current_limit under a voltage");
    }
    if (m->drive == DRIVE_CURRENT && m->inductance > 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, motor.inductance, motor.drive),
                            "motor.inductance is for motor.drive = voltage; an amplifier that "
                            "holds a current overcomes it");
    }
    if (m->drive == DRIVE_CURRENT) {
        return STATUS_OK;
    }
    if (IS_SET(p, motor.transconductance)) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, motor.transconductance, motor.drive),
                            "motor.transconductance is for motor.drive = current; with voltage "
                            "motor.amplifier_gain says what a command gives");
    }
    return STATUS_OK;
}

#define LEAST_FACE 1e-9 // mass of a wall's face that is not none [kg]

// Walls nobody has measured: docs/explanation/model.md says where these come from.
#define SOFT_STIFFNESS   75e3 // Kelvin-Voigt [N/m]
#define SOFT_DAMPING     20.0 // [N s/m]
#define HERTZ_STIFFNESS  1e6  // Hunt-Crossley [N/m^1.5]
#define RESTITUTION_LOSS 0.2  // restitution lost by speed, Hunt-Crossley's alpha [s/m]

static status resolve_wall(parameters *p, fault *f)
{
    wall_parameters *w = &p->wall;
    const bool hertz = w->contact == WALL_HUNT_CROSSLEY;

    // defaults that depend on the law
    if (isnan(w->stiffness)) {
        w->stiffness = hertz ? HERTZ_STIFFNESS : SOFT_STIFFNESS;
    }
    if (isnan(w->damping)) {
        w->damping = hertz ? 1.5 * RESTITUTION_LOSS * w->stiffness : SOFT_DAMPING;
    }

    // a mass stands on a linear spring, which also holds it back
    if (w->mass > 0 && w->contact != WALL_KELVIN_VOIGT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.mass, wall.contact),
                            "wall.mass is for wall.contact = kelvin-voigt, on whose spring and "
                            "damper the face stands, not %s",
                            hertz ? "hunt-crossley" : "rigid");
    }
    if (w->mass > 0 && w->mass < LEAST_FACE) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.mass),
                            "wall.mass = %g kg, expected 0 (none) or at least %g kg", w->mass,
                            LEAST_FACE);
    }

    // what a wall that moves needs, and cannot be combined with
    if (w->motion == MOTION_FILE && w->kind != WALL_NONE && w->motion_file[0] == '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, wall.motion_file),
                            "wall.motion = file needs a CSV file in wall.motion_file");
    }
    if (w->motion != MOTION_NONE && w->kind != WALL_NONE) {
        if (p->method.name != METHOD_EVENT) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, method.name),
                                "a wall that moves (wall.motion) runs with method.name = event "
                                "only");
        }
        if (w->mass > 0 && w->kind != WALL_PLANE) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, wall.kind),
                                "a face with a mass (wall.mass) that wall.motion shakes moves "
                                "along the wall's normal: expected wall.kind = plane");
        }
        if (p->arm.links == 1 && p->arm.hub_joint == HUB_RIGID && w->contact == WALL_RIGID &&
            p->motor.stiction > 0) {
            return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.motion, motor.stiction),
                                "a rigid wall that moves would drive a single link against the "
                                "hub's stiction, whose force is not determined: expected "
                                "motor.stiction = 0, more links or a wall that gives");
        }
    }

    // what a wall that gives cannot be combined with
    if (w->contact == WALL_RIGID) {
        return STATUS_OK;
    }
    if (IS_SET(p, wall.restitution) && w->mass == 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.restitution),
                            "wall.restitution is for wall.contact = rigid or a face with a mass; a "
                            "wall that gives takes its share by wall.damping");
    }
    if (p->method.name != METHOD_EVENT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, wall.contact, method.name),
                            "wall.contact = %s runs with method.name = event only",
                            hertz ? "hunt-crossley" : "kelvin-voigt");
    }
    return STATUS_OK;
}

// The engine asked for by name, which must be able to take the arm.
static status check_engine(const parameters *p, fault *f)
{
    if (p->method.engine != ENGINE_AUTO && p->method.name != METHOD_EVENT) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, method.engine, method.name),
                            "method.engine is for method.name = event");
    }
    const arm_parameters *a = &p->arm;
    const bool electric =
        p->motor.inductance > 0 || (p->motor.current_limit > 0 && p->motor.drive == DRIVE_VOLTAGE);
    const bool moves = p->wall.motion != MOTION_NONE && p->wall.kind != WALL_NONE;
    const bool bare = !moves && a->tip_mass == 0 && a->tilt == 0 && a->stiffening == 0 &&
                      a->air_drag == 0 && a->modal_ratios[0] == '\0' && parameters_even_links(a);
    const bool pair = a->links == 2 && bare && !electric && p->wall.contact == WALL_RIGID;
    if (p->method.engine == ENGINE_PAIR && !pair) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, method.engine),
                            "method.engine = pair takes two equal bare links in a level plane on a "
                            "rigid wall at rest, with a motor whose current follows at once; "
                            "expected auto or stiff");
    }
    return STATUS_OK;
}

// The controller's texts, and its timing.
static status check_control(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    const double period = 1 / c->rate;

    // plug-in and table of k2
    if (c->law == LAW_PLUGIN && c->plugin[0] == '\0') {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.plugin),
            "control.law = plugin needs the file of a shared object in control.plugin");
    }
    if (c->law == LAW_PROCESS && c->command[0] == '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.command),
                            "control.law = process needs the program to start in control.command");
    }
    if (c->law == LAW_PLAYBACK && c->playback_file[0] == '\0') {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, control.law, control.playback_file),
                            "control.law = playback needs a CSV file in control.playback_file");
    }
    k2_table table;
    if (k2_table_read(&table, c->k2_table, f) != STATUS_OK) {
        return STATUS_BAD_SCENARIO;
    }

    // so many commands are under way at most, and samples stay in order
    if (c->delay * c->rate + c->delay_periods > CONTROL_MOST_DELAY) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME3(p, control.delay_periods, control.delay, control.rate),
            "control.delay_periods = %g and control.delay = %g s are together longer than %d "
            "periods of %g s (control.rate)",
            c->delay_periods, c->delay, CONTROL_MOST_DELAY, period);
    }
    if (c->jitter * c->rate > 1) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME2(p, control.jitter, control.rate),
                            "control.jitter = %g s is more than the period of %g s (control.rate)",
                            c->jitter, period);
    }
    return STATUS_OK;
}

// A controller that takes the impact angle from a sensor needs it.
static status resolve_impact_angle(parameters *p, fault *f)
{
    const int source = p->control.impact_angle;
    if (source == IMPACT_ANGLE_BY_FILM && !IS_SET(p, sensor.film)) {
        p->sensor.film = true;
    }
    if (source == IMPACT_ANGLE_BY_ACCELEROMETER && !IS_SET(p, sensor.accelerometer)) {
        p->sensor.accelerometer = true;
    }

    // which somebody may have left out
    if (source == IMPACT_ANGLE_BY_FILM && !p->sensor.film) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, control.impact_angle, sensor.film),
            "control.impact_angle = film needs the sensor that sensor.film = false leaves out");
    }
    if (source == IMPACT_ANGLE_BY_ACCELEROMETER && !p->sensor.accelerometer) {
        return fault_set_at(f, STATUS_BAD_SCENARIO,
                            BLAME2(p, control.impact_angle, sensor.accelerometer),
                            "control.impact_angle = accelerometer needs the sensor that "
                            "sensor.accelerometer = false leaves out");
    }
    return STATUS_OK;
}

// A controller that is to get the piezoelectric sensor's force needs one that shows something.
static status resolve_piezo(parameters *p, fault *f)
{
    if (p->sensor.force == FORCE_BY_PIEZO && !IS_SET(p, sensor.piezo)) {
        p->sensor.piezo = true;
    }
    if (p->sensor.force == FORCE_BY_PIEZO && !p->sensor.piezo) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, sensor.force, sensor.piezo),
            "sensor.force = piezo needs the sensor that sensor.piezo = false leaves out");
    }

    // rise and leak are a band-pass: its lower edge lies below its upper one
    double leak = p->sensor.piezo_leak_time;
    if (leak > 0 && leak < p->sensor.piezo_rise_time) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, BLAME2(p, sensor.piezo_leak_time, sensor.piezo_rise_time),
            "sensor.piezo_leak_time = %g s is shorter than sensor.piezo_rise_time = %g "
            "s, expected a longer one or 0",
            leak, p->sensor.piezo_rise_time);
    }
    return STATUS_OK;
}

// The printed equations hold for one arm and one method.
static status check_printed(const parameters *p, fault *f)
{
    if (p->arm.links != 2) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.links),
                            "the printed model has two links, but arm.links = %d", p->arm.links);
    }

    if (p->arm.hub_joint != HUB_SPRING) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.hub_joint),
                            "the printed model has a hub spring, but arm.hub_joint = %s",
                            p->arm.hub_joint == HUB_BEAM ? "beam" : "rigid");
    }

    if (p->method.name != METHOD_NEWMARK) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, method.name),
                            "the printed model runs with method.name = newmark only");
    }

    if (p->wall.kind == WALL_PLANE) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, wall.kind),
                            "the printed model knows wall.kind = point or none, not plane");
    }
    if (p->arm.tip_mass != 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.tip_mass),
                            "the printed model carries nothing, but arm.tip_mass = %g kg",
                            p->arm.tip_mass);
    }
    if (p->arm.tilt != 0) {
        return fault_set_at(f, STATUS_BAD_SCENARIO, BLAME1(p, arm.tilt),
                            "the printed model lies level, but arm.tilt = %g rad", p->arm.tilt);
    }
    return STATUS_OK;
}

status parameters_resolve(parameters *p, fault *f)
{
    assert(p != NULL);
    resolve_defaults(p);
    status code = parameters_resolve_arm(p, f);
    code = code == STATUS_OK ? resolve_motor(p, f) : code;
    code = code == STATUS_OK ? resolve_wall(p, f) : code;
    code = code == STATUS_OK ? check_engine(p, f) : code;
    code = code == STATUS_OK ? check_control(p, f) : code;
    code = code == STATUS_OK ? resolve_impact_angle(p, f) : code;
    code = code == STATUS_OK ? resolve_piezo(p, f) : code;
    return code == STATUS_OK && p->arm.model == ARM_PRINTED ? check_printed(p, f) : code;
}

// What follows from other parameters, and which of them contradict one another.
#include <math.h>

#include "src/tables/features.h"
#include "src/tables/k2_table.h"
#include "src/tables/parameters_parts.h"

// What the ledger may lack under the methods whose steps are the object of study.
#define STUDY_RESIDUAL_BOUND 1e-2

#define LEAST_FACE           1e-9 // mass of a wall's face that is not none [kg]

// Walls nobody has measured: docs/explanation/model.md says where these come from.
#define SOFT_STIFFNESS   75e3 // Kelvin-Voigt [N/m]
#define SOFT_DAMPING     20.0 // [N s/m]
#define HERTZ_STIFFNESS  1e6  // Hunt-Crossley [N/m^1.5]
#define RESTITUTION_LOSS 0.2  // restitution lost by speed, Hunt-Crossley's alpha [s/m]

static status resolve_wall(parameters *p, fault *f)
{
    wall_parameters *w = &p->wall;
    const bool hertz = w->contact == WALL_HUNT_CROSSLEY, gives = w->contact != WALL_RIGID;
    const bool moves = w->motion != MOTION_NONE && w->kind != WALL_NONE;

    // defaults that depend on the law
    if (isnan(w->stiffness)) {
        w->stiffness = hertz ? HERTZ_STIFFNESS : SOFT_STIFFNESS;
    }
    if (isnan(w->damping)) {
        w->damping = hertz ? 1.5 * RESTITUTION_LOSS * w->stiffness : SOFT_DAMPING;
    }

    REFUSE_IF(w->mass > 0 && w->mass < LEAST_FACE, BLAME1(p, wall.mass), f,
              "wall.mass = %g kg, expected 0 (none) or at least %g kg", w->mass, LEAST_FACE);

    // what a wall that moves needs, and cannot be combined with
    REFUSE_IF(moves && w->motion == MOTION_FILE && w->motion_file[0] == '\0',
              BLAME2(p, wall.motion, wall.motion_file), f,
              "wall.motion = file needs a CSV file in wall.motion_file");
    REFUSE_IF(moves && w->mass > 0 && w->kind != WALL_PLANE, BLAME2(p, wall.motion, wall.kind), f,
              "wall.motion shakes along the wall's normal, but the face of a point (wall.mass) "
              "gives across the last link, which turns: expected wall.kind = plane");
    REFUSE_IF(
        moves && p->arm.links == 1 && p->arm.hub_joint == HUB_RIGID && !gives &&
            p->motor.stiction > 0,
        BLAME2(p, wall.motion, motor.stiction), f,
        "a rigid wall that moves would drive a single link against the hub's stiction, whose force "
        "is not determined: expected motor.stiction = 0, more links or a wall that gives");
    return STATUS_OK;
}

// The engine asked for by name, which must be able to take the arm.
static status check_engine(const parameters *p, fault *f)
{
    const feature_set features = features_of(p);
    const bool takes = (features & HAS(TWO_LINKS)) != 0 && (features & NOT_OF_PAIR) == 0;
    REFUSE_IF(p->method.engine == ENGINE_PAIR && !takes, BLAME1(p, method.engine), f,
              "method.engine = pair takes two equal bare links in a level plane on a rigid wall at "
              "rest, with a motor whose current follows at once; expected auto or stiff");
    return STATUS_OK;
}

status parameters_check_timing(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    const double period = 1 / c->rate;
    REFUSE_IF(c->delay * c->rate + c->delay_periods > CONTROL_MOST_DELAY,
              BLAME3(p, control.delay_periods, control.delay, control.rate), f,
              "control.delay_periods = %g and control.delay = %g s are together longer than %d "
              "periods of %g s (control.rate)",
              c->delay_periods, c->delay, CONTROL_MOST_DELAY, period);
    REFUSE_IF(c->jitter * c->rate > 1, BLAME2(p, control.jitter, control.rate), f,
              "control.jitter = %g s is more than the period of %g s (control.rate)", c->jitter,
              period);
    return STATUS_OK;
}

// The controller's texts, and its timing.
static status check_control(const parameters *p, fault *f)
{
    const control_parameters *c = &p->control;
    k2_table table;
    REFUSE_IF(c->law == LAW_PLUGIN && c->plugin[0] == '\0', BLAME2(p, control.law, control.plugin),
              f, "control.law = plugin needs the file of a shared object in control.plugin");
    REFUSE_IF(c->law == LAW_PROCESS && c->command[0] == '\0',
              BLAME2(p, control.law, control.command), f,
              "control.law = process needs the program to start in control.command");
    REFUSE_IF(c->law == LAW_PLAYBACK && c->playback_file[0] == '\0',
              BLAME2(p, control.law, control.playback_file), f,
              "control.law = playback needs a CSV file in control.playback_file");
    TRY(k2_table_read(&table, c->k2_table, f));
    return parameters_check_timing(p, f);
}

// Fits a sensor that a controller is to read, which somebody may have left out.
#define FIT(p, wanted, group, choice, word, name, f)                                               \
    do {                                                                                           \
        const bool wants_ = (p)->group.choice == (wanted);                                         \
        (p)->sensor.name = (p)->sensor.name || (wants_ && !IS_SET(p, sensor.name));                \
        REFUSE_IF(wants_ && !(p)->sensor.name, BLAME2(p, group.choice, sensor.name), f,            \
                  #group "." #choice " = " word " needs the sensor that sensor." #name             \
                         " = false leaves out");                                                   \
    } while (0)

static status resolve_sensors(parameters *p, fault *f)
{
    FIT(p, IMPACT_ANGLE_BY_FILM, control, impact_angle, "film", film, f);
    FIT(p, IMPACT_ANGLE_BY_ACCELEROMETER, control, impact_angle, "accelerometer", accelerometer, f);
    FIT(p, FORCE_BY_PIEZO, sensor, force, "piezo", piezo, f);

    // rise and leak are a band-pass: its lower edge lies below its upper one
    const double leak = p->sensor.piezo_leak_time, rise = p->sensor.piezo_rise_time;
    REFUSE_IF(leak > 0 && leak < rise, BLAME2(p, sensor.piezo_leak_time, sensor.piezo_rise_time), f,
              "sensor.piezo_leak_time = %g s is shorter than sensor.piezo_rise_time = %g s, "
              "expected a longer one or 0",
              leak, rise);
    return STATUS_OK;
}

// The printed equations hold for one arm and one method.
static status check_printed(const parameters *p, fault *f)
{
    const arm_parameters *a = &p->arm;
    REFUSE_IF(a->links != 2, BLAME1(p, arm.links), f,
              "the printed model has two links, but arm.links = %d", a->links);
    REFUSE_IF(a->hub_joint != HUB_SPRING, BLAME1(p, arm.hub_joint), f,
              "the printed model has a hub spring, but arm.hub_joint = %s",
              a->hub_joint == HUB_BEAM ? "beam" : "rigid");
    REFUSE_IF(p->method.name != METHOD_NEWMARK, BLAME1(p, method.name), f,
              "the printed model runs with method.name = newmark only");
    REFUSE_IF(p->wall.kind == WALL_PLANE, BLAME1(p, wall.kind), f,
              "the printed model knows wall.kind = point or none, not plane");
    return STATUS_OK;
}

// The listing's habits (errata C3, C5), each of which its own switch overrules.
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
    parameters_restore_defaults(p);
    if (p->printed.program == PROGRAM_LISTING) {
        follow_listing(&p->printed, p);
    }
    if (!IS_SET(p, method.residual_bound) && p->method.name != METHOD_EVENT) {
        p->method.residual_bound = STUDY_RESIDUAL_BOUND;
    }
    TRY(parameters_resolve_arm(p, f));
    if (isnan(p->motor.transconductance)) {
        p->motor.transconductance = p->motor.amplifier_gain / p->motor.resistance;
    }
    TRY(resolve_wall(p, f));
    TRY(check_engine(p, f));
    TRY(check_control(p, f));
    TRY(resolve_sensors(p, f));
    TRY(features_check(p, f));
    return p->arm.model == ARM_PRINTED ? check_printed(p, f) : STATUS_OK;
}

// State feedback with an observer on the linearised arm.
//
// In contact the two-link arm has one degree of freedom, x = theta2 - theta_imp:
//
//     M x'' = Kt u - D x' - friction - 4 k2 x,      f = 4 k2 x - mu x'',
//     M = I1 + 2 I + m l^2/2,     mu = (m l^2/4 - I)/l  (l = 1/2 of the beam)
//
// so braking presses. With f as the input x'' = s^2 (x - f/(4 k2)), s^2 = 4 k2/mu, which
// is unstable. The feedback that makes the sum of (f - command)^2 + effort u^2 least
// comes from the discrete Riccati equation. What it asks for is limited to commands that
// keep the force positive.
//
// The observer is a Kalman filter: in free flight on both links, so that the wall is
// found where the tip is when the force sensor first feels it; in contact on theta2, its
// velocity, the wall's angle and a constant torque, from encoder, tachometer and force
// sensor.
//
// optimal comes in with the constant command; predictive as fast as a limit on the force
// allows.
#include <math.h>
#include <string.h>

#include "src/rig/estimation/estimator.h"
#include "src/rig/laws/laws.h"
#include "src/base/plain_math.h"

enum { APPROACH, PRESS, HOLD };

// Parameters that both laws have, in this order; OWN is predictive's limit behind them.
enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, OWN };
#define STATE_FEEDBACK_PARAMETERS                                                        \
    {.name = "force"}, {.name = "approach_voltage"},                                     \
    {                                                                                    \
        .name = "contact_threshold"                                                      \
    }

typedef struct optimal_memory {
    controller_setup rig;
    double force, approach_voltage, threshold;
    double force_limit; // HUGE_VAL if there is none [N]
    double jump[2];     // x' after an impact, per velocity of each link before it
    int mode;
    bool started;
    bool flies;          // the estimate is of the free flight
    double inertia;      // M [kg m2]
    double stiffness;    // 4 k2 [N m/rad]
    double spring_force; // force at rest per x: 2 k2/l [N/rad]
    double mass_force;   // mu [N s2/rad]
    double divergence;   // s [1/s]
    double gain[2];      // of x and its rate [V/rad], [V s/rad]
    sampled_model flight, contact, during_delay;
    estimator e;         // of the flight or of the contact
    double ceiling;      // largest force to brake with [N]
    double hold_command; // [V]
    double held_force;   // reading of the force sensor, smoothed [N]
    set_point wanted;    // of which the force is the aim
    int readings_without_force;
} optimal_memory;

// A controller of this family: word, table of parameters, start function.
#define STATE_FEEDBACK_LAW(law, table, starts)                                           \
    CONTROLLER_LAW(law, state_feedback_modes, table, optimal_memory, .lockable = true,   \
                   .start = starts, .sample = state_feedback_sample, .tune = starts)

static const char *const state_feedback_modes[] = {"approach", "press", "hold", NULL};

enum { FREE_FIRST, FREE_LAST, FREE_FIRST_RATE, FREE_LAST_RATE }; // states in free flight
enum { PRESSED_ANGLE, PRESSED_RATE, PRESSED_WALL, PRESSED_TORQUE }; // states in contact

// Standard deviations of what the models leave out, a sample each, and of the readings.
static const double flight_noise[4] = {1e-8, 1e-8, 1e-5, 1e-5};
static const double contact_noise[4] = {1e-8, 2e-4, 1e-8, 1e-5};
#define ANGLE_VARIANCE 2e-7   // [rad2]
#define RATE_VARIANCE  2e-4   // [rad2/s2]
#define K2_DOUBT       0.1    // share by which k2 may be wrong
#define EFFORT         1e-3   // of a command in the cost [N2/V2]
#define URGENCY        20.0   // errors die faster than exp(-URGENCY t) [1/s]
#define SHORTFALL      0.0065 // of the aim, a share per newton, as the noise grows [1/N]
#define MOST_SHORTFALL 0.05   // a share

// Models the free flight of both links under a torque on the hub:
//
//     M q'' = torque e1 - D q1' e1 - K q
static void model_flight(optimal_memory *m)
{
    const controller_setup *r = &m->rig;
    double ml2 = r->link_mass * r->link_length * r->link_length;
    double m11 = r->hub_inertia + r->link_inertia + 1.25 * ml2, m12 = 0.5 * ml2;
    double m22 = r->link_inertia + 0.25 * ml2, det = m11 * m22 - m12 * m12;

    // x' after an impact by both links' velocities before it, (4.10)-(4.17)
    m->jump[0] = (m11 - m12) / m->inertia;
    m->jump[1] = (m12 - m22) / m->inertia;

    // accelerations M^-1 (torque e1 - D q1' e1 - K q)
    double bend_first = r->k2 * (m22 + m12) / det, bend_last = -r->k2 * (m12 + m11) / det;
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {
        [FREE_FIRST] = {[FREE_FIRST_RATE] = 1},
        [FREE_LAST] = {[FREE_LAST_RATE] = 1},
        [FREE_FIRST_RATE] = {-bend_first, bend_first, -m22 / det * r->hub_damping},
        [FREE_LAST_RATE] = {-bend_last, bend_last, m12 / det * r->hub_damping},
    };
    double input[ESTIMATOR_STATES] = {0, 0, m22 / det, -m12 / det};
    sampled_model_init(&m->flight, 4, rate, input, r->period);
}

// Samples the motion in contact over a time h [s]: M x'' = torque + T - D x' - 4 k2 x.
// The states are the hub's angle and rate, the wall's angle and the constant torque T.
static void model_contact(optimal_memory *m, double h, sampled_model *model)
{
    const double k = m->stiffness / m->inertia, d = m->rig.hub_damping / m->inertia;
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0}};
    double input[ESTIMATOR_STATES] = {[PRESSED_RATE] = 1 / m->inertia};
    rate[PRESSED_ANGLE][PRESSED_RATE] = 1;
    rate[PRESSED_RATE][PRESSED_ANGLE] = -k;
    rate[PRESSED_RATE][PRESSED_RATE] = -d;
    rate[PRESSED_RATE][PRESSED_WALL] = k;
    rate[PRESSED_RATE][PRESSED_TORQUE] = 1 / m->inertia;
    sampled_model_init(model, 4, rate, input, h);
}

// Takes setup and parameters, at the start or later, models the arm and finds the gains.
// The estimate and the mode stay. Returns why that cannot be, or NULL.
static const char *state_feedback_start(void *memory, const controller_setup *setup)
{
    optimal_memory *m = memory;
    const double l = setup->link_length, quarter = setup->link_mass * l * l / 4;

    m->rig = setup_kept(setup);
    m->force = setup->parameters[FORCE_WANTED];
    m->ceiling = fmax(m->ceiling, m->force);
    set_point_tell(&m->wanted, m->force, setup->period, m->inertia == 0);
    m->approach_voltage = setup->parameters[APPROACH_VOLTAGE];
    m->threshold = setup->parameters[THRESHOLD];
    m->force_limit = HUGE_VAL;

    // the one degree of freedom in contact
    m->inertia = pressed_inertia(setup);
    m->stiffness = 4 * setup->k2;
    m->spring_force = 2 * setup->k2 / l;
    m->mass_force = (quarter - setup->link_inertia) / l;
    m->divergence = HUGE_VAL;
    if (m->mass_force > 0) {
        m->divergence = sqrt(m->spring_force / m->mass_force);
    }
    if (!(setup->torque_per_volt > 0) || !(m->inertia > 0)) {
        return "it needs a motor that turns the hub and an arm with inertia";
    }

    model_flight(m);
    model_contact(m, setup->period, &m->contact);
    model_contact(m, setup->delay, &m->during_delay);

    // the plant: deviations of x and x' from rest, and the command that deviates
    sampled_model plant = {.n = 2};
    for (int i = 0; i < 2; i++) {
        memcpy(plant.a[i], m->contact.a[i], 2 * sizeof(double));
        plant.b[i] = m->contact.b[i] * setup->torque_per_volt;
    }

    // its output is the force, f = 4 k2 x - mu x'', on which the command acts at once
    const double per_torque = m->mass_force / m->inertia;
    const double output[2] = {m->spring_force + per_torque * m->stiffness,
                              per_torque * setup->hub_damping};
    const double at_once = -per_torque * setup->torque_per_volt;
    quadratic_cost cost = {.effort = EFFORT,
                           .growth = plain_exp(URGENCY * setup->period)};
    quadratic_cost_add(&cost, 2, output, at_once, 1);
    if (!quadratic_gain(&plant, &cost, m->gain)) {
        return "the Riccati equation of its gains has no stabilising solution";
    }
    return NULL;
}

// state_feedback_start for a law with a limit on the force behind the shared parameters.
static const char *state_feedback_start_with_limit(void *memory,
                                                   const controller_setup *setup)
{
    optimal_memory *m = memory;
    const char *refusal = state_feedback_start(memory, setup);
    if (setup->parameters[OWN] > 0) {
        m->force_limit = setup->parameters[OWN];
    } else {
        m->force_limit = HUGE_VAL;
    }
    return refusal;
}

// Coulomb friction at a velocity of the hub [N m]; where the hub almost rests it is,
// within its limit, what balances the other torque.
static double friction(const optimal_memory *m, double velocity, double other_torque)
{
    const double rest = 0.01; // [rad/s]
    const double limit = m->rig.stiction;
    if (fabs(velocity) > rest) {
        return coulomb_friction(&m->rig, velocity);
    }
    return fmax(-limit, fmin(other_torque, limit));
}

// Takes in the readings of encoder, of state 0, and tachometer, of the state `rate`.
static void read_hub(estimator *e, int rate, const controller_input *in)
{
    const double angle_row[4] = {1};
    double rate_row[4] = {0};
    rate_row[rate] = 1;
    estimator_correct(e, 4, angle_row, 0, in->encoder, ANGLE_VARIANCE);
    estimator_correct(e, 4, rate_row, 0, in->tachometer, RATE_VARIANCE);
}

// Begins an estimate with four states and their variances.
static void begin_estimate(optimal_memory *m, const double *state, const double *variance)
{
    m->e = (estimator){.z = {0}};
    for (int i = 0; i < 4; i++) {
        m->e.z[i] = state[i];
        m->e.p[i][i] = variance[i];
    }
}

// --- free flight -----------------------------------------------------------------------

// Moves the estimate of the flight on to this sample.
static void predict_flight(optimal_memory *m, const controller_input *in)
{
    double drive = m->rig.torque_per_volt * in->voltage;
    drive -= friction(m, m->e.z[FREE_FIRST_RATE], drive);
    estimator_predict(&m->e, &m->flight, drive, flight_noise);
}

// Begins the estimate in contact. The tip met the wall between the last sample and this
// one, and so the wall lies between the tip angles of both: a uniform distribution, whose
// variance is the square of their distance over 12.
static void enter_contact(optimal_memory *m, const controller_input *in)
{
    double tip_before = (m->e.z[FREE_FIRST] + m->e.z[FREE_LAST]) / 2;
    predict_flight(m, in);
    double tip_after = (m->e.z[FREE_FIRST] + m->e.z[FREE_LAST]) / 2;
    double wall = (tip_before + tip_after) / 2, distance = tip_after - tip_before;
    double wall_variance = distance * distance / 12 + 1e-6;

    begin_estimate(m, (double[]){in->encoder, in->tachometer, wall, 0},
                   (double[]){ANGLE_VARIANCE, RATE_VARIANCE, wall_variance, 1e-4});
    m->ceiling = m->force;
    m->flies = false;
}

// Force to brake with, somewhat above `stopping`, the least force that stops the hub [N].
static double braking_force(const optimal_memory *m, double stopping)
{
    return stopping + 0.2 * fmax(0, stopping - m->force) + 0.01;
}

// Begins the estimate in free flight again. The tip is taken to be still at the wall,
// with both links turning against each other.
static void leave_contact(optimal_memory *m, const controller_input *in)
{
    const double angle = in->encoder, rate = in->tachometer;
    begin_estimate(m, (double[]){angle, 2 * m->e.z[PRESSED_WALL] - angle, rate, -rate},
                   (double[]){ANGLE_VARIANCE, 1e-4, RATE_VARIANCE, 0.1});
    m->flies = true;
}

// The force to brake with if the tip touched the wall now [N]. The impact turns the
// links' velocities into x' by (4.10)-(4.17); stopping takes at least 4 k2 (x + x'/s),
// which grows as exp(s t) until the first command after the touch takes effect. The phase
// of the vibration enters by x and both velocities.
static double force_of_touch(const optimal_memory *m)
{
    const double *z = m->e.z;
    double x = (z[FREE_FIRST] - z[FREE_LAST]) / 2;
    double rate = m->jump[0] * z[FREE_FIRST_RATE] + m->jump[1] * z[FREE_LAST_RATE];
    double growth = plain_exp(m->divergence * (m->rig.period + m->rig.delay));
    return braking_force(m, m->spring_force * (x + rate / m->divergence) * growth);
}

// The command of the approach [V]. With a limit on the force it is as fast as the limit
// allows: a command that keeps up the present speed, plus one in proportion to the margin
// between the limit and the force of a touch now.
static double approach(const optimal_memory *m)
{
    if (m->force_limit == HUGE_VAL) {
        return m->approach_voltage;
    }
    const double gain = 3; // [V/N]

    // the limit, with a margin for errors of the model and for noise
    const double limit = 0.94 * m->force_limit - 0.035; // [N]
    double speed = m->e.z[FREE_FIRST_RATE];
    double keep = m->rig.hub_damping * speed + m->rig.stiction;
    double command = keep / m->rig.torque_per_volt + gain * (limit - force_of_touch(m));
    return fmin(command, m->approach_voltage);
}

// --- in contact ------------------------------------------------------------------------

// Hub acceleration of a state in contact under a torque on the hub [rad/s2].
static double acceleration(const optimal_memory *m, const double *z, double drive)
{
    double x = z[PRESSED_ANGLE] - z[PRESSED_WALL];
    double torque = drive + z[PRESSED_TORQUE] - m->rig.hub_damping * z[PRESSED_RATE] -
                    m->stiffness * x;
    return (torque - friction(m, z[PRESSED_RATE], torque)) / m->inertia;
}

// Contact force of a state under a torque on the hub, 2 k2/l x - mu x'' [N].
static double contact_force(const optimal_memory *m, const double *z, double drive)
{
    return m->spring_force * (z[PRESSED_ANGLE] - z[PRESSED_WALL]) -
           m->mass_force * acceleration(m, z, drive);
}

// Moves an estimate on by the period of a model, under a torque on the hub [N m]. A hub
// that friction holds stays at rest.
static void predict_contact(const optimal_memory *m, const sampled_model *model,
                            estimator *e, double drive)
{
    double *z = e->z, x = z[PRESSED_ANGLE] - z[PRESSED_WALL];
    double torque = drive + z[PRESSED_TORQUE] - m->stiffness * x;
    double rest_angle = z[PRESSED_ANGLE];
    bool rests = fabs(z[PRESSED_RATE]) < 0.01 && fabs(torque) <= m->rig.stiction;
    double held = friction(m, z[PRESSED_RATE], torque);

    // an error of k2 looks like a wall that moves with the hub
    double noise[4], wandering = K2_DOUBT * z[PRESSED_RATE] * m->rig.period;
    memcpy(noise, contact_noise, sizeof noise);
    noise[PRESSED_WALL] += wandering * wandering;
    estimator_predict(e, model, drive - held, noise);

    if (rests) {
        z[PRESSED_ANGLE] = rest_angle;
        z[PRESSED_RATE] = 0;
    }
}

// Moves the estimate in contact on to this sample and takes in its readings.
static void observe_contact(optimal_memory *m, const controller_input *in)
{
    estimator *e = &m->e;
    double drive = m->rig.torque_per_volt * in->voltage;
    predict_contact(m, &m->contact, e, drive);
    read_hub(e, PRESSED_RATE, in);

    // the force is row times state plus an offset, the part of friction
    double per_angle = m->spring_force + m->mass_force * m->stiffness / m->inertia;
    double row[4] = {per_angle, m->mass_force * m->rig.hub_damping / m->inertia,
                     -per_angle, -m->mass_force / m->inertia};
    double linear = 0;
    for (int i = 0; i < 4; i++) {
        linear += row[i] * e->z[i];
    }

    // the sensor is less accurate the harder it is pressed
    double deviation = 0.02 + 0.02 * in->force; // [N]
    estimator_correct(e, 4, row, contact_force(m, e->z, drive) - linear, in->force,
                      deviation * deviation);
}

// Limits a command [V] so that the force which it causes at once stays positive and is no
// greater than stopping takes. x + x'/s grows as exp(s t) while it is above f/(4 k2), and
// falls ever faster once f is a little above 4 k2 times it.
static double limit_command(optimal_memory *m, const double *z, double command)
{
    // what stopping takes may raise the ceiling
    const double x = z[PRESSED_ANGLE] - z[PRESSED_WALL];
    const double stopping = m->spring_force * (x + z[PRESSED_RATE] / m->divergence);
    if (stopping - m->force > 0) {
        m->ceiling = fmax(m->ceiling, braking_force(m, stopping));
    }

    // the force at once falls by per_volt for each volt: braking presses
    const double per_volt = m->mass_force / m->inertia * m->rig.torque_per_volt;
    const double force = contact_force(m, z, m->rig.torque_per_volt * command);
    const double least = fmin(0.1 + 0.05 * m->force, 0.5 * m->force);
    const double wanted = fmax(least, fmin(force, m->ceiling));
    if (per_volt > 0) {
        command += (force - wanted) / per_volt;
    }
    const double limit = m->rig.voltage_limit;
    return fmax(-limit, fmin(command, limit));
}

// Goes over to HOLD with the force that the beam presses with now.
static void begin_hold(optimal_memory *m, double x)
{
    m->mode = HOLD;
    m->held_force = m->spring_force * x;
    m->hold_command = m->stiffness * x / m->rig.torque_per_volt;
}

// Goes over to the mode that the user wants, with an estimate in that mode's model.
static void change_mode(optimal_memory *m, const controller_input *in)
{
    const double *z = m->e.z;
    m->mode = in->wanted_mode;
    if (m->mode == APPROACH && !m->flies) {
        leave_contact(m, in);
    } else if (m->mode == PRESS && !m->flies) {
        m->e.z[PRESSED_ANGLE] = in->encoder; // nothing was observed while it held
        m->e.z[PRESSED_RATE] = in->tachometer;
    } else if (m->mode == HOLD && m->flies) {
        begin_hold(m, (z[FREE_FIRST] - z[FREE_LAST]) / 2);
    } else if (m->mode == HOLD) {
        begin_hold(m, z[PRESSED_ANGLE] - z[PRESSED_WALL]);
    }
}

// The command of HOLD [V]: it balances the beam, so that friction has the middle of its
// band to hold the hub with. Goes back to PRESS when the averaged reading leaves the
// wanted force.
static double hold(optimal_memory *m, const controller_input *in)
{
    const double smoothing = 0.05;
    m->held_force += smoothing * (in->force - m->held_force);

    // press again, with the wall's angle that the averaged reading implies
    bool locked = in->wanted_mode == HOLD;
    const double error = fabs(m->held_force - m->force);
    if (!locked && (m->wanted.changed || error > 0.05 + 0.05 * m->force)) {
        m->mode = PRESS;
        if (!m->flies) {
            m->e.z[PRESSED_WALL] = in->encoder - m->held_force / m->spring_force;
            m->e.p[PRESSED_WALL][PRESSED_WALL] = 1e-6;
        }
    }
    return m->hold_command;
}

// The command of PRESS before there is contact [V]: feedback about the angle at which the
// beam would press if the wall were at its nominal angle.
static double seek_wall(const optimal_memory *m)
{
    const double *z = m->e.z;
    double aim = m->force / m->spring_force, x = z[FREE_FIRST] - m->rig.wall_angle;
    return m->stiffness * aim / m->rig.torque_per_volt + m->gain[0] * (aim - x) -
           m->gain[1] * z[FREE_FIRST_RATE];
}

// The command of PRESS in contact [V]: feedback about the aim, for the state when the
// command takes effect. Goes over to HOLD where the hub rests with the right force.
static double state_feedback_press(optimal_memory *m, const controller_input *in)
{
    // the state when the command takes effect
    estimator ahead = m->e;
    if (m->rig.delay > 0) {
        predict_contact(m, &m->during_delay, &ahead,
                        m->rig.torque_per_volt * in->voltage);
    }

    // the error of x from the aim, which is a little short of the wanted force
    const double *z = ahead.z, velocity = z[PRESSED_RATE];
    const double shortfall = fmin(SHORTFALL * m->force, MOST_SHORTFALL);
    const double aim = m->force * (1 - shortfall) / m->spring_force;
    const double x = z[PRESSED_ANGLE] - z[PRESSED_WALL], error = aim - x;

    // at rest within the tolerance the force is held
    const double tolerance = 0.01 * m->force + 0.005; // [N]
    const bool rests = fabs(velocity) < 0.02;
    const bool locked = in->wanted_mode == PRESS;
    if (!locked && !m->wanted.changed && rests &&
        fabs(error) * m->spring_force < tolerance) {
        begin_hold(m, x);
        return m->hold_command;
    }

    // friction against the motion, or against the one wanted where the hub rests
    const double aim_rate = m->wanted.seen_rate / m->spring_force;
    double friction_ahead;
    if (rests) {
        const double direction = aim_rate != 0 ? aim_rate : error;
        friction_ahead = copysign(m->rig.stiction, direction);
    } else {
        friction_ahead = friction(m, velocity, 0);
    }

    // the command that keeps the aim, and feedback of the deviations from it
    const double steady = (m->stiffness * aim + m->rig.hub_damping * aim_rate -
                           z[PRESSED_TORQUE] + friction_ahead) /
                          m->rig.torque_per_volt;
    const double command =
        steady + m->gain[0] * error + m->gain[1] * (aim_rate - velocity);
    return limit_command(m, z, command);
}

// Whether contact is lost: two readings in a row were not above the threshold.
static bool contact_is_lost(optimal_memory *m, const controller_input *in)
{
    const int most = 2;
    m->readings_without_force++;
    if (in->force > m->threshold) {
        m->readings_without_force = 0;
    }
    if (m->readings_without_force < most) {
        return false;
    }
    m->readings_without_force = 0;
    return true;
}

// Moves the observer on to this sample, and goes over from flight to contact and back
// unless the user holds the law in a mode.
static void observe(optimal_memory *m, const controller_input *in)
{
    bool locked = in->wanted_mode >= 0;
    if (!m->started) {
        m->started = m->flies = true;
        m->e = (estimator){.z = {in->encoder, in->encoder, 0, 0}};

    } else if (m->flies && in->wanted_mode != APPROACH && in->force > m->threshold) {
        enter_contact(m, in);
        if (!locked) {
            m->mode = PRESS;
        }
    } else if (m->flies) {
        predict_flight(m, in);
        read_hub(&m->e, FREE_FIRST_RATE, in);
    } else if (!locked && contact_is_lost(m, in)) {
        leave_contact(m, in);
        m->mode = APPROACH;
    } else if (m->mode == PRESS || locked) {
        observe_contact(m, in);
    }
}

// Fills in what is recorded beside the command: the mode, the angle wanted of the hub,
// and the estimate of the force.
static void report_estimate(const optimal_memory *m, const controller_input *in,
                            controller_output *out)
{
    out->mode = m->mode;
    if (m->mode == APPROACH) {
        out->calculated_force = 0;
        if (m->force_limit != HUGE_VAL) {
            out->calculated_force = force_of_touch(m);
        }
        return;
    }

    const double wall = m->flies ? m->rig.wall_angle : m->e.z[PRESSED_WALL];
    out->desired_angle = wall + m->force / m->spring_force;
    out->desired_velocity = 0;
    if (m->mode == HOLD) {
        out->calculated_force = m->held_force;
    } else if (m->flies) {
        out->calculated_force = 0;
    } else {
        out->calculated_force =
            contact_force(m, m->e.z, m->rig.torque_per_volt * in->voltage);
    }
}

// Observer, mode and command of one sample.
static void state_feedback_sample(void *memory, const controller_input *in,
                                  controller_output *out)
{
    optimal_memory *m = memory;
    observe(m, in);
    if (in->wanted_mode >= 0 && in->wanted_mode != m->mode) {
        change_mode(m, in);
    }

    // the command of the mode
    if (m->mode == APPROACH) {
        out->command = approach(m);
    } else if (m->mode == HOLD) {
        out->command = hold(m, in);
    } else if (m->flies) {
        out->command = seek_wall(m);
    } else {
        out->command = state_feedback_press(m, in);
    }
    set_point_follow(&m->wanted, m->rig.period);
    report_estimate(m, in, out);
}

// --- optimal ---

// State feedback with an observer on the linearised arm, behind the plain approach.
static const controller_parameter optimal_parameters[] = {STATE_FEEDBACK_PARAMETERS};

const controller optimal_law =
    STATE_FEEDBACK_LAW("optimal", optimal_parameters, state_feedback_start);

// --- predictive ---

// The optimal law behind an approach that keeps to control.force_limit wherever the wall
// is: were the tip to touch now, stopping would take at most that force.
static const controller_parameter predictive_parameters[] = {STATE_FEEDBACK_PARAMETERS,
                                                             {.name = "force_limit"}};

const controller predictive_law = STATE_FEEDBACK_LAW("predictive", predictive_parameters,
                                                     state_feedback_start_with_limit);

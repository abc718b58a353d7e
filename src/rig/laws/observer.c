// A law that needs no tuning: an observer of arm, wall and unknown torque (src/rig/arm_observer.h),
// and feedback of its estimate with gains from Riccati equations. docs/control.md derives it.
//
// TRAVEL brings the arm to the wall without vibration, from the guarded distance on no faster than
// what the commanded force stops. PRESS lets the force rise and regulates round the rest in which
// the beam presses with it. HOLD keeps that rest with the command in the middle of friction's band.
// RECOVER looks for the wall again where contact was lost.
#include <math.h>
#include <string.h>

#include "src/rig/arm_observer.h"
#include "src/rig/laws/laws.h"
#include "src/rig/riccati.h"
#include "src/base/plain_math.h"

enum { TRAVEL, PRESS, HOLD, RECOVER };
static const char *const mode_names[] = {"travel", "press", "hold", "recover", NULL};

enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, FORCE_LIMIT, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {{.name = "force"},
                                                       {.name = "approach_voltage"},
                                                       {.name = "contact_threshold"},
                                                       {.name = "force_limit"}};

#define PI 3.14159265358979323846

// The numbers of the design, derived in docs/control.md.
#define TRAVEL_TIME     0.05  // in which the arm takes up a wanted speed [s]
#define TOUCH_SHARE     0.5   // of the speed that the commanded force stops, to touch with
#define WALL_DOUBT      0.03  // by which the wall may be nearer than believed [rad]
#define RISE_PERIODS    0.5   // that the force rises for, periods of the vibration in contact
#define BIAS_TIME       0.1   // over which the error of the estimated force is averaged [s]
#define MOST_CORRECTION 0.3   // that it may add to the force aimed at, a share
#define LEAST_FORCE     0.1   // share of the force below which no command lets it fall at once
#define LOST_AFTER      2     // readings without force that mean lost contact
#define REST            0.02  // a slower hub is at rest [rad/s]
#define HOLD_WITHIN     0.02  // share of the force within which it is held at rest,
#define HOLD_BEYOND     0.04  // and beyond which it is held no longer,
#define HOLD_LEAST      0.005 // both on top of this [N]
#define HOLD_MEAN       0.1   // over which the reading is averaged meanwhile [s]
#define HOLD_SWING      0.1   // share of the force by which it may swing where it is held,
#define SWING_MEAN      0.04  // over which that is averaged [s]

typedef struct observer_memory {
    controller_setup rig;
    double p[PARAMETERS];
    arm_observer observer;
    double travel_gain[ESTIMATOR_STATES], press_gain[ESTIMATOR_STATES]; // [V per unit of state]
    double touch_speed, top_speed;                                      // [rad/s]
    double ramp_time;              // of a change of speed that leaves no vibration [s],
    double ramp_edge;              // of which its acceleration rises, and falls [s]
    sampled_model plan_model;      // of the free arm that the plan moves
    double plan[ESTIMATOR_STATES]; // its state: as the observer's in flight, the torque left out
    double cruise_speed;           // of the plan between its two changes of speed [rad/s]
    double planned_change;         // of speed, the present one [rad/s]
    double changing;               // how long it has been under way [s]
    bool slows;                    // the plan has begun to slow down for the touch
    double rise_from, rise_rate;   // of the first mode in contact where its rise began
    double rise_start, rise_time;  // when it began, and how long it takes [s]
    int mode;
    bool started;
    int readings_without_force;
    double
        correction; // of the force aimed at, by what the estimated force is above the reading [N]
    double held_force;   // mean of the reading while it holds [N]
    double mean_force;   // of the reading, over SWING_MEAN [N]
    double swing;        // its mean square about that [N2]
    double hold_command; // [V]
} observer_memory;

// --- synthesis --------------------------------------------------------------------------------

// Modal coordinates and rates of one state under the command, over a period; the angle of the
// rotation, which nothing brings back, is left out where `first` is 1.
static void command_model(const observer_memory *m, const mode_set *set, int first,
                          sampled_model *model)
{
    const int n = set->count, k = n - first;

    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0}}, input[ESTIMATOR_STATES] = {0};

    // a_i'' = -w_i^2 a_i - c_i a_i' + h_i (Kt u - damping hub rate)
    for (int i = 0; i < n; i++) {
        if (i >= first) {
            rate[i - first][k + i] = 1;
            rate[k + i][i - first] = -set->square[i];
        }
        rate[k + i][k + i] = -set->damping[i];
        for (int j = 0; j < n; j++) {
            rate[k + i][k + j] -= m->rig.hub_damping * set->hub[i] * set->hub[j];
        }
        input[k + i] = set->hub[i] * m->rig.torque_per_volt;
    }
    sampled_model_init(model, k + n, rate, input, m->rig.period);
}

// The free arm without damping, under a torque, for the plan.
static void command_plan(observer_memory *m)
{
    const mode_set *set = &m->observer.arm.free;
    const int n = set->count;
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0}}, input[ESTIMATOR_STATES] = {0};
    for (int i = 0; i < n; i++) {
        rate[i][n + i] = 1;
        rate[n + i][i] = -set->square[i];
        input[n + i] = set->hub[i];
    }
    sampled_model_init(&m->plan_model, 2 * n, rate, input, m->rig.period);
}

// In flight: the energy of the motion relative to the wanted rotation, and the effort with which
// the rotation alone has the time constant TRAVEL_TIME.
static bool find_travel_gain(observer_memory *m)
{
    const mode_set *set = &m->observer.arm.free;
    const int n = set->count;
    sampled_model model;
    quadratic_cost cost = {.growth = 1};
    command_model(m, set, 1, &model);

    // twice the energy: of motion, and of bending
    for (int i = 0; i < n; i++) {
        double strain[ESTIMATOR_STATES] = {0}, motion[ESTIMATOR_STATES] = {0};
        motion[n - 1 + i] = 1;
        quadratic_cost_add(&cost, model.n, motion, 0, 1);
        if (i > 0) {
            strain[i - 1] = 1;
            quadratic_cost_add(&cost, model.n, strain, 0, set->square[i]);
        }
    }

    // what the motor may do about it; the angle itself is not fed back
    double time_constant = set->hub[0] * m->rig.torque_per_volt * TRAVEL_TIME;
    cost.effort = time_constant * time_constant;
    double gain[ESTIMATOR_STATES] = {0};
    if (!quadratic_gain(&model, &cost, gain)) {
        return false;
    }
    memcpy(m->travel_gain + 1, gain, (size_t)model.n * sizeof gain[0]);
    return true;
}

// In contact: the energy of the motion relative to the rest, and the effort with which the first
// mode alone is critically damped: a'' = -w^2 a + h K u with u = -a'/sqrt(effort) has 2 w for h K /
// sqrt(effort).
static bool find_press_gain(observer_memory *m)
{
    const mode_set *set = &m->observer.arm.contact;
    const int n = set->count;
    sampled_model model;
    quadratic_cost cost = {.growth = 1};
    command_model(m, set, 0, &model);

    for (int i = 0; i < n; i++) {
        double strain[ESTIMATOR_STATES] = {0}, motion[ESTIMATOR_STATES] = {0};
        strain[i] = motion[n + i] = 1;
        quadratic_cost_add(&cost, model.n, motion, 0, 1);
        quadratic_cost_add(&cost, model.n, strain, 0, set->square[i]);
    }
    double drive = set->hub[0] * m->rig.torque_per_volt;
    cost.effort = drive * drive / (4 * set->square[0]);
    return quadratic_gain(&model, &cost, m->press_gain);
}

// The speeds. After a touch in uniform rotation v the first mode has a' = p v. With the force as
// input it obeys a'' = s^2 (a - h L f/w^2), s^2 = w^2/(p h - 1): the force w^2 (a + a'/s)/(h L)
// stops it, after a time of noticing in which it grows as exp(s t). A constant acceleration for one
// period of the free arm's first vibration leaves none behind.
static void find_speeds(observer_memory *m, double force)
{
    const reduced_arm *arm = &m->observer.arm;
    const mode_set *set = &arm->contact;
    double square = set->square[0], h = set->hub[0], p = set->momentum[0];

    // the fastest is what the approach voltage holds against friction
    double held = m->rig.torque_per_volt * fabs(m->p[APPROACH_VOLTAGE]) - m->rig.stiction;
    m->top_speed = fmax(0, held) / fmax(m->rig.hub_damping, 1e-9);
    m->touch_speed = m->top_speed;

    // the touch is slow enough to be stopped
    if (p * h > 1) {
        double s = sqrt(square / (p * h - 1));
        double stopped = force * h * arm->length * s / (square * p) *
                         plain_exp(-s * (m->rig.period + m->rig.delay));
        m->touch_speed = fmin(m->touch_speed, TOUCH_SHARE * stopped);
    }

    m->ramp_edge = arm->free.count > 2 ? 2 * PI / sqrt(arm->free.square[2]) : 0;
    m->ramp_time = 2 * PI / sqrt(arm->free.square[1]) + m->ramp_edge;
    m->rise_time = RISE_PERIODS * 2 * PI / sqrt(square);
}

static const char *start(void *memory, const controller_setup *setup)
{
    observer_memory *m = memory;
    m->rig = *setup;
    memcpy(m->p, setup->parameters, sizeof m->p);
    if (!(setup->torque_per_volt > 0)) {
        return "it needs a motor that turns the hub";
    }

    // model, gains, and the plan's speeds
    const char *refusal = arm_observer_init(&m->observer, setup, m->p[FORCE_WANTED]);
    if (refusal != NULL) {
        return refusal;
    }

    if (!find_travel_gain(m) || !find_press_gain(m)) {
        return "the Riccati equation of its gains has no stabilising solution";
    }
    command_plan(m);
    double limit = m->p[FORCE_LIMIT];
    find_speeds(m, limit > 0 ? fmin(limit, m->p[FORCE_WANTED]) : m->p[FORCE_WANTED]);
    return NULL;
}

// --- commands ---------------------------------------------------------------------------------

static double limited(const observer_memory *m, double command)
{
    return fmax(-m->rig.voltage_limit, fmin(command, m->rig.voltage_limit));
}

// Friction to overcome on the way: of the motion, or of the one wanted where the hub rests.
static double friction_ahead(const observer_memory *m, double rate, double wanted)
{
    double way = fabs(rate) > REST ? rate : wanted;
    return way > 0 ? m->rig.stiction : way < 0 ? -m->rig.stiction : 0;
}

// Rotation of the plan at a speed, without vibration.
static void plan_rotation(observer_memory *m, double speed)
{
    const mode_set *set = &m->observer.arm.free;
    memset(m->plan, 0, sizeof m->plan);
    for (int i = 0; i < set->count; i++) {
        m->plan[set->count + i] = set->momentum[i] * speed;
    }
    m->changing = m->ramp_time;
}

// Speed of rotation of the plan [rad/s].
static double planned_speed(const observer_memory *m)
{
    const mode_set *set = &m->observer.arm.free;
    return m->plan[set->count] / set->momentum[0];
}

// From rest to the cruising speed, which leaves room to slow down before the guarded distance.
static void begin_plan(observer_memory *m, double angle)
{
    double way = m->rig.wall_angle - WALL_DOUBT - angle, ramp = m->ramp_time;
    double room = (way - m->touch_speed * ramp / 2) / ramp;
    m->cruise_speed = fmax(m->touch_speed, fmin(m->top_speed, room));
    m->planned_change = m->cruise_speed;
    m->changing = 0;
    m->slows = !(m->cruise_speed > m->touch_speed);
}

// Share of a change of speed that is made after a time: the integral of a trapezoid, which is one
// vibration's period as a box convolved with the next one's.
static double share_changed(const observer_memory *m, double t)
{
    const double T = m->ramp_time, edge = m->ramp_edge, top = 1 / (T - edge);
    t = fmax(0, fmin(t, T));
    if (t < edge) {
        return top * t * t / (2 * edge);
    }
    double left = T - t;
    return left < edge ? 1 - top * left * left / (2 * edge) : top * (t - edge / 2);
}

// Moves the plan on by a period; returns the torque that its rotation takes [N m].
static double follow_plan(observer_memory *m, double tip)
{
    double left = m->rig.wall_angle - WALL_DOUBT - tip;
    double slowing = (m->cruise_speed + m->touch_speed) / 2 * m->ramp_time;
    if (!m->slows && m->changing >= m->ramp_time && left <= slowing) {
        m->slows = true;
        m->planned_change = m->touch_speed - m->cruise_speed;
        m->changing = 0;
    }

    // the mean over the period
    double share = share_changed(m, m->changing + m->rig.period) - share_changed(m, m->changing);
    double torque = share * m->planned_change / m->rig.period * m->observer.arm.inertia;
    double next[ESTIMATOR_STATES];
    for (int i = 0; i < m->plan_model.n; i++) {
        next[i] = m->plan_model.b[i] * torque;
        for (int j = 0; j < m->plan_model.n; j++) {
            next[i] += m->plan_model.a[i][j] * m->plan[j];
        }
    }
    memcpy(m->plan, next, (size_t)m->plan_model.n * sizeof next[0]);
    m->changing += m->rig.period;
    return torque;
}

// Keeps the arm to the plan: the torque it takes, and feedback of all deviations but the angle.
static double travel(observer_memory *m, const estimator *e)
{
    const arm_observer *o = &m->observer;
    const mode_set *set = &o->arm.free;
    const int n = set->count;
    double speed = planned_speed(m), hub_speed = 0, feedback = 0;

    // all deviations but the angle's
    for (int i = 0; i < n; i++) {
        hub_speed += set->hub[i] * m->plan[n + i];
        feedback += m->travel_gain[i] * (m->plan[i] - e->z[i]) +
                    m->travel_gain[n + i] * (m->plan[n + i] - e->z[n + i]);
    }

    // and what the plan takes
    double torque = m->rig.hub_damping * hub_speed - e->z[arm_observer_torque_index(o)] +
                    friction_ahead(m, arm_observer_rate(o, e), fmax(speed, hub_speed)) +
                    follow_plan(m, arm_observer_tip(o, e));
    return limited(m, torque / m->rig.torque_per_volt + feedback);
}

// Limits a command so that the force it makes at once stays within what is allowed.
static double within_force(const observer_memory *m, const estimator *e, double command)
{
    const arm_observer *o = &m->observer;
    double per_volt = arm_observer_force_per_torque(o) * m->rig.torque_per_volt;
    double most = m->p[FORCE_LIMIT] > 0 ? m->p[FORCE_LIMIT] : HUGE_VAL;
    double least = LEAST_FORCE * m->p[FORCE_WANTED];
    if (per_volt < 0) {
        double force = arm_observer_force(o, e, m->rig.torque_per_volt * command);
        command += (fmax(least, fmin(force, most)) - force) / per_volt;
    }
    return limited(m, command);
}

// First mode at rest under a force [sqrt(kg m2)].
static double mode_at_rest(const observer_memory *m, double force)
{
    return m->observer.arm.contact.hub[0] * force * m->observer.arm.length /
           arm_observer_square(&m->observer, 0);
}

// The first mode's way goes on from where it is.
static void begin_rise(observer_memory *m, const estimator *e, double time)
{
    m->rise_start = time;
    m->rise_from = e->z[0];
    m->rise_rate = e->z[m->observer.arm.contact.count];
}

// The quintic that leads it to rest under the wanted force: coordinate, rate and second derivative
// at a time since it began.
static void rise_at(const observer_memory *m, double t, double *rise)
{
    const double T = m->rise_time, a = m->rise_from, v = m->rise_rate;
    const double way = mode_at_rest(m, m->p[FORCE_WANTED]) - a;
    const double cubic = (20 * way - 12 * v * T) / (2 * T * T * T);
    const double quartic = (-30 * way + 16 * v * T) / (2 * T * T * T * T);
    const double quintic = (12 * way - 6 * v * T) / (2 * T * T * T * T * T);
    rise[0] = a + t * (v + t * t * (cubic + t * (quartic + t * quintic)));
    rise[1] = v + t * t * (3 * cubic + t * (4 * quartic + t * 5 * quintic));
    rise[2] = t * (6 * cubic + t * (12 * quartic + t * 20 * quintic));
}

// Keeps the arm to the rise and then at rest: the first mode on its way, the others as its torque
// bends them.
static double press(const observer_memory *m, const estimator *e, double time)
{
    const arm_observer *o = &m->observer;
    const mode_set *set = &o->arm.contact;
    const int n = set->count;
    const double t = time - m->rise_start, aim = m->p[FORCE_WANTED] + m->correction;

    // the first mode's way, and the torque on it
    bool moves = t < m->rise_time;
    double rise[3] = {mode_at_rest(m, aim), 0, 0};
    if (moves) {
        rise_at(m, t, rise);
    }
    double a = rise[0], rate = rise[1];
    double torque = (rise[2] + arm_observer_square(o, 0) * a) / set->hub[0];

    // the others stand as that torque bends them
    double way = 0, feedback = 0, hub_rate = set->hub[0] * rate;
    for (int i = 0; i < n; i++) {
        double wanted = i == 0 ? a : set->hub[i] * torque / set->square[i];
        double off = wanted - e->z[i], off_rate = (i == 0 ? rate : 0) - e->z[n + i];
        way += set->hub[i] * off;
        feedback += m->press_gain[i] * off + m->press_gain[n + i] * off_rate;
    }

    torque += m->rig.hub_damping * hub_rate - e->z[arm_observer_torque_index(o)] +
              friction_ahead(m, arm_observer_rate(o, e), moves ? hub_rate : way);
    return within_force(m, e, torque / m->rig.torque_per_volt + feedback);
}

// Force with which the beam presses where the hub is [N].
static double resting_force(const observer_memory *m, const estimator *e)
{
    const arm_observer *o = &m->observer;
    return (arm_observer_holding_torque(o, e) + e->z[arm_observer_torque_index(o)]) / o->arm.length;
}

// --- modes ------------------------------------------------------------------------------------

// Contact and its loss by the force reading.
static void follow_contact(observer_memory *m, const controller_input *in)
{
    arm_observer *o = &m->observer;
    const bool felt = in->force > m->p[THRESHOLD];

    // it begins with the first reading that feels the wall
    if (!o->touches && felt) {
        arm_observer_touch(o, in->time);
        m->mode = PRESS;
        m->correction = 0;
        begin_rise(m, &o->e, in->time);
    }

    // it ends with several readings that do not
    m->readings_without_force = felt ? 0 : m->readings_without_force + 1;
    if (o->touches && m->readings_without_force >= LOST_AFTER) {
        arm_observer_leave(o, in->time);
        plan_rotation(m, m->touch_speed);
        m->slows = true;
        m->mode = RECOVER;
    }
}

// What the estimated force is above the reading, averaged, is added to the force aimed at once the
// rise is over: what model errors leave. It is bounded, and cannot wind up, being no integral of
// the way to go.
static void correct_aim(observer_memory *m, const controller_input *in)
{
    const arm_observer *o = &m->observer;
    double most = MOST_CORRECTION * m->p[FORCE_WANTED];
    if (in->time - m->rise_start >= m->rise_time) {
        double force = arm_observer_force(o, &o->e, m->rig.torque_per_volt * in->voltage);
        double share = fmin(1, m->rig.period / BIAS_TIME);
        m->correction += share * (force - in->force - m->correction);
        m->correction = fmax(-most, fmin(m->correction, most));
    }
}

// Holds where the hub rests with the wanted force and the beam has come to rest, until the
// reading's mean says otherwise or the hub moves.
static void choose_hold(observer_memory *m, const estimator *e, const controller_input *in)
{
    const arm_observer *o = &m->observer;
    double force = m->p[FORCE_WANTED], rate = fabs(arm_observer_rate(o, e));

    // the reading's mean, and how far it swings about it
    double off = in->force - m->mean_force, share = fmin(1, m->rig.period / SWING_MEAN);
    m->mean_force += share * off;
    m->swing += share * (off * off - m->swing);

    // held: until the mean of the readings is off
    if (m->mode == HOLD) {
        m->held_force += fmin(1, m->rig.period / HOLD_MEAN) * (in->force - m->held_force);
        bool right = fabs(m->held_force - force) < HOLD_BEYOND * force + HOLD_LEAST;
        m->mode = right && rate < 2 * REST ? HOLD : PRESS;
        return;
    }

    // at rest where the force is right: held from now on
    double rests_at = resting_force(m, e);
    if (rate < REST && fabs(rests_at - force) < HOLD_WITHIN * force + HOLD_LEAST &&
        sqrt(m->swing) < HOLD_SWING * force + HOLD_LEAST) {
        m->mode = HOLD;
        m->held_force = rests_at;
        m->hold_command = limited(m, arm_observer_holding_torque(o, e) / m->rig.torque_per_volt);
    }
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    observer_memory *m = memory;
    arm_observer *o = &m->observer;

    // what the sensors say
    if (!m->started) {
        m->started = true;
        arm_observer_start(o, in);
        begin_plan(m, in->encoder);
    } else {
        arm_observer_sample(o, in, in->force > m->p[THRESHOLD]);
        follow_contact(m, in);
    }

    // the command, for the state when it takes effect
    estimator ahead = arm_observer_ahead(o, in->voltage);
    double force_now = 0;
    if (o->touches) {
        choose_hold(m, &ahead, in);
        if (m->mode == PRESS) {
            correct_aim(m, in);
        }
        out->command =
            m->mode == HOLD ? m->hold_command : press(m, &ahead, in->time + m->rig.delay);
        out->desired_angle = o->wall + o->arm.contact.hub[0] * mode_at_rest(m, m->p[FORCE_WANTED]);
        out->desired_velocity = 0;
        force_now = arm_observer_force(o, &o->e, m->rig.torque_per_volt * in->voltage);
    } else {
        out->desired_velocity = planned_speed(m);
        out->command = travel(m, &ahead);
    }

    out->mode = m->mode;
    out->calculated_force = force_now;
}

const controller observer_law = {
    .interface = CONTROLLER_INTERFACE,
    .name = "observer",
    .modes = mode_names,
    .parameters = table,
    .parameter_count = PARAMETERS,
    .memory_size = sizeof(observer_memory),
    .start = start,
    .sample = sample,
};

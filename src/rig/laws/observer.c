// A law that needs no tuning: an observer of arm, wall and unknown torque (src/rig/arm_observer.h),
// and feedback of its estimate with gains from Riccati equations. docs/control.md derives it.
//
// TRAVEL brings the arm to the wall without vibration, from the guarded distance on no faster than
// what the commanded force stops. PRESS lets the force rise and regulates round the rest in which
// the beam presses with it. HOLD keeps that rest with the command in the middle of friction's band.
// RECOVER looks for the wall again where contact was lost.
#include <math.h>
#include <string.h>

#include "src/rig/laws/laws.h"
#include "src/rig/laws/observer_arms.h"

enum { TRAVEL, PRESS, HOLD, RECOVER };
static const char *const mode_names[] = {"travel", "press", "hold", "recover", NULL};

enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, FORCE_LIMIT, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {{.name = "force"},
                                                       {.name = "approach_voltage"},
                                                       {.name = "contact_threshold"},
                                                       {.name = "force_limit"}};

// The numbers of the law, derived in docs/control.md.
#define WALL_DOUBT      0.03  // by which the wall may be nearer than believed [rad]
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
    observer_arms arms;
    // the plan of the approach
    double plan[ESTIMATOR_STATES]; // its state: as the observer's in flight, the torque left out
    double start_angle;            // [rad]
    double cruise_speed;           // between its two changes of speed [rad/s]
    double speed_before;           // the present change of speed [rad/s]
    double planned_change;         // of speed, the present one [rad/s]
    double changing;               // how long it has been under way [s]
    bool slows;                    // it has begun to slow down for the touch
    double rise_from, rise_rate;   // of the first mode in contact where its rise began
    double rise_start;             // when it began [s]
    int mode;
    bool started;
    int readings_without_force;
    double correction;   // of the force aimed at: what the estimated force is above the reading [N]
    double held_force;   // mean of the reading while it holds [N]
    double mean_force;   // of the reading, over SWING_MEAN [N]
    double swing;        // its mean square about that [N2]
    double hold_command; // [V]
} observer_memory;

// --- the arms ---------------------------------------------------------------------------------

static const observer_design *design_of(const observer_memory *m)
{
    return observer_arms_design(&m->arms);
}

static const arm_observer *observer_of(const observer_memory *m)
{
    return observer_arms_observer(&m->arms);
}

static const char *start(void *memory, const controller_setup *setup)
{
    observer_memory *m = memory;
    m->rig = *setup;
    memcpy(m->p, setup->parameters, sizeof m->p);
    if (!(setup->torque_per_volt > 0)) {
        return "it needs a motor that turns the hub";
    }

    // what it is to do with whatever arm it is on
    double force = m->p[FORCE_WANTED], limit = m->p[FORCE_LIMIT];
    observer_task task = {.force = force,
                          .stopping_force = limit > 0 ? fmin(limit, force) : force,
                          .approach_voltage = m->p[APPROACH_VOLTAGE]};
    return observer_arms_init(&m->arms, setup, &task);
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
    const mode_set *set = &observer_of(m)->arm.free;
    memset(m->plan, 0, sizeof m->plan);
    for (int i = 0; i < set->count; i++) {
        m->plan[set->count + i] = set->momentum[i] * speed;
    }
}

// Speed of rotation of the plan [rad/s].
static double planned_speed(const observer_memory *m)
{
    const mode_set *set = &observer_of(m)->arm.free;
    return m->plan[set->count] / set->momentum[0];
}

// From now on the plan takes up another speed [rad/s].
static void change_speed(observer_memory *m, double speed)
{
    m->speed_before = planned_speed(m);
    m->planned_change = speed - m->speed_before;
    m->changing = 0;
}

// From rest to the cruising speed, which leaves room to slow down before the guarded distance.
static void begin_plan(observer_memory *m, double angle)
{
    const observer_design *d = design_of(m);
    double way = m->rig.wall_angle - WALL_DOUBT - angle;
    double room = (way - d->touch_speed * d->ramp_time / 2) / d->ramp_time;
    m->start_angle = angle;
    m->cruise_speed = fmax(d->touch_speed, fmin(d->top_speed, room));
    m->slows = !(m->cruise_speed > d->touch_speed);
    plan_rotation(m, 0);
    change_speed(m, m->cruise_speed);
}

// Share of a change of speed that is made after a time: the integral of a trapezoid, which is one
// vibration's period as a box convolved with the next one's.
static double share_changed(const observer_memory *m, double t)
{
    const double T = design_of(m)->ramp_time, edge = design_of(m)->ramp_edge, top = 1 / (T - edge);
    t = fmax(0, fmin(t, T));
    if (t < edge) {
        return top * t * t / (2 * edge);
    }
    double left = T - t;
    return left < edge ? 1 - top * left * left / (2 * edge) : top * (t - edge / 2);
}

// Moves the plan on by a period; returns the torque that its rotation takes [N m].
static double follow_plan(observer_memory *m)
{
    // the mean over the period
    double share = share_changed(m, m->changing + m->rig.period) - share_changed(m, m->changing);
    double torque = share * m->planned_change / m->rig.period * observer_of(m)->arm.inertia;
    double next[ESTIMATOR_STATES];
    const sampled_model *model = &design_of(m)->plan_model;
    for (int i = 0; i < model->n; i++) {
        next[i] = model->b[i] * torque;
        for (int j = 0; j < model->n; j++) {
            next[i] += model->a[i][j] * m->plan[j];
        }
    }
    memcpy(m->plan, next, (size_t)model->n * sizeof next[0]);
    m->changing += m->rig.period;
    return torque;
}

// Slows down for the touch where the tip [rad] comes near the guarded distance.
static void slow_in_time(observer_memory *m, double tip)
{
    const observer_design *d = design_of(m);
    double left = m->rig.wall_angle - WALL_DOUBT - tip;
    double slowing = (m->cruise_speed + d->touch_speed) / 2 * d->ramp_time;
    if (!m->slows && m->changing >= d->ramp_time && left <= slowing) {
        m->slows = true;
        change_speed(m, d->touch_speed);
    }
}

// The plan as it would be, had the present change of speed been begun for the present arm.
static void plan_again(observer_memory *m)
{
    double under_way = m->changing;
    if (m->slows) {
        plan_rotation(m, m->speed_before);
        change_speed(m, design_of(m)->touch_speed);
    } else {
        begin_plan(m, m->start_angle);
    }
    while (m->changing < under_way) {
        follow_plan(m);
    }
}

// Keeps the arm to the plan: the torque it takes, and feedback of all deviations but the angle.
static double travel(observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    const mode_set *set = &o->arm.free;
    const int n = set->count;
    slow_in_time(m, arm_observer_tip(o, e));
    double speed = planned_speed(m), hub_speed = 0, feedback = 0;

    // all deviations but the angle's
    for (int i = 0; i < n; i++) {
        hub_speed += set->hub[i] * m->plan[n + i];
        feedback += design_of(m)->travel_gain[i] * (m->plan[i] - e->z[i]) +
                    design_of(m)->travel_gain[n + i] * (m->plan[n + i] - e->z[n + i]);
    }

    // and what the plan takes
    double torque = m->rig.hub_damping * hub_speed - e->z[arm_observer_torque_index(o)] +
                    friction_ahead(m, arm_observer_rate(o, e), fmax(speed, hub_speed)) +
                    follow_plan(m);
    return limited(m, torque / m->rig.torque_per_volt + feedback);
}

// Limits a command so that the force it makes at once stays within what is allowed.
static double within_force(const observer_memory *m, const estimator *e, double command)
{
    const arm_observer *o = observer_of(m);
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
    return observer_of(m)->arm.contact.hub[0] * force * observer_of(m)->arm.length /
           arm_observer_square(observer_of(m), 0);
}

// The first mode's way goes on from where it is.
static void begin_rise(observer_memory *m, const estimator *e, double time)
{
    m->rise_start = time;
    m->rise_from = e->z[0];
    m->rise_rate = e->z[observer_of(m)->arm.contact.count];
}

// The quintic that leads it to rest under the wanted force: coordinate, rate and second derivative
// at a time since it began.
static void rise_at(const observer_memory *m, double t, double *rise)
{
    const double T = design_of(m)->rise_time, a = m->rise_from, v = m->rise_rate;
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
    const arm_observer *o = observer_of(m);
    const mode_set *set = &o->arm.contact;
    const int n = set->count;
    const double t = time - m->rise_start, aim = m->p[FORCE_WANTED] + m->correction;

    // the first mode's way, and the torque on it
    bool moves = t < design_of(m)->rise_time;
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
        feedback += design_of(m)->press_gain[i] * off + design_of(m)->press_gain[n + i] * off_rate;
    }

    torque += m->rig.hub_damping * hub_rate - e->z[arm_observer_torque_index(o)] +
              friction_ahead(m, arm_observer_rate(o, e), moves ? hub_rate : way);
    return within_force(m, e, torque / m->rig.torque_per_volt + feedback);
}

// Force with which the beam presses where the hub is [N].
static double resting_force(const observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    return (arm_observer_holding_torque(o, e) + e->z[arm_observer_torque_index(o)]) / o->arm.length;
}

// --- modes ------------------------------------------------------------------------------------

// Where the readings speak for another arm, what is under way begins anew for that one.
static void change_arm(observer_memory *m, double time)
{
    if (observer_of(m)->touches) {
        m->correction = 0;
        begin_rise(m, &observer_of(m)->e, time);
    } else {
        plan_again(m);
    }
}

// Contact and its loss by the force reading.
static void follow_contact(observer_memory *m, const controller_input *in)
{
    const bool touches = observer_of(m)->touches;
    const bool felt = in->force > m->p[THRESHOLD];

    // it begins with the first reading that feels the wall
    if (!touches && felt) {
        observer_arms_touch(&m->arms, in->time);
        m->mode = PRESS;
        m->correction = 0;
        begin_rise(m, &observer_of(m)->e, in->time);
    }

    // it ends with several readings that do not
    m->readings_without_force = felt ? 0 : m->readings_without_force + 1;
    if (touches && m->readings_without_force >= LOST_AFTER) {
        observer_arms_leave(&m->arms, in->time);
        plan_rotation(m, design_of(m)->touch_speed);
        change_speed(m, design_of(m)->touch_speed);
        m->slows = true;
        m->mode = RECOVER;
    }
}

// What the estimated force is above the reading, averaged, is added to the force aimed at once the
// rise is over: what model errors leave. It is bounded, and cannot wind up, being no integral of
// the way to go.
static void correct_aim(observer_memory *m, const controller_input *in)
{
    const arm_observer *o = observer_of(m);
    double most = MOST_CORRECTION * m->p[FORCE_WANTED];
    if (in->time - m->rise_start >= design_of(m)->rise_time) {
        double force = arm_observer_force(o, &o->e, m->rig.torque_per_volt * in->voltage);
        double share = fmin(1, m->rig.period / BIAS_TIME);
        m->correction += share * (force - in->force - m->correction);
        m->correction = fmax(-most, fmin(m->correction, most));
    }
}

// The reading's mean, and how far it swings about it. Just after an impact the sensor is off scale:
// beyond twice the wanted force a reading says no more than that it is too much.
static void follow_reading(observer_memory *m, double reading)
{
    double off = fmin(reading, 2 * m->p[FORCE_WANTED]) - m->mean_force;
    double share = fmin(1, m->rig.period / SWING_MEAN);
    m->mean_force += share * off;
    m->swing += share * (off * off - m->swing);
}

// Whether what is held is still right: a reading counts as at most five standard deviations off, as
// the sensor shows a blow on the tip which the hub does not feel.
static bool holds_right(observer_memory *m, double reading, double rate)
{
    double force = m->p[FORCE_WANTED], off = reading - m->held_force;
    double most = 5 * arm_observer_force_noise(force);
    m->held_force += fmin(1, m->rig.period / HOLD_MEAN) * fmax(-most, fmin(off, most));
    return fabs(m->held_force - force) < HOLD_BEYOND * force + HOLD_LEAST && rate < 2 * REST;
}

// Whether the hub rests where the force is right, and the beam has come to rest.
static bool rests_right(const observer_memory *m, const estimator *e, double rate)
{
    double force = m->p[FORCE_WANTED];
    return rate < REST && fabs(m->mean_force - force) < HOLD_BEYOND * force &&
           fabs(resting_force(m, e) - force) < HOLD_WITHIN * force + HOLD_LEAST &&
           sqrt(m->swing) < HOLD_SWING * force + HOLD_LEAST;
}

// Holds where it rests right, until the reading's mean says otherwise or the hub moves.
static void choose_hold(observer_memory *m, const estimator *e, const controller_input *in)
{
    const arm_observer *o = observer_of(m);
    double rate = fabs(arm_observer_rate(o, e));
    follow_reading(m, in->force);
    if (m->mode == HOLD) {
        m->mode = holds_right(m, in->force, rate) ? HOLD : PRESS;
    } else if (rests_right(m, e, rate)) {
        m->mode = HOLD;
        m->held_force = resting_force(m, e);
        m->hold_command = limited(m, arm_observer_holding_torque(o, e) / m->rig.torque_per_volt);
    }
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    observer_memory *m = memory;

    // what the sensors say
    if (!m->started) {
        m->started = true;
        observer_arms_start(&m->arms, in);
        begin_plan(m, in->encoder);
    } else {
        observer_arms_sample(&m->arms, in, in->force > m->p[THRESHOLD]);
        if (observer_arms_choose(&m->arms)) {
            change_arm(m, in->time);
        }
        follow_contact(m, in);
    }

    // the command, for the state when it takes effect
    const arm_observer *o = observer_of(m);
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

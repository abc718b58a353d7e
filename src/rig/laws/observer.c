// A law that needs no tuning: an observer of arm, wall and unknown torque
// (src/rig/estimation/arm_observer.h), and feedback of its estimate with gains from
// Riccati equations. docs/explanation/control-design.md derives it.
//
// TRAVEL brings the arm to the wall without vibration, from the guarded distance on no
// faster than what the commanded force stops; where the wall is not in doubt, in the
// least time that ends so. PRESS lets the force rise and regulates round the rest in
// which the beam presses with it. HOLD keeps that rest with the command in the middle of
// friction's band. RECOVER lands on the wall again, almost at rest, where contact was
// lost. A wall that throws the tip back again and again is none that an impact without
// rebound describes: there CATCH moves the hub, not the tip.
#include <math.h>
#include <string.h>

#include "src/rig/laws/observer_paths.h"
#include "src/rig/laws/law_parts.h"
#include "src/rig/laws/observer_design.h"

enum { TRAVEL, PRESS, HOLD, RECOVER, CATCH };
static const char *const mode_names[] = {"travel",  "press", "hold",
                                         "recover", "catch", NULL};

enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, FORCE_LIMIT, WALL_DOUBT, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {
    {.name = "force"},
    {.name = "approach_voltage"},
    {.name = "contact_threshold"},
    {.name = "force_limit"},
    {.name = "wall_doubt",
     .unit = "rad",
     .initial = 0.03,
     .minimum = 0,
     .maximum = 10,
     .description =
         "by which the wall may be nearer than believed; 0 comes in the least time"},
};

// The numbers of the law, derived in docs/explanation/control-design.md.
// in which a wall that is nearer than believed is looked for [s],
#define GUARD_BEFORE 0.08
#define GUARD_AFTER  0.03 // and one that is further
// over which the error of the estimated force is averaged [s]
#define BIAS_TIME       0.1
#define MOST_CORRECTION 0.3  // that it may add to the force aimed at, a share
#define LOST_AFTER      4e-3 // without a reading that shows force contact is lost [s]
// of following a set-point that moves [1/s]
#define PACE 60.0
// of the tip where it returns, for every newton wanted [rad/s/N],
#define LAND_SPEED 0.035
#define LAND_TIME  0.1  // or the way left over this, if that is faster [s]
#define BRAKING    0.5  // share of the force that this may press with meanwhile
#define REST       0.02 // a slower hub is at rest [rad/s]
// a set-point that turns the hub more slowly is at rest [rad/s]
#define TURNS       0.005
#define HOLD_WITHIN 0.02  // share of the force within which it is held at rest,
#define HOLD_BEYOND 0.04  // and beyond which it is held no longer,
#define HOLD_LEAST  0.005 // both on top of this [N]
#define HOLD_MEAN   0.1   // over which the reading is averaged meanwhile [s]
// share of the force by which it may swing where it is held,
#define HOLD_SWING 0.1
#define SWING_MEAN 0.04 // over which that is averaged [s]

// Of CATCH.
#define THROWN_BACK 3 // losses of contact after which it begins
// share of its whole way that the hub goes in a second at first,
#define CATCH_SPEED   1.0
#define CATCH_GROWTH  10.0 // what that gains with the way made [1/s],
#define CATCH_END     0.06 // and the time constant of its end [s]
#define CATCH_MEAN    0.01 // over which the reading is averaged [s]
#define INTEGRAL_TIME 0.2  // of the force error [s]
#define STAYS_AFTER   0.05 // in contact for longer, and the force rises as usual [s]
#define PHASE_LOST    3.0  // inverse of the damping's crossover times the loop's lag
#define FULL_FRICTION 0.05 // rate from which on friction is compensated whole [rad/s]

typedef struct observer_memory {
    controller_setup rig;
    double p[PARAMETERS];
    observer_arms arms;
    smooth_approach plan;
    quickest_touch quickest; // in place of that, where the wall is not in doubt,
    bool in_least_time;      // until the tip is there
    force_rise rise;         // of the first mode in contact
    int mode;
    bool started;
    int felt;            // readings in a row that showed contact
    set_point wanted;    // of which the force is the aim
    double risen;        // its force to which the rise is planned [N]
    double correction;   // of the force aimed at: what the estimated force is above the
                         // reading [N]
    double held_force;   // mean of the reading while it holds [N]
    double mean_force;   // of the reading, over SWING_MEAN [N]
    double swing;        // its mean square about that [N2]
    double hold_command; // [V]
    int losses;          // of contacts in a row that were brief
    double away;         // for how long no force has been felt [s]
    double touched;      // encoder at the last touch [rad]
    double hub_way;      // that the hub is to have made since [rad]
    double integral;     // of the force error [N]
} observer_memory;

// --- the arms --------------------------------------------------------------------------

static const observer_design *design_of(const observer_memory *m)
{
    return observer_arms_design(&m->arms);
}

static const arm_observer *observer_of(const observer_memory *m)
{
    return observer_arms_observer(&m->arms);
}

static const char *observer_start(void *memory, const controller_setup *setup)
{
    observer_memory *m = memory;
    m->rig = setup_kept(setup);
    memcpy(m->p, setup->parameters, sizeof m->p);
    set_point_tell(&m->wanted, PACE, m->p[FORCE_WANTED], setup->period, true);
    if (!(setup->torque_per_volt > 0)) {
        return "it needs a motor that turns the hub";
    }

    // what it is to do with whatever arm it is on
    double force = m->p[FORCE_WANTED], limit = m->p[FORCE_LIMIT];
    observer_task task = {.force = force,
                          .stopping_force = limit > 0 ? fmin(limit, force) : force,
                          .approach_voltage = m->p[APPROACH_VOLTAGE]};
    const char *refusal = observer_arms_init(&m->arms, setup, &task);
    m->in_least_time = refusal == NULL && !(m->p[WALL_DOUBT] > 0);
    if (m->in_least_time) {
        quickest_touch_init(&m->quickest, design_of(m));
    }
    return refusal;
}

// Whether two setups describe one arm, motor and loop.
static bool same_rig(const controller_setup *a, const controller_setup *b)
{
    return a->period == b->period && a->delay == b->delay &&
           a->torque_per_volt == b->torque_per_volt && a->hub_damping == b->hub_damping &&
           a->stiction == b->stiction && a->hub_inertia == b->hub_inertia &&
           a->link_mass == b->link_mass && a->k2 == b->k2 &&
           a->wall_angle == b->wall_angle && a->links == b->links &&
           a->hub_spring == b->hub_spring;
}

// The force and its limits may change; what the observers are designed for may not.
static const char *observer_tune(void *memory, const controller_setup *setup)
{
    observer_memory *m = memory;
    if (!same_rig(&m->rig, setup)) {
        return "it takes its model and its rate at the start only";
    }
    if (setup->parameters[FORCE_WANTED] != m->p[FORCE_WANTED] && m->mode == HOLD) {
        m->mode = PRESS;
    }
    set_point_tell(&m->wanted, PACE, setup->parameters[FORCE_WANTED], setup->period,
                   false);
    m->rig.voltage_limit = setup->voltage_limit;
    memcpy(m->p, setup->parameters, sizeof m->p);
    return NULL;
}

// --- commands --------------------------------------------------------------------------

static double limited(const observer_memory *m, double command)
{
    return fmax(-m->rig.voltage_limit, fmin(command, m->rig.voltage_limit));
}

// Friction that the command has to overcome [N m]: against the hub's rate, or where the
// hub rests against the rate that is wanted of it [rad/s].
static double friction_ahead(const observer_memory *m, double rate, double wanted_rate)
{
    double direction = fabs(rate) > REST ? rate : wanted_rate;
    return coulomb_friction(&m->rig, direction);
}

// Speed with which a tip that was thrown back is to return to the wall [rad/s]. It is
// proportional to the gap between tip and wall, at least that of a soft landing and at
// most that of the first touch.
static double landing_speed(const observer_memory *m, const estimator *e)
{
    const double gap = fabs(observer_of(m)->wall - arm_observer_tip(observer_of(m), e));
    return fmin(fmax(LAND_SPEED * m->p[FORCE_WANTED], gap / LAND_TIME),
                design_of(m)->touch_speed);
}

// The command that lands the tip softly [V]: it takes the vibration out of the arm, which
// then turns towards the wall as a whole.
static double landing_command(const observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    const mode_set *set = &o->arm.free;
    const int n = set->count;

    // feedback of all deviations from a turn at the landing speed but the angle's
    const double *gain = design_of(m)->land_gain, speed = landing_speed(m, e);
    double torque = 0;
    for (int i = 0; i < n; i++) {
        const double deflection_error = i > 0 ? -e->z[i] : 0;
        torque += gain[i] * deflection_error +
                  gain[n + i] * (set->momentum[i] * speed - e->z[n + i]);
    }
    torque *= m->rig.torque_per_volt;

    // Hub damping, unknown torque and friction are compensated. Friction on a hub at rest
    // takes the direction of the torque and is no more than that.
    const double rate = arm_observer_rate(o, e), stiction = m->rig.stiction;
    const double share = fabs(rate) > REST ? rate / REST : torque / stiction;
    torque += m->rig.hub_damping * speed - e->z[arm_observer_torque_index(o)] +
              stiction * fmax(-1, fmin(share, 1));

    // braking the hub presses a tip that is still at the wall: not with too much force
    torque = fmax(torque,
                  -BRAKING * m->p[FORCE_WANTED] / fabs(arm_observer_force_per_torque(o)));
    return limited(m, torque / m->rig.torque_per_volt);
}

// The command that keeps the arm to the smooth approach [V]: the torque that the plan
// takes, and feedback of all deviations from it but the angle's.
static double travel_command(observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    const observer_design *design = design_of(m);
    const mode_set *set = &o->arm.free;
    const int n = set->count;

    // the plan goes over to its next phase when that is due
    smooth_approach_advance(&m->plan, design, arm_observer_tip(o, e),
                            e->z[0] / set->momentum[0]);
    const double speed = smooth_approach_speed(&m->plan, design);

    // feedback of the deviations from the planned state; the gain of the angle is 0
    const double *gain = design->travel_gain, *planned = m->plan.state;
    double hub_speed = 0, feedback = 0;
    for (int i = 0; i < n; i++) {
        hub_speed += set->hub[i] * planned[n + i];
        feedback += gain[i] * (planned[i] - e->z[i]) +
                    gain[n + i] * (planned[n + i] - e->z[n + i]);
    }

    // the torque that the plan takes, with damping, friction and the unknown torque
    const double torque =
        m->rig.hub_damping * hub_speed - e->z[arm_observer_torque_index(o)] +
        friction_ahead(m, arm_observer_rate(o, e), fmax(speed, hub_speed)) +
        smooth_approach_follow(&m->plan, design);
    return limited(m, torque / m->rig.torque_per_volt + feedback);
}

// The command that brings the tip to the wall in the least time [V], or by the smooth
// approach where no such plan exists.
static double least_time_command(observer_memory *m, const estimator *e)
{
    const controller_setup *r = &m->rig;
    const double volts = fmin(fabs(m->p[APPROACH_VOLTAGE]), r->voltage_limit);
    const double most = r->torque_per_volt * volts;

    // the net torque is the motor's, less friction and plus the unknown torque
    const double drift = e->z[arm_observer_torque_index(observer_of(m))] - r->stiction;
    const quickest_task task = {.z = e->z,
                                .low = drift - most,
                                .high = drift + most,
                                .wall = r->wall_angle,
                                .force = m->p[FORCE_WANTED]};
    m->in_least_time = most > 0 && quickest_touch_plan(&m->quickest, &task);
    if (m->in_least_time) {
        return limited(m,
                       (quickest_touch_next(&m->quickest) - drift) / r->torque_per_volt);
    }
    return travel_command(m, e);
}

// Rate with which a wrong force in contact runs away, at the stiffness that the readings
// show [1/s].
static double divergence(const observer_memory *m)
{
    return design_of(m)->divergence * sqrt(observer_of(m)->stiffness);
}

// Force that stops the first mode, w^2 (a + a'/s)/(h L) [N].
static double stopping_force(const observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    const mode_set *set = &o->arm.contact;
    double coordinate = e->z[0] + e->z[set->count] / divergence(m);
    return arm_observer_square(o, 0) * coordinate / (set->hub[0] * o->arm.length);
}

// The force in contact is at least this share of the stopping force. The less it is, the
// sooner a tip that landed after a bounce is stopped.
static double least_share(const observer_memory *m)
{
    if (m->losses > 0) {
        return 0.25;
    }
    return 0.5;
}

// Limits a command [V] so that the force which it causes at once stays between the least
// force and the force limit. Behind a spring at the hub the force does not follow the
// torque at once, and nothing is limited there but the voltage. A motion that a force
// within the limit cannot stop is allowed a greater one: it has to be braked, and braking
// presses.
static double within_force(const observer_memory *m, const estimator *e, double command)
{
    const arm_observer *o = observer_of(m);
    const double per_volt = arm_observer_force_per_torque(o) * m->rig.torque_per_volt;
    const double stopping = stopping_force(m, e), wanted = m->p[FORCE_WANTED];

    // between what keeps the tip at the wall and the limit, or what stops the motion
    const double least =
        fmax(0, fmin(OBSERVER_LEAST_FORCE * wanted, least_share(m) * stopping));
    double most = m->p[FORCE_LIMIT] > 0 ? m->p[FORCE_LIMIT] : HUGE_VAL;
    if (stopping > most) {
        most = 2 * stopping - wanted;
    }

    // the force at once falls by per_volt for each volt: braking presses
    if (-per_volt * m->rig.voltage_limit > least) {
        const double force = arm_observer_force(o, e, m->rig.torque_per_volt * command);
        command += (fmax(least, fmin(force, most)) - force) / per_volt;
    }
    return limited(m, command);
}

// Coordinate of the first mode in contact at rest under a force, h f L/w^2 [sqrt(kg m2)].
static double mode_at_rest(const observer_memory *m, double force)
{
    return observer_of(m)->arm.contact.hub[0] * force * observer_of(m)->arm.length /
           arm_observer_square(observer_of(m), 0);
}

// Plans the rise to the wanted force from the estimate of the first mode.
static void begin_rise(observer_memory *m, double time)
{
    const arm_observer *o = observer_of(m);
    const double coordinate = o->e.z[0], rate = o->e.z[o->arm.contact.count];
    const double limit = m->p[FORCE_LIMIT], stopped = coordinate + rate / divergence(m);
    m->risen = m->wanted.force;
    const double least = mode_at_rest(m, OBSERVER_LEAST_FORCE * m->risen);
    const force_rise_task task = {
        .coordinate = coordinate,
        .rate = rate,
        .divergence = divergence(m),
        .end = mode_at_rest(m, m->risen),
        .least = fmax(0, fmin(least, least_share(m) * stopped)),
        .most = limit > 0 ? mode_at_rest(m, limit) : HUGE_VAL,
        .time = time,
    };

    // where no force is wanted nothing rises
    if (task.end > 0) {
        m->rise = force_rise_begin(&task);
    } else {
        m->rise = (force_rise){.begun = time};
    }
}

// The first mode's planned coordinate, its rate and its second derivative at an instant
// [s]: on the rise, or at rest under the force that it led to, and as far on as the
// set-point has moved since. True on the rise.
static bool planned_motion(const observer_memory *m, double time, double motion[3])
{
    const bool rises = force_rise_moves(&m->rise, time);
    motion[0] = mode_at_rest(m, m->risen + m->correction);
    motion[1] = motion[2] = 0;
    if (rises) {
        force_rise_at(&m->rise, time, motion);
    }
    motion[0] += mode_at_rest(m, m->wanted.force - m->risen);
    motion[1] += mode_at_rest(m, m->wanted.rate);
    motion[2] += mode_at_rest(m, m->wanted.acceleration);
    return rises;
}

// Rate with which a set-point that moves turns the hub [rad/s].
static double turning_rate(const observer_memory *m)
{
    return observer_of(m)->arm.contact.hub[0] * mode_at_rest(m, m->wanted.rate);
}

// Force with which the beam presses where the hub is [N].
static double resting_force(const observer_memory *m, const estimator *e)
{
    const arm_observer *o = observer_of(m);
    return (arm_observer_holding_torque(o, e) + e->z[arm_observer_torque_index(o)]) /
           o->arm.length;
}

// Friction to overcome in contact [N m], where the rise wants a rate of the hub [rad/s].
// At rest the compensation is proportional to the force error, up to full friction: its
// full step would change the force by several per cent at once. The error is the mean of
// one by the estimate and one by the reading, which errors of the hub's sensors do not
// touch.
static double friction_pressing(const observer_memory *m, const estimator *e,
                                double hub_rate, bool rises)
{
    const double rate = arm_observer_rate(observer_of(m), e), force = m->p[FORCE_WANTED];
    if (fabs(turning_rate(m)) > TURNS) {
        return coulomb_friction(&m->rig, hub_rate);
    }
    if (rises || fabs(rate) > REST) {
        return friction_ahead(m, rate, hub_rate);
    }
    const double error =
        force - (resting_force(m, e) - m->correction + m->mean_force) / 2;
    return m->rig.stiction *
           fmax(-1, fmin(error / (HOLD_WITHIN * force + HOLD_LEAST), 1));
}

// The command that keeps the arm to the rise, and then at rest [V]: the first mode to its
// planned motion, the others to the deflections that the torque for that motion gives
// them.
static double press_command(const observer_memory *m, const estimator *e, double time)
{
    const arm_observer *o = observer_of(m);
    const mode_set *set = &o->arm.contact;
    const int n = set->count;

    // the first mode's planned motion, and the torque for it: a'' + w^2 a = h torque
    double motion[3];
    const bool rises = planned_motion(m, time, motion);
    double torque = (motion[2] + arm_observer_square(o, 0) * motion[0]) / set->hub[0];

    // feedback of the deviations from that; another mode rests at h torque/w^2
    const double *gain = design_of(m)->press_gain;
    double feedback = 0;
    for (int i = 0; i < n; i++) {
        double wanted = set->hub[i] * torque / set->square[i], wanted_rate = 0;
        if (i == 0) {
            wanted = motion[0];
            wanted_rate = motion[1];
        }
        feedback +=
            gain[i] * (wanted - e->z[i]) + gain[n + i] * (wanted_rate - e->z[n + i]);
    }

    // hub damping, friction, and the torque that the model does not know of
    const double hub_rate = set->hub[0] * motion[1];
    torque += m->rig.hub_damping * hub_rate - e->z[arm_observer_torque_index(o)] +
              friction_pressing(m, e, hub_rate, rises);
    return within_force(m, e, torque / m->rig.torque_per_volt + feedback);
}

// The command that presses against a wall which throws the tip back [V]. A hub that is
// moved by a spring and a damper is passive: no wall, however it answers, takes work out
// of it, and each rebound of the tip loses some to damper and wall. The hub goes slowly
// to where the arm presses with the wanted force, since a tip thrown back meets the wall
// again with what the hub has gained; an integral of the force error does the rest.
// Damper and spring are those of an arm damped at 0.7 of the critical, as far as the lag
// of the loop leaves them phase.
static double catch_command(observer_memory *m, const controller_input *in)
{
    const controller_setup *r = &m->rig;
    const arm_observer *o = observer_of(m);
    const double length = o->arm.length, force = m->p[FORCE_WANTED];

    // inertia and stiffness of the first mode at the hub
    const double h = o->arm.contact.hub[0];
    const double inertia = 1 / (h * h), stiffness = inertia * arm_observer_square(o, 0);

    // Damper c and spring k: c = 2 sqrt(I K) damps the arm with k = K at 0.7 of the
    // critical; where the loop's lag allows less, k is what that c damps as well
    const double damping = fmin(2 * sqrt(inertia * stiffness),
                                inertia / (PHASE_LOST * (r->period + r->delay)));
    const double spring =
        fmax(0, fmin(stiffness, damping * damping / (2 * inertia) - stiffness));

    // the hub goes on to the angle at which the arm presses with the wanted force
    const double end = force * length / stiffness, left = end - m->hub_way;
    const double rate =
        fmin(CATCH_SPEED * end + CATCH_GROWTH * m->hub_way, left / CATCH_END);
    const bool near_end = left < 0.1 * end;
    m->hub_way += rate * r->period;

    // near that angle the force error is integrated; the integral is bounded by what
    // friction and a wrong model can explain
    m->mean_force +=
        fmin(1, r->period / CATCH_MEAN) * (fmin(in->force, 2 * force) - m->mean_force);
    const double error = force - m->mean_force;
    if (near_end && fabs(error) > HOLD_WITHIN * force + HOLD_LEAST) {
        const double most = MOST_CORRECTION * force + r->stiction / length;
        m->integral += r->period / INTEGRAL_TIME * error;
        m->integral = fmax(-most, fmin(m->integral, most));
    }

    // the torque that the bent arm, damping and friction take, and spring and damper
    const double integral_torque = length * m->integral;
    const double angle = m->touched + m->hub_way + integral_torque / stiffness;
    const double friction_rate = near_end ? in->tachometer : rate;
    const double friction =
        r->stiction * fmax(-1, fmin(friction_rate / FULL_FRICTION, 1));
    const double torque = stiffness * m->hub_way + integral_torque +
                          r->hub_damping * rate + friction +
                          spring * (angle - in->encoder) +
                          fmax(0, damping - r->hub_damping) * (rate - in->tachometer);
    return limited(m, torque / r->torque_per_volt);
}

// --- modes -----------------------------------------------------------------------------

// Starts the present mode again for the arm that the readings have come to favour.
static void restart_mode(observer_memory *m, double time)
{
    if (observer_of(m)->touches) {
        m->correction = 0;
        begin_rise(m, time);
    } else if (m->in_least_time) {
        quickest_touch_init(&m->quickest, design_of(m));
    } else if (m->mode == TRAVEL) {
        smooth_approach_restart(&m->plan, design_of(m));
    }
}

// Goes over to PRESS: the tip has met the wall.
static void begin_contact(observer_memory *m, double time)
{
    observer_arms_touch(&m->arms, time);
    m->mode = PRESS;
    m->in_least_time = false;
    m->correction = 0;
    m->away = 0;
    m->touched = observer_of(m)->met;
    begin_rise(m, time);
}

// Goes over to CATCH or RECOVER: the tip has left the wall. A tip that is thrown back
// again and again is caught, any other lands again.
static void end_contact(observer_memory *m, const controller_input *in)
{
    // only brief contacts in a row count
    const bool brief = in->time - observer_of(m)->since < design_of(m)->ramp_time;
    if (brief) {
        m->losses++;
    } else {
        m->losses = 1;
    }

    // a tip that returns by itself is caught at the second loss, any at the third
    const bool returns = m->losses > 1 && arm_observer_returns(observer_of(m));
    if (m->mode != CATCH && (returns || m->losses >= THROWN_BACK)) {
        m->mode = CATCH;
        m->hub_way = in->encoder - m->touched;
        m->integral = 0;
        return;
    }
    observer_arms_leave(&m->arms, in->time);
    m->mode = RECOVER;
}

// Detects contact and its loss by the force reading. A plan of the least time that has
// come to its end is taken to have met the wall, whatever the reading.
static void follow_contact(observer_memory *m, const controller_input *in)
{
    const bool arrived = m->in_least_time && m->quickest.planned && m->quickest.left == 0;
    const bool touches = observer_of(m)->touches;
    if (!touches && (m->felt > 0 || arrived)) {
        begin_contact(m, in->time);
        return;
    }

    // a tip that was caught and has stayed at the wall is pressed as usual
    if (m->mode == CATCH && m->felt > 2 && m->felt * m->rig.period > STAYS_AFTER) {
        m->mode = PRESS;
        m->correction = 0;
        begin_rise(m, in->time);
    }

    // contact ends when no reading has shown it for a while, for longer during CATCH
    m->away += m->rig.period;
    if (m->felt > 0) {
        m->away = 0;
    }
    const bool caught = m->mode == CATCH && m->away < design_of(m)->ramp_time;
    if (touches && m->away >= LOST_AFTER && !caught) {
        end_contact(m, in);
    }
}

// Corrects model errors: once the rise is over, the averaged difference between estimated
// force and reading is added to the force aimed at. It is bounded and cannot wind up,
// since it does not integrate the control error.
static void correct_aim(observer_memory *m, const controller_input *in)
{
    const arm_observer *o = observer_of(m);
    double most = MOST_CORRECTION * m->p[FORCE_WANTED];
    if (!force_rise_moves(&m->rise, in->time)) {
        double force = arm_observer_force(o, &o->e, m->rig.torque_per_volt * in->voltage);
        double share = fmin(1, m->rig.period / BIAS_TIME);
        m->correction += share * (force - in->force - m->correction);
        m->correction = fmax(-most, fmin(m->correction, most));
    }
}

// Averages the reading, and the square of its deviation from that average. Just after an
// impact the sensor is off scale, so a reading counts as at most twice the wanted force.
static void follow_reading(observer_memory *m, double reading)
{
    double deviation = fmin(reading, 2 * m->p[FORCE_WANTED]) - m->mean_force;
    double share = fmin(1, m->rig.period / SWING_MEAN);
    m->mean_force += share * deviation;
    m->swing += share * (deviation * deviation - m->swing);
}

// Whether the averaged reading is still near enough to the wanted force for the command
// to be held. A reading counts as at most five standard deviations from the average,
// because the sensor also shows blows on the tip that the hub does not feel.
static bool held_force_is_right(observer_memory *m, double reading)
{
    double force = m->p[FORCE_WANTED], deviation = reading - m->held_force;
    double most = 5 * arm_observer_force_noise(force);
    m->held_force +=
        fmin(1, m->rig.period / HOLD_MEAN) * fmax(-most, fmin(deviation, most));
    return fabs(m->held_force - force) < HOLD_BEYOND * force + HOLD_LEAST;
}

// Whether friction holds the hub at rest, set-point and beam rest as well, and the force
// is right.
static bool rests_at_right_force(const observer_memory *m, const estimator *e,
                                 double rate)
{
    double force = m->p[FORCE_WANTED];
    return m->rig.stiction > 0 && fabs(turning_rate(m)) < TURNS && rate < REST &&
           fabs(m->mean_force - force) < HOLD_WITHIN * force + HOLD_LEAST &&
           fabs(resting_force(m, e) - force) < HOLD_WITHIN * force + HOLD_LEAST &&
           sqrt(m->swing) < HOLD_SWING * force + HOLD_LEAST;
}

// Goes over to HOLD where the hub rests at the right force, and back to PRESS when the
// averaged reading has left it.
static void choose_hold(observer_memory *m, const estimator *e,
                        const controller_input *in)
{
    const arm_observer *o = observer_of(m);
    double rate = fabs(arm_observer_rate(o, e));
    follow_reading(m, in->force);
    if (m->mode == HOLD) {
        if (!held_force_is_right(m, in->force)) {
            m->mode = PRESS;
        }
    } else if (rests_at_right_force(m, e, rate)) {
        m->mode = HOLD;
        m->held_force = resting_force(m, e);
        m->hold_command =
            limited(m, arm_observer_holding_torque(o, e) / m->rig.torque_per_volt);
    }
}

// The first sample: everything rests where the encoder is.
static void begin_approach(observer_memory *m, const controller_input *in)
{
    m->started = true;
    observer_arms_start(&m->arms, in);
    if (m->in_least_time) {
        observer_arms_know_wall(&m->arms, m->rig.wall_angle);
    }

    // the wall is looked for from a little before it may be until a little behind it
    const double wall = m->rig.wall_angle, doubt = m->p[WALL_DOUBT];
    const double soft = design_of(m)->arrival_speed;
    m->plan = (smooth_approach){.period = m->rig.period,
                                .wall_nearest = wall - fmin(doubt, GUARD_BEFORE * soft),
                                .wall_furthest = wall + fmin(doubt, GUARD_AFTER * soft)};
    smooth_approach_begin(&m->plan, design_of(m), in->encoder);
}

// What the sensors say of the arm, of which arm it is, and of contact.
static void take_readings(observer_memory *m, const controller_input *in)
{
    m->felt++;
    if (!(in->force > m->p[THRESHOLD])) {
        m->felt = 0;
    }
    observer_arms_sample(&m->arms, in, m->felt);
    if (observer_arms_choose(&m->arms)) {
        restart_mode(m, in->time);
    }
    follow_contact(m, in);
}

// The command in contact, for the state when it takes effect.
static void answer_in_contact(observer_memory *m, const estimator *ahead,
                              const controller_input *in, controller_output *out)
{
    const arm_observer *o = observer_of(m);
    if (m->mode == CATCH) {
        out->command = catch_command(m, in);
    } else {
        choose_hold(m, ahead, in);
        if (m->mode == HOLD) {
            out->command = m->hold_command;
        } else {
            correct_aim(m, in);
            out->command = press_command(m, ahead, in->time + m->rig.delay);
        }
    }

    out->desired_angle =
        o->wall + o->arm.contact.hub[0] * mode_at_rest(m, m->p[FORCE_WANTED]);
    out->desired_velocity = 0;
    out->calculated_force =
        arm_observer_force(o, &o->e, m->rig.torque_per_volt * in->voltage);
}

// The command in flight, for the state when it takes effect.
static void answer_in_flight(observer_memory *m, const estimator *ahead,
                             controller_output *out)
{
    out->calculated_force = 0;
    if (m->mode == RECOVER) {
        out->desired_velocity = landing_speed(m, ahead);
        out->command = landing_command(m, ahead);
        return;
    }
    out->desired_velocity = smooth_approach_speed(&m->plan, design_of(m));
    if (m->in_least_time) {
        out->command = least_time_command(m, ahead);
    } else {
        out->command = travel_command(m, ahead);
    }
}

static void observer_sample(void *memory, const controller_input *in,
                            controller_output *out)
{
    observer_memory *m = memory;
    if (m->started) {
        take_readings(m, in);
    } else {
        begin_approach(m, in);
    }
    set_point_follow(&m->wanted, m->rig.period);

    const estimator ahead = arm_observer_ahead(observer_of(m), in->voltage);
    if (observer_of(m)->touches) {
        answer_in_contact(m, &ahead, in, out);
    } else {
        answer_in_flight(m, &ahead, out);
    }
    out->mode = m->mode;
}

const controller observer_law =
    CONTROLLER_LAW("observer", mode_names, table, observer_memory,
                   .start = observer_start, .sample = observer_sample,
                   .tune = observer_tune);

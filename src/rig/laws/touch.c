// A law for a small board: comes to a wall whose place is only roughly known, without
// vibration and no faster than the commanded force allows, and presses by a passive hub
// whose rest moves. No estimator of the arm, no search, 23 numbers and a page of states.
//
// Travel. The hub's speed changes in two equal ramps, half a period of the arm's free
// mode apart, after which the beam does not vibrate: the second takes back what the first
// stirred up (Singer and Seering, ASME Journal of Dynamic Systems, Measurement and
// Control 112, 1990). The last stretch before the believed wall goes at the touch speed
// v = v0 + v1 f: what the force f takes up in a time, m v/f, is then much the same for
// every f. Behind the believed wall it goes faster and faster.
// With a force limit the whole way goes at the speed whose touch keeps to the limit,
// wherever the wall is. A touch without vibration at the rate w turns the hub against the
// pressed beam at x' = w (A - J2)/M, and the pulse of a hub that coasts has the peak
//
//     f = (2 k2/l) x'/s,    s^2 = 4 k2/M.
//
// Touch. The sensor feels the wall, or the hub's rate jumps by more than torque and beam
// explain: between two samples at 200 Hz a tip can strike and leave unread. The tip's
// place is the mean of the hub's angle and the last link's, which follows from the hub's
// motion by the beam's equation
//
//     J2 phi'' + a theta'' = -k2 (phi - theta),    a = m l^2/2,  J2 = I + m l^2/4.
//
// Press. The hub presses for a planned force p, and a damper ties it to a rest that moves
// as the beam's bend for p does, theta_r' = p' L/k_hub. The plan grows by
//
//     p' = (f - p)/tau, within -b (p + p0) and b (p + p0),
//
// at first with the touch speed, and no faster than a tip that answers a push of the hub
// the wrong way at first (a non-minimum-phase zero) can follow. An integral of p less the
// reading works in unbroken contact only. The damper stays below c J/lag, where lag is
// that of the loop, so that the hub remains passive. No spring is needed: where the hub
// rests is the wall's affair.
//
// Back. Where the wall has not been felt for a while, plan and integral decay, and the
// damper's rest creeps towards the wall, faster and faster.
#include <string.h>

#include "src/base/sincos.h"
#include "src/rig/laws/law_parts.h"

enum { TRAVEL, PRESS, BACK };
static const char *const mode_names[] = {"travel", "press", "back", NULL};

enum {
    FORCE_WANTED,
    THRESHOLD,
    FORCE_LIMIT,
    CRUISE,
    RAMP,
    TOUCH_SPEED,
    TOUCH_SPEED_PER_NEWTON,
    SLOW_BEFORE,
    SLOW_BEHIND,
    SEARCH,
    TRAVEL_DAMPING,
    TRAVEL_STIFFNESS,
    TRAVEL_FRICTION,
    PRESS_DAMPING,
    DAMPING_LIMIT,
    GROWTH,
    RISE_TIME,
    RISE_INERTIA,
    INTEGRAL,
    DEAD_BAND,
    UNBROKEN,
    LOST,
    DECAY,
    LANDING_SPEED,
    FELT,
    JUMP,
    PARAMETERS
};
static const controller_parameter table[PARAMETERS] = {
    [FORCE_WANTED] = {.name = "force"},
    [THRESHOLD] = {.name = "contact_threshold"},
    [FORCE_LIMIT] = {.name = "force_limit"},
    [CRUISE] = {"cruise", "rad/s", 0.836, 0.01, 10, "travel of the hub"},
    [RAMP] = {"ramp", "", 0.48, 0.01, 2,
              "length of a ramp of the speed, in periods of the free mode"},
    [TOUCH_SPEED] = {"touch_speed", "m/s", 0.127, 0, 1, "speed of the tip at the wall"},
    [TOUCH_SPEED_PER_NEWTON] = {"touch_speed_per_newton", "m/s/N", 0.0252, 0, 1,
                                "and what each newton of the command adds to it"},
    [SLOW_BEFORE] = {"slow_before", "rad", 0.0103, 0, 1,
                     "way before the believed wall at that speed"},
    [SLOW_BEHIND] = {"slow_behind", "rad", 0.0364, 0, 1,
                     "way behind the believed wall at that speed"},
    [SEARCH] = {"search", "m/s2", 0.79, 0, 10, "acceleration of the tip after that"},
    [TRAVEL_DAMPING] = {"travel_damping", "N m s/rad", 7.5, 0, 10,
                        "of the hub about its path"},
    [TRAVEL_STIFFNESS] = {"travel_stiffness", "N m/rad", 0.187, 0, 100,
                          "of the hub about its path"},
    [TRAVEL_FRICTION] = {"travel_friction", "", 0.71, 0, 2,
                         "share of the friction that is compensated on the way"},
    [PRESS_DAMPING] = {"press_damping", "N m s/rad", 0.392, 0, 10,
                       "of the hub about its rest"},
    [DAMPING_LIMIT] = {"damping_limit", "", 0.418, 0, 10,
                       "largest damping, times the loop's lag over the hub's inertia"},
    [GROWTH] = {"growth", "1/s", 9.44, 0.1, 100, "of the planned force at first"},
    [RISE_TIME] = {"rise_time", "s", 0.0798, 0.001, 1,
                   "time constant of the planned force at last"},
    [RISE_INERTIA] = {"rise_inertia", "", 0.768, 0, 3,
                      "share of the inertia's torque that is fed forward"},
    [INTEGRAL] = {"integral", "1/s", 8.17, 0, 100, "of the force's error"},
    [DEAD_BAND] = {"dead_band", "", 0.0404, 0, 0.2,
                   "error that it leaves, as a share of the command"},
    [UNBROKEN] = {"unbroken", "s", 0.0902, 0, 1, "contact after which it works"},
    [LOST] = {"lost", "s", 0.165, 0, 1, "time without the wall after which it is lost"},
    [DECAY] = {"decay", "1/s", 3.52, 0, 100, "of plan and integral then"},
    [LANDING_SPEED] = {"landing_speed", "m/s/N", 0.184, 0.001, 1,
                       "speed of the tip that comes back, for each newton"},
    [FELT] = {"felt", "", 0.285, 0.1, 2, "share of contact_threshold that is a touch"},
    [JUMP] = {"jump", "rad/s", 0.389, 0.005, 10, "of the hub's rate that is a blow"},
};

enum { DELAYED = 7 }; // periods of delay that the reference is kept for, at most

#define LAG_OF_SENSORS    2e-3 // what filters of the sensors add to the loop's lag [s]
#define FRICTION_RATE     0.03 // within which compensated friction turns round [rad/s]
#define STICTION_RATE     0.02 // the same of the hub's own [rad/s]
#define LIMIT_SHARE       0.88 // of the force limit that the pulse may reach
#define TURN_FRICTION     0.95 // share that is compensated where the set-point moves
#define TURN_RATE         0.005 // within which friction turns round with the set-point [rad/s]
#define FASTEST_SEARCH    0.3  // [rad/s]
#define LARGEST_LAG_ERROR 0.05 // of the angle that the spring answers to [rad]
#define INERTIA_SHARE     0.1  // of the beam's part that the damper may count on
#define AHEAD_OF_WALL     0.05 // a blow further before the believed wall is none [rad]
#define RETURN_TIME       0.2  // in which the landing speed doubles [s]
#define LARGEST_INERTIAL  0.3  // share of the command that inertia may add in the rise
#define ENCODER_TIME      0.02 // in which the hub's angle follows the encoder [s]
#define OFFSET_TIME       0.5  // in which the tachometer's offset follows [s]
#define LARGEST_OFFSET    0.05 // of the tachometer [rad/s]

// The arm as it is told, and what follows from it.
typedef struct touch_design {
    double length;        // L = 2 l [m]
    double inertia;       // of the rigid arm about the hub, J [kg m2]
    double hub_inertia;   // of hub and first link, A [kg m2]
    double link_inertia;  // of the last link, J2 [kg m2]
    double coupling;      // a of both [kg m2]
    double pressed;       // of the arm in contact [kg m2]
    double hub_stiffness; // of the hub against a tip on the wall [N m/rad]
    double frequency;     // of the free mode [rad/s]
    double cosine, sine;  // of its turn in a period
    double ramp;          // a ramp of the path's speed [s]
    double apart;         // the second after the first [s]
    double compliance;    // of the hub in it, 1/Jh - 1/J [1/(kg m2)]
    double touch_rate;    // of the hub at the wall [rad/s]
    double largest_rate;  // of the hub on the way and in search [rad/s]
    double landing_rate;  // of one that comes back [rad/s]
    double travel_damping, press_damping; // within the limit [N m s/rad]
    double slowness;                      // of the plan, 1 where the loop lags little
    int late;                             // periods until a command acts
} touch_design;

typedef struct touch_memory {
    controller_setup rig;
    double p[PARAMETERS];
    touch_design design;
    bool started;
    int mode;

    // the hub, by the tachometer, whose offset is learned from the encoder
    double angle, rate, offset; // [rad], [rad/s]

    // the last link under the hub's motion: J2 phi + a theta and its rate
    double momentum, momentum_rate;
    double angle_before, rate_before; // of the hub at the sample before
    double jump_before;               // of its rate, unexplained [rad/s]
    double last_link;                 // phi [rad]
    double commands[DELAYED + 1];     // [V], the last one first

    // the path: cruise speed, its end, the rigid arm's angle and rate, the free mode's
    double cruise_rate, cruise_end; // [rad/s], [s]
    double time;                    // since the start [s]
    double path, path_rate;         // [rad], [rad/s]
    double search_rate;             // behind the believed wall [rad/s]
    double mode_angle, mode_rate;   // in units of torque
    double hub_path[DELAYED + 1], hub_path_rate[DELAYED + 1]; // of the last samples

    // pressing
    set_point wanted;        // of which the force is the aim
    double plan;             // p [N]
    double first_plan;       // p0 [N]
    double rest_rate;        // theta_r' [rad/s]
    double integral;         // [N m]
    double unfelt, unbroken; // time since the wall was felt, and felt without a break [s]
} touch_memory;

static double bounded(double x, double low, double high)
{
    if (x < low) {
        return low;
    }
    if (x > high) {
        return high;
    }
    return x;
}

// --- design ----------------------------------------------------------------------------

// How stiff the hub of a chain of n links is against a tip on the wall: each joint has
// k2 n/2, and joint i takes the share i/n of the hub's torque.
static double stiffness_at_hub(const controller_setup *rig)
{
    const int links = rig->links > 2 ? rig->links : 2;
    double squares = 0;
    for (int i = 1; i < links; i++) {
        const double share = (double)i / links;
        squares += share * share;
    }
    return rig->k2 * links / 2 / squares;
}

static void design_arm(touch_design *d, const controller_setup *rig)
{
    const double l = rig->link_length, ml2 = rig->link_mass * l * l;
    d->length = 2 * l;
    d->hub_inertia = rig->hub_inertia + rig->link_inertia + 1.25 * ml2;
    d->coupling = ml2 / 2;
    d->link_inertia = rig->link_inertia + ml2 / 4;
    d->inertia = d->hub_inertia + 2 * d->coupling + d->link_inertia;
    d->pressed = pressed_inertia(rig);
    d->hub_stiffness = stiffness_at_hub(rig);

    // the mode of the free arm, hub and last link against one another
    const double determinant =
        d->hub_inertia * d->link_inertia - d->coupling * d->coupling;
    d->frequency = sqrt(rig->k2 * d->inertia / determinant);
    d->compliance = d->link_inertia / determinant - 1 / d->inertia;
    d->sine = inline_sin(d->frequency * rig->period);
    d->cosine = inline_cos(d->frequency * rig->period);
}

// The hub's rate at which the pulse of a touch has a force as its peak [rad/s].
static double rate_within(const touch_design *d, const controller_setup *rig,
                          double force)
{
    const double jump = (d->hub_inertia - d->link_inertia) / d->pressed;
    const double swing = sqrt(4 * rig->k2 / d->pressed);
    return force * swing * rig->link_length / (2 * rig->k2 * jump);
}

// The speeds of travel, search and landing, for the force and its limit.
static void design_speeds(touch_design *d, const controller_setup *rig, const double *p)
{
    const double force = fabs(p[FORCE_WANTED]);
    d->touch_rate = (p[TOUCH_SPEED] + p[TOUCH_SPEED_PER_NEWTON] * force) / d->length;
    d->largest_rate = p[CRUISE];
    d->landing_rate = p[LANDING_SPEED] * force / d->length;
    if (p[FORCE_LIMIT] > 0) {
        d->largest_rate = rate_within(d, rig, LIMIT_SHARE * p[FORCE_LIMIT]);
        d->touch_rate = d->largest_rate;
        d->landing_rate = fmin(d->landing_rate, d->largest_rate);
    }
}

// The ramps in which the speed changes, half a period of the free mode apart.
static void design_ramps(touch_design *d, const double *p)
{
    d->ramp = p[RAMP] * 2 * M_PI / d->frequency;
    d->apart = M_PI / d->frequency;
}

static const char *tune(void *memory, const controller_setup *setup)
{
    touch_memory *m = memory;
    touch_design *d = &m->design;
    if (!(setup->torque_per_volt > 0)) {
        return "it needs a motor with torque";
    }
    const bool at_start = m->rig.period == 0;
    set_point_tell(&m->wanted, SET_POINT_PACE, setup->parameters[FORCE_WANTED],
                   setup->period, at_start);
    m->rig = setup_kept(setup);
    memcpy(m->p, setup->parameters, sizeof m->p);
    design_arm(d, setup);
    design_ramps(d, m->p);
    design_speeds(d, setup, m->p);

    // what the loop's lag leaves of the dampers
    const double lag = setup->delay + setup->period / 2 + LAG_OF_SENSORS;
    const double behind_spring =
        1 / (d->compliance + 1 / d->inertia) - setup->hub_inertia;
    const double most =
        m->p[DAMPING_LIMIT] * (setup->hub_inertia + INERTIA_SHARE * behind_spring) / lag;
    d->travel_damping = fmin(m->p[TRAVEL_DAMPING], most);
    d->press_damping = fmin(m->p[PRESS_DAMPING], most);
    d->late = (int)fmin(DELAYED - 1, setup->delay / setup->period + 0.5);
    return NULL;
}

// --- what is sensed --------------------------------------------------------------------

// The first sample: everything at rest, and the cruise that brings the tip to the slow
// stretch.
static void begin_travel(touch_memory *m, double encoder)
{
    const touch_design *d = &m->design;
    m->started = true;
    m->angle = m->angle_before = m->path = encoder;
    m->momentum = (d->link_inertia + d->coupling) * encoder;
    for (int i = 0; i <= DELAYED; i++) {
        m->hub_path[i] = encoder;
    }
    const double way = fmax(0, m->rig.wall_angle - m->p[SLOW_BEFORE] - encoder -
                                   d->touch_rate * (d->ramp + d->apart) / 2);
    m->cruise_end = way / d->largest_rate;
    m->cruise_rate = way > 0 ? d->largest_rate : d->touch_rate;
}

// The hub between its two sensors: the tachometer's integral, drawn to the encoder.
static void follow_hub(touch_memory *m, const controller_input *in)
{
    const double period = m->rig.period;
    m->angle += period * (in->tachometer - m->offset);
    const double off = in->encoder - m->angle;
    m->angle += fmin(1, period / ENCODER_TIME) * off;
    m->offset -= fmin(0.1, period / OFFSET_TIME) * off / 0.05;
    m->offset = bounded(m->offset, -LARGEST_OFFSET, LARGEST_OFFSET);
    m->rate = in->tachometer - m->offset;
}

// Takes the last link over the period before, and returns by how much the hub's rate
// changed beyond what motor and beam explain [rad/s].
static double follow_last_link(touch_memory *m)
{
    const touch_design *d = &m->design;
    const controller_setup *rig = &m->rig;
    const double period = rig->period, a = d->coupling, J2 = d->link_inertia;
    const double determinant = d->hub_inertia * J2 - a * a;

    // the beam's torque at the middle of the period, and the motor's
    const double middle = (m->angle + m->angle_before) / 2;
    const double bend =
        (m->momentum + m->momentum_rate * period / 2 - a * middle) / J2 - middle;
    const double beam = -rig->k2 * bend;
    const double turning = (m->rate_before + m->rate) / 2 / STICTION_RATE;
    const double motor = rig->torque_per_volt * m->commands[d->late] -
                         rig->hub_damping * m->rate_before -
                         rig->stiction * bounded(turning, -1, 1);
    const double explained = period * ((motor - beam) * J2 - beam * a) / determinant;
    const double jump = m->rate - m->rate_before - explained;

    m->momentum += m->momentum_rate * period + beam * period * period / 2;
    m->momentum_rate += beam * period;
    m->last_link = (m->momentum - a * m->angle) / J2;
    return jump;
}

// Whether the tip was struck since the sample before: the hub's rate jumped, after it had
// not, and the tip may be at the wall.
static bool is_struck(touch_memory *m)
{
    const double jump = follow_last_link(m);
    const double tip = (m->angle + m->last_link) / 2;
    const bool struck = fabs(m->jump_before) < m->p[JUMP] / 2 && jump > m->p[JUMP] &&
                        tip > m->rig.wall_angle - AHEAD_OF_WALL;
    m->jump_before = jump;
    m->rate_before = m->rate;
    m->angle_before = m->angle;
    return struck;
}

// --- travel ----------------------------------------------------------------------------

// The free mode over a period under a torque, in units of the torque that its spring
// balances.
static void turn_mode(touch_memory *m, double torque)
{
    const touch_design *d = &m->design;
    const double rest = torque / (d->frequency * d->frequency);
    const double out = m->mode_angle - rest, rate = m->mode_rate / d->frequency;
    m->mode_angle = rest + d->cosine * out + d->sine * rate;
    m->mode_rate = d->frequency * (d->cosine * rate - d->sine * out);
}

// Puts a value before those of the samples before.
static void remember(double *values, double value)
{
    memmove(values + 1, values, DELAYED * sizeof *values);
    values[0] = value;
}

// The share of a change of speed that is made a time after its begin.
static double changed(const touch_design *d, double time)
{
    const double first = bounded(time / d->ramp, 0, 1);
    const double second = bounded((time - d->apart) / d->ramp, 0, 1);
    return (first + second) / 2;
}

// The torque along the path [N m].
static double travel_torque(touch_memory *m)
{
    const touch_design *d = &m->design;
    const controller_setup *rig = &m->rig;
    const double period = rig->period;

    // the rigid arm's speed: up, down to the touch speed, then in search
    const double before = m->path_rate;
    m->time += period;
    m->path_rate = m->cruise_rate * changed(d, m->time) -
                   (m->cruise_rate - d->touch_rate) * changed(d, m->time - m->cruise_end);
    if (m->path > rig->wall_angle + m->p[SLOW_BEHIND]) {
        const double faster = m->p[SEARCH] / d->length * period;
        const double most = fmin(FASTEST_SEARCH, d->largest_rate - d->touch_rate);
        m->search_rate = fmin(m->search_rate + faster, most);
    }
    m->path_rate += m->search_rate;
    m->path += (before + m->path_rate) / 2 * period;
    const double inertial = d->inertia * (m->path_rate - before) / period;

    // the hub with the mode that this torque moves; what it does now was asked for late
    turn_mode(m, inertial);
    remember(m->hub_path, m->path + d->compliance * m->mode_angle);
    remember(m->hub_path_rate, m->path_rate + d->compliance * m->mode_rate);
    const double rate = m->hub_path_rate[0];
    const double now = m->hub_path[d->late + 1], rate_now = m->hub_path_rate[d->late + 1];
    return inertial + rig->hub_damping * rate +
           m->p[TRAVEL_FRICTION] * rig->stiction * bounded(rate / FRICTION_RATE, -1, 1) +
           d->travel_damping * (rate_now - m->rate) +
           m->p[TRAVEL_STIFFNESS] *
               bounded(now - m->angle, -LARGEST_LAG_ERROR, LARGEST_LAG_ERROR);
}

// --- pressing and coming back ----------------------------------------------------------

// From the first touch on, or anew after a loss.
static void touch(touch_memory *m, bool felt)
{
    const touch_design *d = &m->design;
    double arrival = d->landing_rate;
    if (m->mode == TRAVEL) {
        arrival = fmin(d->touch_rate, fmax(m->path_rate, d->landing_rate));
        m->plan = 0;
    }
    m->first_plan = d->hub_stiffness * arrival / (m->p[GROWTH] * d->length);
    if (felt) {
        m->mode = PRESS;
        m->unfelt = 0;
    } else {
        m->mode = BACK;
        m->unfelt = m->p[LOST] + m->rig.period;
    }
}

// Moves the plan and the damper's rest on over a period, in contact or where it is lost.
static void follow_plan(touch_memory *m, bool lost)
{
    const touch_design *d = &m->design;
    const double period = m->rig.period;
    double change, creep = 0;
    if (lost) {
        const double since = m->unfelt / RETURN_TIME;
        change = -m->p[DECAY] * m->plan;
        creep = fmin(d->landing_rate * (1 + since * since), d->largest_rate);
        m->integral -= m->p[DECAY] / 2 * m->integral * period;
    } else {
        const double most = m->p[GROWTH] * (m->plan + m->first_plan);
        const double left = m->wanted.aim - m->plan;
        change = m->wanted.aim_rate + bounded(left / m->p[RISE_TIME], -most, most);
    }
    m->plan += change * period;
    m->rest_rate = change * d->length / d->hub_stiffness + creep;
}

// In unbroken contact the integral takes on the plan's error.
static void integrate_error(touch_memory *m, double reading)
{
    const double length = m->design.length, force = fabs(m->p[FORCE_WANTED]);
    const double left = m->p[DEAD_BAND] * force, error = m->plan - reading;
    const double beyond = error - bounded(error, -left, left);
    const double step = m->p[INTEGRAL] * length * beyond * m->rig.period;
    m->integral = bounded(m->integral + step, -length * force, length * force);
}

// The torque of the plan, and of the damper about its rest [N m].
static double press_torque(touch_memory *m, double reading)
{
    const touch_design *d = &m->design;
    const controller_setup *rig = &m->rig;
    const double before = m->rest_rate;
    const bool lost = m->unfelt > m->p[LOST];
    double damping = d->press_damping;
    m->mode = PRESS;
    if (lost) {
        m->mode = BACK;
        damping = d->travel_damping;
    }
    follow_plan(m, lost);
    if (m->unbroken > m->p[UNBROKEN]) {
        integrate_error(m, reading);
    }

    const double most = LARGEST_INERTIAL * fabs(m->p[FORCE_WANTED]) * d->length;
    const double inertial =
        m->p[RISE_INERTIA] * d->pressed * (m->rest_rate - before) / rig->period;
    const double turn = m->wanted.aim_rate * d->length / d->hub_stiffness;
    return m->plan * d->length + rig->hub_damping * m->rest_rate +
           TURN_FRICTION * rig->stiction * bounded(turn / TURN_RATE, -1, 1) +
           bounded(inertial, -most, most) + damping * (m->rest_rate - m->rate) +
           m->integral;
}

// --- a sample --------------------------------------------------------------------------

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    touch_memory *m = memory;
    const double period = m->rig.period;
    set_point_follow(&m->wanted, period);
    const bool felt = in->force > m->p[FELT] * m->p[THRESHOLD];
    if (!m->started) {
        begin_travel(m, in->encoder);
        m->rate = in->tachometer;
    } else {
        follow_hub(m, in);
    }
    if (felt) {
        m->unfelt = 0;
        m->unbroken += period;
    } else {
        m->unfelt += period;
        m->unbroken = 0;
    }

    // on the way a blow counts, too
    const bool struck = m->mode == TRAVEL && is_struck(m);
    if (m->mode != PRESS && (felt || struck)) {
        touch(m, felt);
    }

    double torque;
    if (m->mode == TRAVEL) {
        torque = travel_torque(m);
        out->desired_angle = m->hub_path[0];
        out->desired_velocity = m->hub_path_rate[0];
        out->calculated_force = 0;
    } else {
        torque = press_torque(m, in->force);
        out->desired_angle = (double)NAN;
        out->desired_velocity = m->rest_rate;
        out->calculated_force = m->plan;
    }
    out->mode = m->mode;
    out->command = bounded(torque / m->rig.torque_per_volt, -m->rig.voltage_limit,
                           m->rig.voltage_limit);
    remember(m->commands, out->command);
}

const controller touch_law =
    CONTROLLER_LAW("touch", mode_names, table, touch_memory, .start = tune,
                   .sample = sample, .tune = tune);

// Computed torque through the inverse of the linear two-link arm, frequency by frequency,
// after Bayo's method for flexible arms: which torque moves the tip as planned and then
// makes it press as planned? It is played back open-loop.
//
// The arm. With tip angle y = (q2 + q3)/2 as seen from the hub and bend d = q3 - q2 of
// the two links, contact force f at the tip, and the inertias M11, M12, M22 of both links
// about the hub, the last link's equation and the sum of both links' are
//
//     (M12 + M22) y'' - (M12 - M22)/2 d'' + k2 d = -f l
//     J y'' + (M22 - M11)/2 d'' + D (y' - d'/2) = torque - friction - 2 f l
//     J = M11 + 2 M12 + M22
//
// The first has no torque in it. It is what the inverse has to solve for d, for given y
// and f:
//
//     d'' - s^2 d = u,     u = g y'' + h f                                           (a)
//     s^2 = 2 k2/(M12 - M22)
//     g = 2 (M12 + M22)/(M12 - M22)
//     h = 2 l/(M12 - M22)
//
// and the second gives the torque. (+-s are the zeros of the transfer function from
// torque to tip: one of them unstable, since a tip that is pushed through a bend first
// goes the other way.)
//
// The inverse. At every frequency (a) is a division: a part U exp(iwt) of u takes
//
//     d = -U exp(iwt)/(w^2 + s^2)
//
// which is bounded though (a) integrated forwards is not. The plan consists of three
// pieces with few frequencies each,
//
//     travel   y'' = A sin(wt) + B (1 - cos(wt)),     w = 2 pi/travel_time, to the wall
//     rise     f = F/2 (1 - cos(wt)),                 w = pi/transition_time, at the wall
//     hold     f = F
//
// so that neither a discrete transform nor its padding is needed: summed over all
// frequencies, the transform of a piece gives the piece's own within it and, from the
// poles at w = +-is, exp(-s |t - t_k|) before and after each joint t_k of two pieces,
// with the heights that make d continuous. What runs ahead of a joint is why the method
// is not causal: the hub starts before the tip, bends the beam for it, and turns on into
// the press before the tip has arrived.
//
// The touch. A tip that arrives with the rate v is stopped by the wall's impulse P,
// plastically. The plan holds this too: y'' and f contain -v and P times a delta, P being
// such that the torque contains none: J v + (M22 - M11)/2 (g v - h P) = 2 l P. The rate
// of d jumps by h P - g v.
#include <math.h>

#include "src/rig/laws/law_parts.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"

enum { MODE_TRAVEL, MODE_PRESS };
static const char *const mode_names[] = {"travel", "press", NULL};

enum { FORCE_WANTED, ARRIVAL_SPEED, TRAVEL_TIME, TRANSITION, THRESHOLD, PARAMETERS };
static const controller_parameter table[PARAMETERS] = {
    {.name = "force"},           {.name = "arrival_speed"},     {.name = "travel_time"},
    {.name = "transition_time"}, {.name = "contact_threshold"},
};

enum { WAIT, TRAVEL, RISE, HOLD }; // pieces of the plan; piece k ends at joint k
enum { DEPARTURE, TOUCH, FULL_FORCE, JOINTS };

#define PI 3.14159265358979323846
// lead of the hub over the tip, in times 1/s: what the plan has before that, 0.03 %, is
// lost
#define LEAD_IN 8.0
// lead over the planned time, in times 1/s, from which on a touch moves the plan on
#define EARLY 1.5
// planned hub velocities below this are not compensated for friction [rad/s]
#define REST_RATE 1e-3

typedef struct inverse_memory {
    controller_setup rig;
    double force, threshold;
    double zero;          // s [1/s]
    double per_tip;       // g
    double per_force;     // h [1/(N s2)]
    double whole_inertia; // J [kg m2]
    double bend_inertia;  // (M22 - M11)/2 [kg m2]
    double sine, cosine;  // A and B [rad/s2]
    double travel, rise;  // frequencies w of the two pieces [rad/s]
    double joint[JOINTS]; // their times, from the tip's departure on [s]
    double ahead[JOINTS],
        behind[JOINTS];  // heights of the exponentials at each joint [rad]
    double arrival_rate; // v [rad/s]
    double start_angle;  // at the first sample [rad]
    double departure;    // when the tip departs, on the rig's clock [s]
    bool started;
} inverse_memory;

// What the plan asks for at one instant; bend and its rate first as the piece's
// frequencies give them, then with the exponentials.
typedef struct moment {
    double tip, tip_rate, tip_acceleration; // y and derivatives [rad], [rad/s], [rad/s2]
    double force;                           // f [N]
    double bend, bend_rate;                 // d and its derivative [rad], [rad/s]
} moment;

// The tip on its way, y'' = A sin(wt) + B (1 - cos(wt)). By (a) its parts bend the arm
// by -g/(w^2 + s^2), and the constant one by -g/s^2.
static moment travel_at(const inverse_memory *m, double time)
{
    const double w = m->travel, A = m->sine, B = m->cosine;
    const double s = inline_sin(w * time), c = inline_cos(w * time);
    const double zero_squared = m->zero * m->zero;
    const double bend_at_w = -m->per_tip / (w * w + zero_squared);
    const double bend_constant = -m->per_tip / zero_squared;

    return (moment){
        .tip = m->start_angle + A / w * (time - s / w) +
               B * (time * time / 2 - (1 - c) / (w * w)),
        .tip_rate = A / w * (1 - c) + B * (time - s / w),
        .tip_acceleration = A * s + B * (1 - c),
        .bend = bend_at_w * (A * s - B * c) + bend_constant * B,
        .bend_rate = bend_at_w * w * (A * c + B * s),
    };
}

// The tip pressed on with the whole force, which bends the arm by -h F/s^2.
static moment hold_at(const inverse_memory *m)
{
    return (moment){.tip = m->rig.wall_angle,
                    .force = m->force,
                    .bend = -m->per_force * m->force / (m->zero * m->zero)};
}

// The force on its rise, f = F/2 (1 - cos(wt)): half of what is held, less the cosine.
static moment rise_at(const inverse_memory *m, double time)
{
    const double w = m->rise, t = time - m->joint[TOUCH], half = m->force / 2;
    const double bend_at_w = -m->per_force / (w * w + m->zero * m->zero);

    moment now = hold_at(m);
    now.force = half * (1 - inline_cos(w * t));
    now.bend = now.bend / 2 - bend_at_w * half * inline_cos(w * t);
    now.bend_rate = bend_at_w * half * w * inline_sin(w * t);
    return now;
}

// Piece `piece` of the plan at a time since the tip's departure, which may lie at its
// ends.
static moment piece_at(const inverse_memory *m, int piece, double time)
{
    switch (piece) {
    case WAIT:
        return (moment){.tip = m->start_angle};
    case TRAVEL:
        return travel_at(m, time);
    case RISE:
        return rise_at(m, time);
    default:
        return hold_at(m);
    }
}

// Jump of the bend's rate at the touch, h P - g v, with the wall's impulse
//
//     P = (J + (M22 - M11)/2 g) v/(2 l + (M22 - M11)/2 h)
static double touch_kick(const inverse_memory *m)
{
    const double per_impulse = 2 * m->rig.link_length + m->bend_inertia * m->per_force;
    const double impulse =
        (m->whole_inertia + m->bend_inertia * m->per_tip) * m->arrival_rate / per_impulse;
    return m->per_force * impulse - m->per_tip * m->arrival_rate;
}

// Heights of the exponentials at the joints: there d is continuous and its rate jumps by
// the kick of a touch. With the heights a ahead of the joint and b behind it
//
//     a - b = jump of the pieces' bends,     a + b = (jump of their rates - kick)/s
static void join_pieces(inverse_memory *m)
{
    for (int k = 0; k < JOINTS; k++) {
        const moment left = piece_at(m, k, m->joint[k]);
        const moment right = piece_at(m, k + 1, m->joint[k]);
        const double kick = k == TOUCH ? touch_kick(m) : 0;

        const double difference = right.bend - left.bend;
        const double sum = (right.bend_rate - left.bend_rate - kick) / m->zero;
        m->ahead[k] = (sum + difference) / 2;
        m->behind[k] = (sum - difference) / 2;
    }
}

// The plan at a time since the tip's departure: its piece, and the exponentials of all
// joints, which rise ahead of a joint and decay behind it.
static moment plan_at(const inverse_memory *m, double time)
{
    int piece = WAIT;
    while (piece < JOINTS && time >= m->joint[piece]) {
        piece++;
    }

    moment now = piece_at(m, piece, time);
    for (int k = 0; k < JOINTS; k++) {
        const double decay = plain_exp(-m->zero * fabs(time - m->joint[k]));
        if (k < piece) {
            now.bend += m->behind[k] * decay;
            now.bend_rate += m->zero * -m->behind[k] * decay;
        } else {
            now.bend += m->ahead[k] * decay;
            now.bend_rate += m->zero * m->ahead[k] * decay;
        }
    }
    return now;
}

// Velocity of the hub at a moment of the plan, y' - d'/2 [rad/s].
static double hub_rate(const moment *planned)
{
    return planned->tip_rate - planned->bend_rate / 2;
}

// Torque of the plan at a moment, friction included [N m].
static double torque_of(const inverse_memory *m, const moment *planned)
{
    // the bend's acceleration by (a)
    const double bend_acceleration = m->zero * m->zero * planned->bend +
                                     m->per_tip * planned->tip_acceleration +
                                     m->per_force * planned->force;

    // a hub as good as at rest needs no push against friction
    const double rate = hub_rate(planned);
    double friction = 0;
    if (fabs(rate) > REST_RATE) {
        friction = coulomb_friction(&m->rig, rate);
    }

    // the sum of both links' equations
    return m->whole_inertia * planned->tip_acceleration +
           m->bend_inertia * bend_acceleration + m->rig.hub_damping * rate +
           2 * m->rig.link_length * planned->force + friction;
}

static const char *inverse_dynamics_start(void *memory, const controller_setup *setup)
{
    inverse_memory *m = memory;
    const double *p = setup->parameters;

    // inertias of both links about the hub
    const double l = setup->link_length, ml2 = setup->link_mass * l * l;
    const double m11 = setup->hub_inertia + setup->link_inertia + 1.25 * ml2;
    const double m12 = 0.5 * ml2;
    const double m22 = setup->link_inertia + 0.25 * ml2;

    // arms without a motor or without an inverse
    if (!(setup->torque_per_volt > 0)) {
        return "it needs a motor that turns the hub";
    }
    if (!(m12 > m22)) {
        return "the tip's motion has no bounded inverse with a link inertia of m l^2/4 "
               "or more";
    }

    // the linear arm, (a) and the sum of both links' equations
    m->rig = setup_kept(setup);
    m->force = p[FORCE_WANTED];
    m->threshold = p[THRESHOLD];
    m->zero = sqrt(2 * setup->k2 / (m12 - m22));
    m->per_tip = 2 * (m12 + m22) / (m12 - m22);
    m->per_force = 2 * l / (m12 - m22);
    m->whole_inertia = m11 + 2 * m12 + m22;
    m->bend_inertia = (m22 - m11) / 2;

    // the plan: frequencies of its pieces and the times of their joints
    m->arrival_rate = p[ARRIVAL_SPEED] / (2 * l);
    m->travel = 2 * PI / p[TRAVEL_TIME];
    m->rise = PI / p[TRANSITION];
    m->joint[TOUCH] = p[TRAVEL_TIME];
    m->joint[FULL_FORCE] = p[TRAVEL_TIME] + p[TRANSITION];
    return NULL;
}

// Makes the plan, from rest at the hub's angle at the first sample. With w T = 2 pi the
// travel ends with y' = B T = v and y = y0 + A T/w + B T^2/2, the wall's angle.
static void plan_from(inverse_memory *m, const controller_input *in)
{
    const double T = m->joint[TOUCH], distance = m->rig.wall_angle - in->encoder;
    m->started = true;
    m->start_angle = in->encoder;
    m->departure = in->time + LEAD_IN / m->zero;
    m->cosine = m->arrival_rate / T;
    m->sine = (distance - m->arrival_rate * T / 2) * m->travel / T;
    join_pieces(m);
}

// Plays the plan back. A touch well before the planned time advances the plan to the
// touch; nothing else is fed back. (Just before that time the hub already turns into the
// press, and the plan is better left unchanged.) Since a command holds for a period, it
// is that of the planned torque in the period's middle.
static void inverse_dynamics_sample(void *memory, const controller_input *in,
                                    controller_output *out)
{
    inverse_memory *m = memory;
    if (!m->started) {
        plan_from(m, in);
    }

    // a touch before its time moves the plan on to it
    double time = in->time - m->departure;
    if (time < m->joint[TOUCH] - EARLY / m->zero && in->force > m->threshold) {
        m->departure = in->time - m->joint[TOUCH];
        time = m->joint[TOUCH];
    }

    // where it should be now, and what the torque is to be while the command holds
    const moment now = plan_at(m, time);
    const moment held = plan_at(m, time + m->rig.delay + m->rig.period / 2);
    if (time < m->joint[TOUCH]) {
        out->mode = MODE_TRAVEL;
    } else {
        out->mode = MODE_PRESS;
    }
    out->command = torque_of(m, &held) / m->rig.torque_per_volt;
    out->desired_angle = now.tip - now.bend / 2;
    out->desired_velocity = hub_rate(&now);
    out->calculated_force = now.force;
}

const controller inverse_dynamics_law =
    CONTROLLER_LAW("inverse-dynamics", mode_names, table, inverse_memory,
                   .start = inverse_dynamics_start, .sample = inverse_dynamics_sample);

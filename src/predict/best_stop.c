// With the force as the input the arm on the wall reads x'' = s^2 (x - f/K), K = 2 k2/l,
// s^2 = K/mu. Its modes are xi = x + x'/s and zeta = x - x'/s:
//
//     xi' = s (xi - f/K),      zeta' = -s (zeta - f/K).
//
// zeta follows f/K by itself. xi runs away from it: at rest K xi = f, and whatever f does
// from now on,
//
//     K xi(t) = s times the integral of f(t + r) exp(-s r) over r from 0 on
//
// if xi is not to run away, a weighted mean of all forces to come. Hence two bounds.
//
// Peak: the mean is not above the largest: no peak is below K xi. f = K xi all along
// attains it: xi stays, x goes to xi, the arm comes to rest. Where the torque does not
// reach K xi at once, xi grows until it does; then the least peak P is that for which the
// hardest braking that P and the motor allow just brings the arm to rest, found by
// bisection (more braking now leaves a smaller xi).
//
// Settling: a force that stays within [a, b] has K xi within [a, b]; and where it is
// there, f = K xi keeps it there. So settling takes as long as it takes to bring K xi
// into [a, b], and since xi' falls with f, the largest force is the fastest way down and
// the smallest the fastest way up:
//
//     ln((P - b)/(P - K xi))/s from above,     ln(a/(K xi))/s from below.
//
// It is this only while the motor gives every force from 0 to P. It does not always, so
// the ways are integrated with the force that it gives; and inside the band it must be
// able to stay, which is tried out. A weak motor may need another way: coast on beyond
// the near edge, since the arm presses harder the further the beam is bent, or stop
// braking early, since it cannot stop the arm that comes back. So the least time is
// looked for over all ways that go to one extreme for a while and then to the other.
// (Within the tenths of a second that this takes a torque that raises xi' now raises xi
// at the end too, the arm's own vibration taking 0.28 s.)
#include "src/predict/best_stop.h"

#include <assert.h>
#include <math.h>

#include "src/arm/arm.h"
#include "src/base/extremes.h"
#include "src/predict/two_link.h"
#include "src/tables/features.h"

#define STEP        1e-4 // of the integration to the band [s]
#define COARSE_STEP 5e-4 // of the integrations that only try something out [s]
// time past the band's edge, so that rounding does not lead out again [s]
#define INSIDE  1e-6
#define HORIZON 1.0 // motions that take longer are given up [s]
#define HOLDING 0.3 // time for which staying in the band is tried out [s]

bool pressed_arm_model_of(const parameters *p, pressed_arm_model *m)
{
    double l = p->arm.length / 2, quarter = p->arm.mass / 2 * l * l / 4;
    const bool limited = p->motor.drive == DRIVE_VOLTAGE && p->motor.current_limit > 0;
    *m = (pressed_arm_model){
        .inertia = p->arm.hub_inertia + 2 * p->arm.link_inertia + 2 * quarter,
        .stiffness = 4 * p->arm.k2,
        .damping = motor_damping(&p->motor),
        .viscous = p->motor.viscous_friction,
        .stiction = p->motor.stiction,
        .torque_limit = motor_torque_per_volt(&p->motor) * motor_command_limit(&p->motor),
        .current_torque =
            limited ? p->motor.torque_constant * p->motor.current_limit : HUGE_VAL,
        .spring_force = 2 * p->arm.k2 / l,
        .mass_force = (quarter - p->arm.link_inertia) / l,
    };

    // the model has two bare links on a rigid hub and a wall that rests, and knows no
    // damping of the beam
    const feature_set features = features_of(p);
    const feature_set needed = HAS(CORRECTED) | HAS(TWO_LINKS) | HAS(WALL);
    return (features & needed) == needed &&
           (features & NOT_OF_THESIS & ~HAS(LIMITED)) == 0 &&
           p->arm.hub_joint == HUB_RIGID && p->arm.damping_ratio == 0 &&
           p->arm.joint_damping[0] == '\0' && m->mass_force > 0;
}

bool pressed_after_impact(const parameters *p, const three_body_state *before,
                          pressed_state *after)
{
    two_link t;
    double velocity[3], impulse;
    two_link_at(&t, p, FORM_CORRECTED, before->angle[1], before->angle[2]);
    if (two_link_velocity_jump(&t, before, velocity, &impulse, NULL) != STATUS_OK) {
        return false;
    }
    *after = (pressed_state){before->angle[1] - p->wall.angle, velocity[1]};
    return true;
}

// The force on the wall [N] under a torque that the command asks of the motor: f = K x -
// mu x'', with x'' from the hub's equation of motion.
static double force_under(const pressed_arm_model *m, pressed_state s, double torque)
{
    double friction = 0;
    if (s.velocity != 0) {
        friction = copysign(m->stiction, s.velocity);
    }

    // the limit of the current bounds the torque less the back EMF's part of the damping
    const double viscous = m->viscous * s.velocity, limit = m->current_torque;
    double motor = torque - m->damping * s.velocity;
    motor = smaller(limit - viscous, larger(-limit - viscous, motor));

    const double hub_torque = motor - friction - m->stiffness * s.x;
    return m->spring_force * s.x - m->mass_force * hub_torque / m->inertia;
}

// How the arm presses on its way: with the largest force allowed, `highest`, with the
// smallest one, `lowest`, or with K xi limited to these two. The motor then limits the
// force further.
typedef enum press_rule { PRESS_HARD, PRESS_SOFT, PRESS_KEEP } press_rule;
typedef struct way {
    press_rule rule;
    double lowest, highest; // [N]
} way;

// K xi [N], xi being the mode that runs away: x + x'/s, s = sqrt(K/mu).
static double runaway(const pressed_arm_model *m, pressed_state s)
{
    return m->spring_force * (s.x + s.velocity / sqrt(m->spring_force / m->mass_force));
}

// The force on the wall [N]: what the way asks for, within what the motor's full torque
// in either direction gives.
static double force_on(const pressed_arm_model *m, const way *w, pressed_state s)
{
    double wanted;
    if (w->rule == PRESS_HARD) {
        wanted = w->highest;
    } else if (w->rule == PRESS_SOFT) {
        wanted = w->lowest;
    } else {
        wanted = fmin(fmax(runaway(m, s), w->lowest), w->highest);
    }

    // a torque towards the wall speeds the hub up and so takes force off the wall
    const double least = force_under(m, s, m->torque_limit);
    const double most = force_under(m, s, -m->torque_limit);
    return fmin(fmax(wanted, least), most);
}

// The rates of x and x' on a way: x'' = (K x - f)/mu.
static pressed_state pressed_rate(const pressed_arm_model *m, const way *w,
                                  pressed_state s)
{
    double acceleration = (m->spring_force * s.x - force_on(m, w, s)) / m->mass_force;
    return (pressed_state){s.velocity, acceleration};
}

static pressed_state pressed_ahead(pressed_state s, pressed_state r, double h)
{
    return (pressed_state){s.x + h * r.x, s.velocity + h * r.velocity};
}

// One step of the classical Runge-Kutta method.
static pressed_state pressed_advance(const pressed_arm_model *m, const way *w,
                                     pressed_state s, double h)
{
    pressed_state a = pressed_rate(m, w, s),
                  b = pressed_rate(m, w, pressed_ahead(s, a, h / 2));
    pressed_state c = pressed_rate(m, w, pressed_ahead(s, b, h / 2)),
                  d = pressed_rate(m, w, pressed_ahead(s, c, h));
    return (pressed_state){
        s.x + h / 6 * (a.x + 2 * b.x + 2 * c.x + d.x),
        s.velocity + h / 6 * (a.velocity + 2 * b.velocity + 2 * c.velocity + d.velocity)};
}

// Whether braking with at most `peak` brings the arm to rest.
static bool stops(const pressed_arm_model *m, pressed_state s, double peak)
{
    const way brake = {PRESS_HARD, 0, peak};
    for (double t = 0; t < HORIZON && s.velocity > 0; t += COARSE_STEP) {
        // a force that never again exceeds K x only speeds the arm up
        if (m->spring_force * s.x > peak || force_on(m, &brake, s) > peak * (1 + 1e-9)) {
            return false;
        }
        s = pressed_advance(m, &brake, s, COARSE_STEP);
    }
    return s.velocity <= 0;
}

double best_peak(const pressed_arm_model *m, pressed_state s)
{
    assert(m->mass_force > 0);
    double low = runaway(m, s), high = low;
    if (!(s.velocity > 0 && low > 0)) {
        return (double)NAN;
    }

    // raise the peak until it stops the arm, as the bent beam alone does in the end, then
    // bisect; with the least peak itself the arm would take for ever to stop
    while (!stops(m, s, high) && isfinite(high)) {
        high = 1.5 * high + 1e-3;
    }
    while (high - low > 1e-5 * high) {
        const double middle = (low + high) / 2;
        if (stops(m, s, middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return high;
}

// How far a force is outside the band, negative within [N].
static double beyond_band(const way *band, double force)
{
    return fmax(band->lowest - force, force - band->highest);
}

// Whether the force is in the band and can stay there.
static bool stays(const pressed_arm_model *m, const way *band, pressed_state s)
{
    for (double t = 0; t < HOLDING; t += COARSE_STEP) {
        if (beyond_band(band, force_on(m, band, s)) > 1e-9 * band->highest) {
            return false;
        }
        s = pressed_advance(m, band, s, COARSE_STEP);
    }
    return beyond_band(band, runaway(m, s)) < 1e-6 * band->highest;
}

// The state a little after K xi reaches `edge` within the step from `s` to `next`. *share
// receives the part of the step until then, by linear interpolation, or -1 if K xi does
// not reach the edge.
static pressed_state crossing(const pressed_arm_model *m, const way *on, pressed_state s,
                              pressed_state next, double edge, double *share)
{
    const double before = runaway(m, s) - edge, after = runaway(m, next) - edge;
    if ((before < 0) == (after < 0)) {
        *share = -1;
        return next;
    }
    *share = before / (before - after);
    return pressed_advance(m, on, s, *share * STEP + INSIDE);
}

// The edge of the band that K xi reaches first on a way: hard pressing lowers it from
// above the band, soft pressing raises it from below.
static double near_edge(const way *on, const way *band)
{
    if (on->rule == PRESS_HARD) {
        return band->highest;
    }
    return band->lowest;
}

// Whether a way fails from K xi = `xi` on: the arm leaves the wall, runs away under any
// force up to the peak, or leaves the band on its far side.
static bool is_lost(const way *on, const way *band, double xi, double force)
{
    const bool has_left_wall = xi <= 0;
    const bool runs_away = xi > band->highest && xi >= on->highest;
    if (has_left_wall || runs_away) {
        return true;
    }
    if (on->rule == PRESS_HARD) {
        return xi < band->lowest && force >= xi;
    }
    return xi > band->highest && force <= xi;
}

// The time [s] on a way until the force can stay in the band; NaN if it is not below
// `limit` or the way fails.
static double time_on(const pressed_arm_model *m, const way *on, const way *band,
                      pressed_state s, double limit)
{
    for (double t = 0; t < limit; t += STEP) {
        double xi = runaway(m, s), share;
        if (is_lost(on, band, xi, force_on(m, on, s))) {
            break;
        }
        if (beyond_band(band, xi) <= 0 && stays(m, band, s)) {
            return t;
        }

        // a step on; the force may come to stay from where it reaches the edge within it
        pressed_state next = pressed_advance(m, on, s, STEP);
        pressed_state edge = crossing(m, on, s, next, near_edge(on, band), &share);
        if (share >= 0 && stays(m, band, edge)) {
            return t + share * STEP;
        }
        s = next;
    }
    return (double)NAN;
}

// The least time [s] to the band on one way first and then on another, over all instants
// t at which the ways may change; `best` if none is below that.
static double time_on_both(const pressed_arm_model *m, const way *first,
                           const way *second, const way *band, pressed_state s,
                           double best)
{
    for (double t = 0; t < best; t += STEP) {
        double remaining = time_on(m, second, band, s, best - t), share;
        best = fmin(t + remaining, best);

        if (is_lost(first, band, runaway(m, s), force_on(m, first, s))) {
            break;
        }

        // or change at the edge of the band, which lies within a step
        pressed_state next = pressed_advance(m, first, s, STEP);
        pressed_state edge = crossing(m, first, s, next, near_edge(first, band), &share);
        if (share >= 0) {
            const double edge_time = t + share * STEP;
            remaining = time_on(m, second, band, edge, best - edge_time);
            best = fmin(edge_time + remaining, best);
        }
        s = next;
    }
    return best;
}

double best_settling(const pressed_arm_model *m, pressed_state s, double force,
                     double band, double peak)
{
    assert(m->mass_force > 0 && band > 0);
    const way settled = {PRESS_KEEP, force * (1 - band), force * (1 + band)};
    const double most = fmax(peak, settled.highest);
    const way hard = {PRESS_HARD, 0, most}, soft = {PRESS_SOFT, 0, most};

    // a motor that cannot hold the force never settles there
    double holding = m->stiffness * force / m->spring_force - m->stiction;
    if (!(force > 0) || holding > fmin(m->torque_limit, m->current_torque)) {
        return (double)NAN;
    }

    // the better of both orders of soft and hard pressing
    double best = time_on_both(m, &soft, &hard, &settled, s, HORIZON);
    best = time_on_both(m, &hard, &soft, &settled, s, best);
    if (best < HORIZON) {
        return best;
    }
    return (double)NAN;
}

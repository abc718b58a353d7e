// Predicts the pulse of a touch at this instant. Two links on a rigid hub have a closed
// form.
//
// In contact the arm has one degree of freedom, the hub angle x: the constraint gives the
// second link's angle and, with v = (1, -J_1/J_2), its velocity. With the sweeps of
// chain.h as the exact acceleration a(x, x'), the motion is approximated piecewise by
//
//     y'' = a_s - c (y' - w_s) - k y,        y = x - x_s, w_s = x'_s
//
// whose solution is a damped oscillation in closed form. c = (v'Cv)/(v'Mv) is the damping
// of hub and joint; k starts as the tangent (v'Kv)/(v'Mv) = 4 k2 / (v'Mv) and is
// replaced, piece by piece, by the secant that makes the acceleration exact at the far
// end of the piece too. Three pieces carry the stiffening by large bending. The force is
// then evaluated exactly on the predicted path at four instants before the arm stops, and
// a cubic through them gives peak and delay.
//
// The pulse of any other arm, of one that bends far, and of one damped so strongly that
// the force peaks early, is followed by its engine.
#include "src/predict/linearised.h"

#include <assert.h>
#include <math.h>

#include "src/arm/chain.h"
#include "src/arm/chain_pair.h"
#include "src/arm/impact.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"
#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"

enum { PIECES = 3 };

// Largest bend for which the closed form is used: its three pieces are then 1 % off at
// worst [rad].
#define CLOSED_FORM_BEND 0.6

// Largest damping, over critical damping, for which the closed form is used: with more
// the arm stops late, far from where the pieces are fitted.
#define MOST_DAMPED 0.5

// The peak is known if between SETTLED_FROM times the horizon and the horizon it grows by
// no more than SETTLED times itself.
#define SETTLED_FROM 0.8
#define SETTLED      5e-4

// The energies are sampled every LOOK_PHASE [rad] of the fastest vibration, within these
// intervals [s].
#define LONGEST_LOOK  1e-4
#define SHORTEST_LOOK 3e-5
#define LOOK_PHASE    0.1

#define COMMAND_DUE   1e-12 // share of its instant by which a command may be early

enum { MOST_STEPS = 60000 };

// --- any arm, by its engine ------------------------------------------------------------

arm arm_touching_now(const arm *a, const double *q)
{
    arm touched = *a;
    double x, y;

    // a point moves across the last link onto its line, a flat wall turns to the tip
    if (a->wall.kind == WALL_POINT) {
        double t_x = -inline_sin(q[a->dof - 1]), t_y = inline_cos(q[a->dof - 1]);
        chain_node(a, q, a->links - 1, &x, &y);
        double across = t_x * (a->wall.x - x) + t_y * (a->wall.y - y);
        touched.wall.x -= across * t_x;
        touched.wall.y -= across * t_y;
    } else {
        chain_node(a, q, a->links, &x, &y);
        double distance = sqrt(x * x + y * y);
        touched.wall.cosine = x / distance;
        touched.wall.sine = y / distance;
    }
    return touched;
}

// The energies of a pulse: the last three samples, and those where the strain energy was
// largest.
typedef struct seen_energies {
    double time[3]; // [s]
    state_energy at[3];
    state_energy most;
} seen_energies;

// The parabola f + slope x + bend x^2 through values at x[0] < 0, at 0 and at x[1].
static void fit_parabola(const double x[2], double before, double f, double after,
                         double *slope, double *bend)
{
    const double first = (before - f) / x[0], second = (after - f) / x[1];
    *bend = (second - first) / (x[1] - x[0]);
    *slope = first - *bend * x[0];
}

// Samples the energies. A maximum of the strain energy between samples is the top of the
// parabola through three of them, f - slope^2/(4 bend).
static void see_energies(const arm *a, motion *m, seen_energies *seen)
{
    state_energy *at = seen->at;
    for (int i = 0; i < 2; i++) {
        seen->time[i] = seen->time[i + 1];
        at[i] = at[i + 1];
    }
    seen->time[2] = m->state[SLOT_TIME];
    at[2] = motion_energy(a, m, m->state);
    if (at[2].strain > seen->most.strain) {
        seen->most = at[2];
    }

    const double x[] = {seen->time[0] - seen->time[1], seen->time[2] - seen->time[1]};
    if (x[0] < 0 && x[1] > 0 && at[1].strain > at[0].strain &&
        at[1].strain > at[2].strain) {
        double slope, bend, kinetic_slope, kinetic_bend;
        fit_parabola(x, at[0].strain, at[1].strain, at[2].strain, &slope, &bend);
        fit_parabola(x, at[0].kinetic, at[1].kinetic, at[2].kinetic, &kinetic_slope,
                     &kinetic_bend);
        const double top = -slope / (2 * bend); // time from the middle sample to it [s]
        const double strain = at[1].strain + slope / 2 * top;
        const double kinetic = at[1].kinetic + top * (kinetic_slope + kinetic_bend * top);
        if (strain > seen->most.strain) {
            seen->most = (state_energy){kinetic, strain};
        }
    }
}

// Puts the commands into effect that are due; returns when the next one is [s].
static double give_commands(arm *a, motion *m, const voltage_profile *command, int *next)
{
    const double now = m->state[SLOT_TIME];
    while (*next < command->count && command->times[*next] <= now * (1 + COMMAND_DUE)) {
        const double before = a->motor.torque;
        arm_set_voltage(a, command->volts[(*next)++]);
        motion_retorque(a, m, before);
    }
    if (*next < command->count) {
        return command->times[*next];
    }
    return HUGE_VAL;
}

// Starts the motion at the touch and takes it through the impact. Returns whether the arm
// stays in contact.
static bool begin_touch(const arm *a, motion *m, const double *q, const double *w,
                        double present_current, prediction *out)
{
    const double limit = a->motor.current_limit > 0 ? a->motor.current_limit : HUGE_VAL;
    const double current = a->motor.inductance > 0 ? present_current : 0;
    motion_report report = {.event = m->wall_gives ? MOTION_TOUCH : MOTION_IMPACT};
    motion_start_at(a, m, q, w, fmax(-limit, fmin(current, limit)));
    if (m->state[SLOT_CONTACT] == 0) {
        motion_apply(a, m, &report);
    }
    out->impulse = report.impulse;
    motion_reset_peak(m);
    return m->state[SLOT_CONTACT] != 0;
}

// Follows the arm until it leaves the wall, to the horizon, or for the most steps
// allowed. Unless it leaves, the pulse is doubtful if its peak is not settled.
static status follow_pulse(arm *a, motion *m, const voltage_profile *command,
                           seen_energies *seen, prediction *out)
{
    const double settled = SETTLED_FROM * PULSE_HORIZON;
    double settled_peak = 0; // the peak at that instant [N]
    int next = 0, steps = 0;
    while (m->state[SLOT_TIME] < PULSE_HORIZON) {
        // up to the next command, sample of the energies, or look at the peak
        double until = fmin(give_commands(a, m, command, &next), PULSE_HORIZON);
        if (seen != NULL) {
            see_energies(a, m, seen);
            const double look = LOOK_PHASE / motion_vibration(a, m, m->state);
            until = fmin(until, m->state[SLOT_TIME] +
                                    fmax(fmin(look, LONGEST_LOOK), SHORTEST_LOOK));
        }
        if (m->state[SLOT_TIME] <= settled) {
            settled_peak = m->record.pulse_peak;
            if (m->state[SLOT_TIME] < settled) {
                until = fmin(until, settled);
            }
        }

        // a step, and the event at its end; a command may end the contact, too
        motion_report report;
        if (m->state[SLOT_CONTACT] != 0) {
            TRY(motion_step(a, m, until, m->nominal_step, &report));
            motion_apply(a, m, &report);
        }
        if (m->state[SLOT_CONTACT] == 0) {
            return STATUS_OK;
        }
        if (steps++ == MOST_STEPS) {
            break;
        }
    }

    // a force that still rises has its peak beyond the horizon
    const double growth = m->record.pulse_peak - settled_peak;
    const bool rises = growth > SETTLED * m->record.pulse_peak;
    out->doubtful = rises || steps > MOST_STEPS;
    return STATUS_OK;
}

status predict_pulse(const arm *source, const method_parameters *method, const double *q,
                     const double *w, const voltage_profile *command, bool energies,
                     prediction *out)
{
    assert(command == NULL || command->count == 0 || (command->times && command->volts));
    *out = prediction_none();
    if (!wall_stands(&source->wall)) {
        return STATUS_OK;
    }
    const voltage_profile given = command != NULL ? *command : (voltage_profile){0};
    arm a = arm_touching_now(source, q);
    method_parameters event = *method;
    event.name = METHOD_EVENT;
    motion *m = motion_create(&a, &event);
    if (m == NULL) {
        return STATUS_NO_MEMORY;
    }

    // force and delay only of a pulse that holds and was followed to its peak
    seen_energies seen = {0};
    const bool held = begin_touch(&a, m, q, w, given.current, out);
    status s = STATUS_OK;
    if (held) {
        s = follow_pulse(&a, m, &given, energies ? &seen : NULL, out);
    }
    out->holds = held && s == STATUS_OK && !out->doubtful;
    if (out->holds) {
        out->force = m->record.pulse_peak;
        out->delay = m->record.pulse_peak_time;
    }

    // e_eq: the kinetic energy gained from the largest strain to the release, over that
    // strain's energy
    if (out->holds && energies && m->state[SLOT_CONTACT] == 0) {
        see_energies(&a, m, &seen);
        const double at_release = motion_energy(&a, m, m->state).kinetic;
        out->restitution = (double)NAN;
        if (seen.most.strain > 0) {
            out->restitution = (at_release - seen.most.kinetic) / seen.most.strain;
        }
    }
    motion_destroy(m);
    return s;
}

// --- two links on a rigid hub ----------------------------------------------------------

// A damped oscillation y(t) with y(0) = 0.
typedef struct oscillation {
    double rest;      // where it would settle [rad]
    double decay;     // c / 2 [1/s]
    double frequency; // root of k - c^2/4 [rad/s]
    double sine;      // coefficient of the sine [rad]
} oscillation;

// The oscillation y'' = a - c (y' - v) - k y that starts at y = 0 with the velocity v and
// the acceleration a. False if it is damped by more than MOST_DAMPED.
static bool oscillation_from(double acceleration, double velocity, double c, double k,
                             oscillation *o)
{
    if (!(c * c < 4 * MOST_DAMPED * MOST_DAMPED * k)) {
        return false;
    }
    o->decay = c / 2;
    o->frequency = sqrt(k - c * c / 4);
    o->rest = (acceleration + c * velocity) / k;
    o->sine = (velocity - o->decay * o->rest) / o->frequency;
    return true;
}

static void oscillation_at(const oscillation *o, double t, double *y, double *velocity)
{
    double c, s, decay = plain_exp(-o->decay * t);
    inline_sincos(o->frequency * t, &s, &c);
    *y = o->rest + decay * (o->sine * s - o->rest * c);
    *velocity = decay * (o->sine * (o->frequency * c - o->decay * s) +
                         o->rest * (o->frequency * s + o->decay * c));
}

// First instant at which the oscillation comes to rest, its velocity being positive at 0.
static double oscillation_stop(const oscillation *o)
{
    // velocity = decay(t) (p c + q s), which vanishes where tan(f t) = -p/q
    const double p = o->sine * o->frequency + o->rest * o->decay;
    const double q = o->frequency * o->rest - o->sine * o->decay;
    const double angle = plain_atan2(p, -q);
    return (angle > 0 ? angle : angle + M_PI) / o->frequency;
}

// One degree of freedom of the arm on the wall.
typedef struct pressed_arm {
    const arm *a;
    chain_link links[2];
    contact_state mode;
    double force, acceleration; // at the state last evaluated
    double bend;                // there [rad]
} pressed_arm;

// Exact acceleration and force with the hub at x moving at v.
static void pressed_evaluate(pressed_arm *p, double x, double v)
{
    const arm *a = p->a;
    double l = a->link_length, q[2] = {x, 0}, w[2], alpha[2], cx, sx;
    double turn; // of the second link back, for one of the first
    chain_reaction r;

    // the constraint: angle and velocity of the second link
    inline_sincos(x, &sx, &cx);
    if (a->wall.kind == WALL_POINT) {
        // the second link points from the joint to the contact point, (3.9)
        double dx = a->wall.x - l * cx, dy = a->wall.y - l * sx,
               d = sqrt(dx * dx + dy * dy);
        q[1] = plain_atan2(dy, dx);
        turn = l * (cx * dx + sx * dy) / d / d; // (3.12)
    } else {
        // both links lean away from the wall alike
        q[1] = 2 * plain_atan2(a->wall.sine, a->wall.cosine) - x;
        turn = 1;
    }
    w[0] = v;
    w[1] = -turn * v;

    // the equations of motion there
    chain_accelerations(a, p->links, q, w, p->mode, alpha, &r);
    p->force = r.force;
    p->acceleration = alpha[0];
    p->bend = q[1] - q[0];
}

// The damping c = (v'Cv)/(v'Mv) and the stiffness k = (v'Kv)/(v'Mv) at the touch, v = (1,
// ratio) being the direction in which the constraint lets both links move.
static void pressed_tangents(const arm *a, const double *q, double *c, double *k)
{
    double l = a->link_length, m = a->link_mass, unit[2][2] = {{1, 0}, {0, 1}};
    double ratio =
        -chain_penetration_rate(a, q, unit[0]) / chain_penetration_rate(a, q, unit[1]);
    double own = a->link_inertia + m * l * l / 4, bend = ratio - 1;
    double mass = a->hub_inertia + own + m * l * l + own * ratio * ratio +
                  m * l * l * inline_cos(q[1] - q[0]) * ratio;
    *c = (a->motor.damping + a->joint_damping * bend * bend) / mass;
    *k = a->joint_stiffness * bend * bend / mass;
}

// The predicted path in contact: oscillations one after another.
typedef struct pressed_path {
    oscillation piece[PIECES];
    double start[PIECES]; // when each begins [s]
    double angle[PIECES]; // hub angle there [rad]
    double stop;          // when the arm comes to rest [s]
} pressed_path;

// Force at an instant of the path, evaluated exactly for the predicted state.
static double path_force(pressed_arm *p, const pressed_path *path, double t)
{
    int i = PIECES - 1;
    double y, velocity;
    while (i > 0 && t < path->start[i]) {
        i--;
    }
    oscillation_at(&path->piece[i], t - path->start[i], &y, &velocity);
    pressed_evaluate(p, path->angle[i] + y, velocity);
    return p->force;
}

// Follows the arm from the hub at x moving at v, towards the wall, until it comes to
// rest. False if damping lets it creep there.
static bool predict_path(pressed_arm *p, double x, double v, double c, double k,
                         pressed_path *path)
{
    double t = 0, acceleration = p->acceleration;
    for (int i = 0; i < PIECES; i++) {
        double y, velocity, length;
        oscillation *o = &path->piece[i];
        if (i > 0) {
            pressed_evaluate(p, x, v);
            acceleration = p->acceleration;
        }

        // a first guess of the piece, an even share of what is left of the way
        if (!oscillation_from(acceleration, v, c, k, o)) {
            return false;
        }
        length = oscillation_stop(o) / (PIECES - i);
        oscillation_at(o, length, &y, &velocity);
        pressed_evaluate(p, x + y, velocity);

        // the stiffness that makes the acceleration exact at its far end too
        double secant = (acceleration - c * (velocity - v) - p->acceleration) / y;
        if (y > 0 && secant > 0) {
            k = secant;
            if (!oscillation_from(acceleration, v, c, k, o)) {
                return false;
            }
        }

        // the piece, and the state at its end
        path->start[i] = t;
        path->angle[i] = x;
        path->stop = t + oscillation_stop(o);
        if (i == PIECES - 1) {
            length = path->stop - t;
        } else {
            length = fmin(length, path->stop - t);
        }
        oscillation_at(o, length, &y, &velocity);
        x += y;
        v = velocity;
        t += length;
    }
    return true;
}

// The force peaks a little before the arm stops: a parabola through three instants there
// finds where, and a cubic through these and a fourth look says how large and when. False
// if it peaks earlier, as it does under strong damping, whose force jumps up at the
// touch: `first` is that.
static bool path_peak(pressed_arm *p, const pressed_path *path, double first,
                      prediction *out)
{
    // three instants before the stop, and the top of their parabola
    const double h = 0.08 * path->stop, middle = path->stop - h;
    double t = middle, f[4];
    for (int i = 0; i < 3; i++) {
        f[i] = path_force(p, path, path->stop - (2 - i) * h);
    }
    const double second = f[0] - 2 * f[1] + f[2], slope_there = (f[2] - f[0]) / 2;
    if (second < 0) {
        t += fmin(fmax(-slope_there / second, -1), 1) * h;
    }
    f[3] = path_force(p, path, t);

    // Newton's form on s = (time - middle) / h with nodes -1, 0, 1 and s3
    const double s3 = (t - middle) / h;
    const double d1 = f[1] - f[0], d2 = (f[2] - 2 * f[1] + f[0]) / 2;
    const double spread = (s3 + 1) * s3 * (s3 - 1);
    double d3 = 0;
    if (fabs(spread) > 1e-6) {
        d3 = (f[3] - f[0] - d1 * (s3 + 1) - d2 * (s3 + 1) * s3) / spread;
    }

    // Newton's iteration for the cubic's top
    double s = s3;
    for (int i = 0; i < 3; i++) {
        const double slope = d1 + d2 * (2 * s + 1) + d3 * (3 * s * s - 1);
        const double bend = 2 * d2 + 6 * d3 * s;
        if (bend < 0) {
            s = fmin(fmax(s - slope / bend, -1), 1);
        }
    }

    const double top = f[0] + (s + 1) * (d1 + s * (d2 + (s - 1) * d3));
    out->force = top;
    out->delay = middle + s * h;
    return d2 < 0 && s > -1 && top > first;
}

// --- the touch -------------------------------------------------------------------------

// Finds the velocities just after the plastic impact of two links on a rigid wall, and
// the impulse. Returns whether the arm then stays: no restitution, and a force above 0.
static bool touch_holds(const arm *touched, const double *q, const double *w,
                        double after[2], contact_state *mode, double *impulse)
{
    chain_link links[2];
    chain_reaction r;
    const impact_result jump =
        impact_velocity_increments(touched, links, q, w, 0, 0, after);
    const double e = wall_restitution(&touched->wall, jump.speed);
    *impulse = (1 + e) * fmax(jump.impulse, 0);
    for (int i = 0; i < 2; i++) {
        const double jump_of_rate = *impulse > 0 ? after[i] : 0;
        after[i] = w[i] + jump_of_rate;
    }

    // an elastic impact throws the arm back
    mode->contact = true;
    if (after[0] < 0) {
        mode->friction = HUB_BACKWARD;
    } else {
        mode->friction = HUB_FORWARD;
    }
    if (jump.impulse < 0 || e > 0) {
        return false;
    }
    double alpha[2];
    chain_accelerations(touched, links, q, after, *mode, alpha, &r);
    return r.force > 0;
}

// False if the arm bends further than the few pieces of the closed form are good for, if
// the force peaks long before the arm stops, or if so much damping is on the way that it
// stops late.
static bool predict_closed_form(const arm *touched, const double *q, const double *after,
                                contact_state mode, prediction *out)
{
    pressed_arm p = {.a = touched, .mode = mode};
    pressed_path path;
    double c, k;
    pressed_evaluate(&p, q[0], after[0]);
    const double first = p.force;

    // the path, and the force along its end, where the arm is bent the most
    pressed_tangents(touched, q, &c, &k);
    return predict_path(&p, q[0], after[0], c, k, &path) &&
           path_peak(&p, &path, first, out) && fabs(p.bend) < CLOSED_FORM_BEND;
}

status predict_linearised(const arm *a, const method_parameters *method, const double *q,
                          const double *w, prediction *out)
{
    assert(a->motor.inductance == 0);
    if (pair_suits(a)) {
        // two links on a rigid hub that turns on towards the wall: the closed form
        const arm touched = arm_touching_now(a, q);
        double after[2];
        contact_state mode = {.current = 0};
        *out = prediction_none();
        out->holds = touch_holds(&touched, q, w, after, &mode, &out->impulse);
        if (!out->holds ||
            (after[0] > 0 && predict_closed_form(&touched, q, after, mode, out))) {
            return STATUS_OK;
        }
    }
    const bool energies = false;
    return predict_pulse(a, method, q, w, NULL, energies, out);
}

// The sweeps of chain.h as inline functions, so that the two-link arm, whose loops the compiler can
// unroll, and the chain of any length share one source.
#pragma once

#include <math.h>

#include "src/arm/chain_link.h"
#include "src/base/sincos.h"

#define KERNEL static inline __attribute__((always_inline))

// Whether the chain is more than a plain one, or its tip may feel a force that its place and
// velocity say before any acceleration is known.
static inline bool chain_is_loaded(const arm *a)
{
    return !arm_is_plain(a) || wall_gives(&a->wall);
}

// Sums of the rows of the modal damping, g'(bend rates), into sums[damped_modes] [N m s^(1/2)]; the
// torques are g times them. Returns the power lost [W].
static inline double chain_modal_rates(const arm *a, const double *w, double *sums)
{
    double power = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        sums[i] = 0;
        for (int k = a->first > 0 ? 0 : 1; k < a->links; k++) {
            sums[i] += a->modal_damping[i][k] * (w[a->first + k] - w[a->first + k - 1]);
        }
        power += sums[i] * sums[i];
    }
    return power;
}
static inline double chain_modal_torque(const arm *a, const double *sums, int k)
{
    double torque = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        torque += a->modal_damping[i][k] * sums[i];
    }
    return torque;
}

// What a sweep is of. All but `stuck` follow from compile-time constants where the caller's N,
// hub_spring, contact and loaded are such.
typedef struct chain_case {
    int N;
    bool hub_spring, contact, loaded, uneven, drags;
    bool gives, face;      // the wall gives; its face has a mass
    bool constrained;      // contact ties the tip to wall or face
    bool wanted;           // the last link's base and its velocity are
    bool held;             // a single link on a rigid hub by the wall alone; friction has no say
    bool stuck;            // the hub by friction
    const double *theta;   // angles of the links [rad]
    const double *omega;   // [rad/s]
    double l_last, vx, vy; // length of the last link [m], velocity of its base [m/s]
    double pressed;        // force of a wall that gives [N]
    double held_back;      // and of the spring behind a face with a mass [N]
    double damping_power, wall_power; // lost [W]
} chain_case;

// Directions of the links, place and velocity of the last one's base, and how the wall meets it.
KERNEL wall_contact chain_reach_wall(const arm *a, chain_case *c, chain_link *link)
{
    double x = 0, y = 0, vx = 0, vy = 0;
    for (int k = 0; k < c->N; k++) {
        const double l = c->uneven ? a->each.length[k] : a->link_length;
        inline_sincos(c->theta[k], &link[k].s, &link[k].c);
        if (c->wanted && k < c->N - 1) {
            x += l * link[k].c;
            y += l * link[k].s;
            vx -= l * link[k].s * c->omega[k];
            vy += l * link[k].c * c->omega[k];
        }
    }
    const chain_link *last = &link[c->N - 1];
    c->l_last = c->uneven ? a->each.length[c->N - 1] : a->link_length;
    c->vx = vx;
    c->vy = vy;
    wall_contact wall = {0};
    if (c->wanted && wall_stands(&a->wall)) {
        wall = wall_contact_at(&a->wall, c->l_last, x, y, vx, vy, last->c, last->s,
                               c->omega[c->N - 1]);
    }
    return wall;
}

// The answer of a wall that gives to place and velocity; of one with a mass that of its spring.
KERNEL void chain_press(const arm *a, chain_case *c, const wall_contact *wall,
                        const chain_link *last)
{
    const double lever = wall_last_lever(wall, c->l_last, last->c, last->s);
    const double depth = wall->penetration;
    const double rate = wall_penetration_rate(wall, c->vx, c->vy, lever, c->omega[c->N - 1]) +
                        wall_comes(&a->wall, wall->ex, wall->ey);
    if (c->face) {
        c->held_back = wall_force(&a->wall, depth, rate);
        c->wall_power = a->wall.damping * rate * rate;
    } else {
        c->pressed = wall_force(&a->wall, depth, rate);
        // a step tries Kelvin-Voigt's law in front of the wall, too, and loses nothing there
        const bool damper = a->wall.law == WALL_KELVIN_VOIGT;
        c->wall_power = damper ? a->wall.damping * rate * rate
                               : (c->pressed - wall_spring_force(&a->wall, depth)) * rate;
    }
}

// The links from one on to the tip, whose accelerations have been eliminated.
typedef struct chain_beyond {
    double pxx, pxy, pyy;        // P: mass that they show
    double qx, qy;               // Q of velocity and springs
    double ux2, uy2;             // Q of a unit contact force
    double outer;                // torque of the joint before them
    double root_free, root_unit; // moments on the first link before division
    double end_x, end_y;         // velocity of the next link's end, where air drags
} chain_beyond;

// Moment of the air on link k, its force into *x and *y.
KERNEL double chain_drag(const arm *a, chain_case *c, const chain_link *link, int k, double l,
                         chain_beyond *b, double *x, double *y)
{
    const double cosine = link[k].c, sine = link[k].s, half = 0.5 * l, turn = l * c->omega[k];
    const double turning = a->air_drag * l * l * l / 12 * c->omega[k];
    *x = a->air_drag * l * (b->end_x + half * sine * c->omega[k]);
    *y = a->air_drag * l * (b->end_y - half * cosine * c->omega[k]);
    c->damping_power += (*x * *x + *y * *y) / (a->air_drag * l) + turning * c->omega[k];
    b->end_x += sine * turn;
    b->end_y -= cosine * turn;
    return half * (cosine * *y - sine * *x) + turning;
}

// Torque of the joint before link k, of the hub before the first one.
KERNEL double chain_inner_torque(const arm *a, chain_case *c, const double *modal, double hub,
                                 double hub_joint, int k)
{
    if (k == 0) {
        return c->hub_spring ? hub_joint : -hub;
    }
    const double kj = c->uneven ? a->each.stiffness[k] : a->joint_stiffness;
    const double cj = c->uneven ? a->each.damping[k] : a->joint_damping;
    const double rate = c->omega[k] - c->omega[k - 1], bend = c->theta[k] - c->theta[k - 1];
    double torque = kj * bend + cj * rate;
    c->damping_power += cj * rate * rate;
    if (c->loaded) {
        torque += arm_stiffening_torque(a, k, bend) + chain_modal_torque(a, modal, k);
    }
    return torque;
}

// Eliminates the acceleration of link k, `inner` being the torque of the joint before it.
KERNEL void chain_eliminate(const arm *a, chain_case *c, const wall_contact *wall, chain_link *link,
                            int k, double inner, chain_beyond *b)
{
    const bool tip = k == c->N - 1, bare = tip && !c->loaded;
    const double l = c->uneven ? a->each.length[k] : a->link_length, half = 0.5 * l;
    const double m = c->uneven ? a->each.mass[k] : a->link_mass;
    const double own = (c->uneven ? a->each.inertia[k] : a->link_inertia) + m * half * half;
    const double cosine = link[k].c, sine = link[k].s, w2 = c->omega[k] * c->omega[k];
    double ux = -m * half * sine, uy = m * half * cosine, d = own, fx = 0, fy = 0;
    if (!bare) {
        const double ptx = -b->pxx * sine + b->pxy * cosine; // P t
        const double pty = -b->pxy * sine + b->pyy * cosine;
        const double prx = b->pxx * cosine + b->pxy * sine; // P r
        const double pry = b->pxy * cosine + b->pyy * sine;
        ux += l * ptx;
        uy += l * pty;
        d += l * l * (cosine * pty - sine * ptx);
        fx = b->qx - l * w2 * prx;
        fy = b->qy - l * w2 * pry;
    }

    // the moments on it
    const double torque = b->outer - inner;
    b->outer = inner;
    if (k == 0 && !c->hub_spring) {
        d += a->hub_inertia;
    }
    double moment = bare ? torque : torque - l * (cosine * fy - sine * fx);
    double moment2 = 0, drag_x = 0, drag_y = 0;
    if (c->loaded) {
        moment -= (tip ? c->pressed * wall->lever : 0) + half * m * a->gravity * cosine;
    }
    if (c->drags) {
        moment -= chain_drag(a, c, link, k, l, b, &drag_x, &drag_y);
    }
    if (c->constrained) {
        moment2 = -l * (cosine * b->uy2 - sine * b->ux2) - (tip ? wall->lever : 0);
    }
    if (k == 0) {
        b->root_free = moment;
        b->root_unit = moment2;
        if (!c->hub_spring && c->stuck) {
            moment = moment2 = 0; // a stuck hub has no acceleration
        }
    }

    const double inv_d = 1 / d;
    link[k].inv_d = inv_d;
    link[k].ux = ux;
    link[k].uy = uy;
    link[k].free = moment * inv_d;
    if (c->constrained) {
        link[k].unit = moment2 * inv_d;
    }
    if (k == 0) {
        return;
    }

    // what it and those beyond show to the one before
    b->qx = fx - m * half * w2 * cosine + ux * link[k].free;
    b->qy = fy - m * half * w2 * sine + uy * link[k].free;
    if (c->loaded) {
        b->qy += m * a->gravity;
    }
    if (c->drags) {
        b->qx += drag_x;
        b->qy += drag_y;
    }
    if (c->constrained) {
        b->ux2 += ux * link[k].unit;
        b->uy2 += uy * link[k].unit;
    }
    b->pxx = (bare ? m : b->pxx + m) - ux * ux * inv_d;
    b->pxy = (bare ? 0 : b->pxy) - ux * uy * inv_d;
    b->pyy = (bare ? m : b->pyy + m) - uy * uy * inv_d;
}

// Accelerations of the last link's base, free and for a unit force.
typedef struct chain_base {
    double ax, ay, bx, by;
} chain_base;

// From hub to tip: the links' accelerations, into link[].unit those of a unit force.
KERNEL chain_base chain_substitute(const arm *a, const chain_case *c, chain_link *link, double *out)
{
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k < c->N; k++) {
        const double cosine = link[k].c, sine = link[k].s;
        out[k] = link[k].free;
        if (k > 0) { // the first link's base rests
            out[k] -= (link[k].ux * ax + link[k].uy * ay) * link[k].inv_d;
        }
        if (c->constrained && k > 0) {
            link[k].unit -= (link[k].ux * bx + link[k].uy * by) * link[k].inv_d;
        }
        if (k < c->N - 1) {
            const double l = c->uneven ? a->each.length[k] : a->link_length;
            const double w2 = c->omega[k] * c->omega[k];
            ax -= l * (sine * out[k] + cosine * w2);
            ay += l * (cosine * out[k] - sine * w2);
            if (c->constrained) {
                bx -= l * sine * link[k].unit;
                by += l * cosine * link[k].unit;
            }
        }
    }
    return (chain_base){ax, ay, bx, by};
}

// The force that d2g/dt2 = 0 gives, or what a face with a mass needs to go along, and what it makes
// of the accelerations; reactions of the wall.
KERNEL double chain_close(const arm *a, const chain_case *c, const wall_contact *wall,
                          const chain_link *link, chain_base base, bool gap, double *out,
                          chain_reaction *reaction)
{
    double last = 0, rate2 = 0, force = c->pressed; // J_N, d2g/dt2
    const int N = c->N;
    if (c->wanted) {
        last = wall_last_lever(wall, c->l_last, link[N - 1].c, link[N - 1].s);
        rate2 = wall->ex * base.ax + wall->ey * base.ay + last * out[N - 1] + wall->convective;
    }
    const double comes = c->loaded ? wall_comes(&a->wall, wall->ex, wall->ey) : 0;
    const double comes_faster = c->loaded ? wall_comes_faster(&a->wall, wall->ex, wall->ey) : 0;
    rate2 += c->face ? 0 : comes_faster; // the mass of a face feels the acceleration in space
    if (c->constrained) {
        const double yields = wall->ex * base.bx + wall->ey * base.by + last * link[N - 1].unit;
        force = -rate2 / yields;
        if (c->face) {
            const double mass = a->wall.face_mass;
            force = (mass * rate2 + c->held_back) / (1 - mass * yields);
        }
        for (int k = 0; k < N; k++) {
            out[k] += force * link[k].unit;
        }
        rate2 = c->face ? rate2 + force * yields : 0;
    }
    rate2 += c->face ? comes_faster : 0;
    reaction->force = force;
    reaction->wall_work = (c->face ? c->held_back : force) * comes; // a face's foundation works
    if (gap) {
        reaction->gap_acceleration = -rate2;
        reaction->gap = wall_stands(&a->wall) ? -wall->penetration : HUGE_VAL;
        reaction->gap_velocity =
            -(wall_penetration_rate(wall, c->vx, c->vy, last, c->omega[N - 1]) + comes);
    }
    return force;
}

// Accelerations under `mode`; N, hub_spring, contact (which is mode.contact) and loaded
// (chain_is_loaded) are passed apart so that they can be compile-time constants. Without `gap` the
// reaction's gap and its derivatives are left out in free flight. The derivation stands in chain.h.
KERNEL void chain_sweep_loaded(const arm *a, int N, bool hub_spring, bool contact, bool loaded,
                               bool gap, chain_link *link, const double *q, const double *w,
                               contact_state mode, double *alpha, chain_reaction *reaction)
{
    chain_case c = {.N = N, .hub_spring = hub_spring, .contact = contact, .loaded = loaded};
    const int first = hub_spring ? 1 : 0;
    c.uneven = loaded && a->uneven;
    c.drags = loaded && a->air_drag > 0;
    c.gives = loaded && wall_gives(&a->wall) && wall_stands(&a->wall);
    c.face = c.gives && wall_has_face(&a->wall);
    c.constrained = contact && (!c.gives || c.face);
    c.wanted = contact || gap || c.gives || c.drags;
    c.held = c.constrained && !c.face && N == 1 && !hub_spring;
    c.stuck = mode.friction == HUB_STICK && !c.held;
    c.theta = q + first;
    c.omega = w + first;
    const wall_contact wall = chain_reach_wall(a, &c, link);
    if (c.gives && mode.contact) {
        chain_press(a, &c, &wall, &link[N - 1]);
    }

    // motor, damping and sliding friction at the hub
    const double sliding = c.held ? 0 : -mode.friction * a->motor.stiction;
    double hub = a->motor.torque - a->motor.damping * w[0] + sliding;
    double motor_torque = 0;
    if (loaded && a->motor.electric) {
        motor_torque = a->motor.torque_constant * motor_current(&a->motor, mode.current, w[0]);
        hub += motor_torque;
    }
    double hub_joint = 0, modal[PARAMETER_MODES_MOST];
    if (loaded) {
        c.damping_power = chain_modal_rates(a, w, modal);
    }
    if (hub_spring) {
        double rate = c.omega[0] - w[0], bend = c.theta[0] - q[0];
        hub_joint = a->hub_stiffness * bend + a->hub_joint_damping * rate;
        c.damping_power += a->hub_joint_damping * rate * rate;
        if (loaded) {
            hub_joint += arm_stiffening_torque(a, 0, bend) + chain_modal_torque(a, modal, 0);
        }
        hub += hub_joint;
    }

    // tip to hub: eliminate each link's acceleration
    chain_beyond b = {.ux2 = wall.ex, .uy2 = wall.ey};
    if (loaded) {
        b.pxx = b.pyy = a->tip_mass;
        b.qx = c.pressed * wall.ex;
        b.qy = c.pressed * wall.ey + a->tip_mass * a->gravity;
    }
    if (c.drags) {
        b.end_x = c.vx - c.l_last * link[N - 1].s * c.omega[N - 1];
        b.end_y = c.vy + c.l_last * link[N - 1].c * c.omega[N - 1];
    }
    for (int k = N - 1; k >= 0; k--) {
        const double inner = chain_inner_torque(a, &c, modal, hub, hub_joint, k);
        chain_eliminate(a, &c, &wall, link, k, inner, &b);
    }

    // hub to tip: accelerations with and without the unit force, and the force
    const chain_base base = chain_substitute(a, &c, link, alpha + first);
    const double force = chain_close(a, &c, &wall, link, base, gap, alpha + first, reaction);
    reaction->friction = sliding;
    if (hub_spring) {
        alpha[0] = hub / a->hub_inertia;
        if (c.stuck) {
            reaction->friction = -hub;
            alpha[0] = 0;
        }
    } else if (c.stuck) {
        reaction->friction = -(b.root_free + force * b.root_unit);
    }
    reaction->viscous_power = a->motor.damping * w[0] * w[0];
    reaction->damping_power = c.damping_power;
    reaction->wall_power = c.wall_power;
    reaction->motor_torque = motor_torque;
}

// The same for equal bare links, on a rigid wall.
KERNEL void chain_sweep(const arm *a, int N, bool hub_spring, bool contact, bool gap,
                        chain_link *link, const double *q, const double *w, contact_state mode,
                        double *alpha, chain_reaction *reaction)
{
    chain_sweep_loaded(a, N, hub_spring, contact, false, gap, link, q, w, mode, alpha, reaction);
}

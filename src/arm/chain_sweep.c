// Accelerations of the chain by two sweeps; the derivation stands in chain.h. Two plain
// links have a closed form (chain_pair.h).
#include "src/arm/chain.h"

#include <math.h>

#include "src/arm/chain_pair.h"
#include "src/arm/forces.h"
#include "src/base/sincos.h"

// Computes the forces of modal damping, sizes[damped_modes]: mode i brings the torque
// modal_damping[i][k] sizes[i] to joint k. Returns the power lost [W].
static double shape_sizes(const arm *a, const double *w, double *sizes)
{
    double lost = 0;
    for (int i = 0; i < a->damped_modes; i++) {
        double rate = 0;
        for (int k = a->first > 0 ? 0 : 1; k < a->links; k++) {
            rate += a->modal_damping[i][k] * (w[a->first + k] - w[a->first + k - 1]);
        }
        const shape_force f = shape_forces(rate);
        sizes[i] = f.size;
        lost += f.lost;
    }
    return lost;
}

// The arm, state and forces of one evaluation of the accelerations.
typedef struct sweep {
    const arm *a;
    chain_link *link;
    bool face;             // the wall that is touched has a face with a mass
    bool constrained;      // contact ties the tip to wall or face
    bool stuck;            // the hub by friction
    const double *theta;   // angles of the links [rad]
    const double *omega;   // [rad/s]
    wall_contact wall;     // how the wall meets the last link
    double l_last, vx, vy; // length of the last link [m], velocity of its base [m/s]
    double pressed;        // force of a wall that gives [N]
    double held_back;      // and of the spring behind a face with a mass [N]
    double along;          // force along the wall [N]
    double hub_joint; // torque of the joint before the first link, else less the motor's
                      // [N m]
    const double *shape;              // sizes of the forces on shapes
    double damping_power, wall_power; // lost [W]
} sweep;

// Computes the directions of the links, the place and velocity of the last link's base,
// and how the wall meets that link.
KERNEL void reach_wall(sweep *c)
{
    const arm *a = c->a;
    const int last = a->links - 1;
    double x = 0, y = 0;
    for (int k = 0; k <= last; k++) {
        const double l = arm_link_of(a, k).length;
        inline_sincos(c->theta[k], &c->link[k].s, &c->link[k].c);
        if (k < last) {
            x += l * c->link[k].c;
            y += l * c->link[k].s;
            c->vx -= l * c->link[k].s * c->omega[k];
            c->vy += l * c->link[k].c * c->omega[k];
        }
    }
    c->l_last = arm_link_of(a, last).length;
    if (wall_stands(&a->wall)) {
        c->wall = wall_contact_at(&a->wall, c->l_last, x, y, c->vx, c->vy,
                                  c->link[last].c, c->link[last].s, c->omega[last]);
    }
}

// Velocity of the tip, along x and y [m/s].
KERNEL double tip_vx(const sweep *c)
{
    const int last = c->a->links - 1;
    return c->vx - c->l_last * c->link[last].s * c->omega[last];
}
KERNEL double tip_vy(const sweep *c)
{
    const int last = c->a->links - 1;
    return c->vy + c->l_last * c->link[last].c * c->omega[last];
}

// Computes the forces of a wall in contact by depth, rate and slip: the normal force of a
// wall that gives or, if its face has a mass, of the spring behind the face; and the
// force along the wall.
KERNEL void press_wall(sweep *c)
{
    const wall_model *model = &c->a->wall;
    const int last = c->a->links - 1;
    const double ex = c->wall.ex, ey = c->wall.ey;
    const double lever =
        wall_last_lever(&c->wall, c->l_last, c->link[last].c, c->link[last].s);
    const wall_meeting at = {.depth = c->wall.penetration,
                             .rate = wall_penetration_rate(&c->wall, c->vx, c->vy, lever,
                                                           c->omega[last]) +
                                     wall_comes(model, ex, ey),
                             .slip = ey * tip_vx(c) - ex * tip_vy(c) -
                                     wall_slides(model, ex, ey)};

    const wall_answer f = wall_forces(model, &c->a->amount, &at);
    if (c->face) {
        c->held_back = f.normal;
    } else {
        c->pressed = f.normal;
    }
    c->along = f.along;
    c->wall_power = f.lost;
}

// What the links beyond a joint, up to the tip, show to the link before it, once their
// accelerations have been eliminated (chain.h).
typedef struct beyond {
    double pxx, pxy, pyy;        // P: mass that they show
    double qx, qy;               // Q of velocity and springs
    double ux2, uy2;             // Q of a unit contact force
    double outer;                // torque of the joint before them
    double root_free, root_unit; // moments on the first link before division
    double end_x, end_y;         // velocity of the next link's end
} beyond;

// Forces on link k of length l by its motion; moves b->end to the next link's end.
KERNEL link_force forces_on_link(sweep *c, const force_constants *constants, int k,
                                 double l, beyond *b)
{
    const double cosine = c->link[k].c, sine = c->link[k].s, half = 0.5 * l,
                 omega = c->omega[k];
    const link_motion centre = {.vx = b->end_x + half * sine * omega,
                                .vy = b->end_y - half * cosine * omega,
                                .turn = omega};
    link_force f = {0};
    add_link_forces(constants, &c->a->amount, &centre, &f);
    c->damping_power += f.lost;
    b->end_x += sine * l * omega;
    b->end_y -= cosine * l * omega;
    return f;
}

// Torque of the joint before link k at a bend [rad] and its rate [rad/s].
KERNEL double joint_torque(sweep *c, const force_constants *constants, int k, double bend,
                           double rate)
{
    const joint_force f = joint_forces(constants, &c->a->amount, bend, rate);
    double of_shapes = 0;
    for (int i = 0; i < c->a->damped_modes; i++) {
        of_shapes += c->a->modal_damping[i][k] * c->shape[i];
    }
    c->damping_power += f.lost;
    return f.torque + of_shapes;
}

// Eliminates the acceleration of link k, tip to hub (chain.h): its balance of moments
// gives it as that of a base at rest, `free` and for a unit contact force `unit`, less
// (ux, uy) / d times the acceleration of the base. *b becomes what link k and those
// beyond show to link k - 1. Here t = (-s, c) and r = (c, s) are the directions across
// and along the link.
KERNEL void eliminate(sweep *c, int k, beyond *b)
{
    const arm *a = c->a;
    const bool tip = k == a->links - 1, root = k == 0;
    const double l = arm_link_of(a, k).length, m = arm_link_of(a, k).mass, half = 0.5 * l;
    const double cosine = c->link[k].c, sine = c->link[k].s,
                 w2 = c->omega[k] * c->omega[k];
    const double ptx = -b->pxx * sine + b->pxy * cosine; // P t
    const double pty = -b->pxy * sine + b->pyy * cosine;
    const double prx = b->pxx * cosine + b->pxy * sine; // P r
    const double pry = b->pxy * cosine + b->pyy * sine;
    const double ux = -m * half * sine + l * ptx, uy = m * half * cosine + l * pty;

    // inertia about the base, with that of what lies beyond
    const double fx = b->qx - l * w2 * prx, fy = b->qy - l * w2 * pry;
    double d =
        arm_link_of(a, k).inertia + m * half * half + l * l * (cosine * pty - sine * ptx);
    if (root && !a->hub_spring) {
        d += a->hub_inertia;
    }

    // the moments on it
    const force_constants constants = force_constants_of(a, k);
    const link_force on_link = forces_on_link(c, &constants, k, l, b);
    double inner = c->hub_joint;
    if (!root) {
        inner = joint_torque(c, &constants, k, c->theta[k] - c->theta[k - 1],
                             c->omega[k] - c->omega[k - 1]);
    }
    double moment = b->outer - inner - l * (cosine * fy - sine * fx);
    double moment2 = 0;
    b->outer = inner;
    if (tip) {
        moment -= c->pressed * c->wall.lever;
    }
    moment -= half * (cosine * on_link.y - sine * on_link.x) + on_link.moment;
    if (c->constrained) {
        moment2 = -l * (cosine * b->uy2 - sine * b->ux2) - (tip ? c->wall.lever : 0);
    }
    if (root) {
        b->root_free = moment;
        b->root_unit = moment2;
        if (!a->hub_spring && c->stuck) {
            moment = moment2 = 0; // a stuck hub has no acceleration
        }
    }

    // the accelerations of a base at rest
    const double inv_d = 1 / d, free = moment * inv_d, unit = moment2 * inv_d;
    c->link[k] = (chain_link){cosine, sine, inv_d, ux, uy, free, unit};

    // what the link and those beyond show to the one before
    if (root) {
        return;
    }
    b->qx = fx - m * half * w2 * cosine + ux * free + on_link.x;
    b->qy = fy - m * half * w2 * sine + uy * free + on_link.y;
    if (c->constrained) {
        b->ux2 += ux * unit;
        b->uy2 += uy * unit;
    }
    b->pxx = b->pxx + m - ux * ux * inv_d;
    b->pxy = b->pxy - ux * uy * inv_d;
    b->pyy = b->pyy + m - uy * uy * inv_d;
}

// Accelerations of the last link's base, free and for a unit force.
typedef struct tip_base {
    double ax, ay, bx, by;
} tip_base;

// Computes the links' accelerations without a contact force, from hub to tip, into
// out[links], and those by a unit contact force into link[].unit.
KERNEL tip_base substitute(const sweep *c, double *out)
{
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k < c->a->links; k++) {
        chain_link *at = &c->link[k];
        out[k] = at->free;
        if (k > 0) { // the first link's base rests
            out[k] -= (at->ux * ax + at->uy * ay) * at->inv_d;
        }
        if (c->constrained && k > 0) {
            at->unit -= (at->ux * bx + at->uy * by) * at->inv_d;
        }
        if (k < c->a->links - 1) {
            const double l = arm_link_of(c->a, k).length, w2 = c->omega[k] * c->omega[k];
            ax -= l * (at->s * out[k] + at->c * w2);
            ay += l * (at->c * out[k] - at->s * w2);
            if (c->constrained) {
                bx -= l * at->s * at->unit;
                by += l * at->c * at->unit;
            }
        }
    }
    return (tip_base){ax, ay, bx, by};
}

// Computes the contact force, adds its accelerations to out[links] and sets the wall's
// part of the reactions. On a rigid wall the force follows from d2g/dt2 = 0: with `rate2`
// the depth's second derivative without the force and `yields` its change by a unit
// force, it is -rate2 / yields. A face of mass m on a spring that holds back by H has to
// move along: f = m (rate2 + f yields) + H.
KERNEL void close_wall(const sweep *c, tip_base base, double *out,
                       chain_reaction *reaction)
{
    const wall_model *model = &c->a->wall;
    const wall_contact *at = &c->wall;
    const int N = c->a->links;
    const chain_link *end = &c->link[N - 1];
    const double last = wall_last_lever(at, c->l_last, end->c, end->s); // J_N
    const double comes = wall_comes(model, at->ex, at->ey);
    const double comes_faster = wall_comes_faster(model, at->ex, at->ey);
    double rate2 =
        at->ex * base.ax + at->ey * base.ay + last * out[N - 1] + at->convective;
    double force = c->pressed;

    // a moving wall accelerates the depth, but the mass of a face feels the acceleration
    // in space
    if (!c->face) {
        rate2 += comes_faster;
    }
    if (c->constrained) {
        const double yields = at->ex * base.bx + at->ey * base.by + last * end->unit;
        force = -rate2 / yields;
        if (c->face) {
            const double mass = model->face_mass;
            force = (mass * rate2 + c->held_back) / (1 - mass * yields);
        }
        for (int k = 0; k < N; k++) {
            out[k] += force * c->link[k].unit;
        }
        if (c->face) {
            rate2 += force * yields;
        } else {
            rate2 = 0;
        }
    }
    if (c->face) {
        rate2 += comes_faster;
    }

    // force, powers and gap
    reaction->force = force;
    reaction->wall_work = -c->along * wall_slides(model, at->ex, at->ey);
    if (c->face) {
        reaction->wall_work += c->held_back * comes; // its foundation works
    } else {
        reaction->wall_work += force * comes;
    }
    reaction->wall_power = c->wall_power;
    reaction->gap_acceleration = -rate2;
    reaction->gap = wall_stands(model) ? -at->penetration : HUGE_VAL;
    reaction->gap_velocity =
        -(wall_penetration_rate(at, c->vx, c->vy, last, c->omega[N - 1]) + comes);
}

// Forces at the hub at its velocity w [rad/s]; `state` is the current [A] where that is a
// state of its own.
KERNEL hub_force forces_at_hub(const arm *a, double w, double state)
{
    double current = 0;
    if (a->motor.electric) {
        current = motor_current(&a->motor, state, w);
    }
    hub_force f = {0};
    add_hub_forces(&a->motor, w, current, &f);
    return f;
}

// What the tip shows to the last link: the mass that it carries, the forces of the wall,
// and the forces on that mass.
KERNEL beyond beyond_tip(const sweep *c)
{
    const arm *a = c->a;
    const force_constants tip = force_constants_of_tip(a);
    const link_motion moves = {.vx = tip_vx(c), .vy = tip_vy(c)};
    const double ex = c->wall.ex, ey = c->wall.ey;
    link_force f = {0};
    add_link_forces(&tip, &a->amount, &moves, &f);
    return (beyond){.pxx = a->tip_mass,
                    .pyy = a->tip_mass,
                    .qx = c->pressed * ex + c->along * ey + f.x,
                    .qy = c->pressed * ey - c->along * ex + f.y,
                    .ux2 = ex,
                    .uy2 = ey,
                    .end_x = moves.vx,
                    .end_y = moves.vy};
}

void chain_accelerations(const arm *a, chain_link *work, const double *q, const double *w,
                         contact_state mode, double *alpha, chain_reaction *reaction)
{
    if (pair_suits(a)) {
        pair_accelerations(a, q, w, mode, alpha, reaction);
        return;
    }
    double shape[PARAMETER_MODES_MOST];
    sweep c = {.a = a,
               .link = work,
               .theta = q + a->first,
               .omega = w + a->first,
               .shape = shape};
    const bool gives = wall_gives(&a->wall) && wall_stands(&a->wall);
    c.face = gives && wall_has_face(&a->wall);
    c.constrained = mode.contact && (!gives || c.face);

    // a single link on a rigid hub is held by the wall alone; friction has no say
    const bool held = c.constrained && !c.face && a->dof == 1;
    const double sliding = held ? 0 : -mode.friction * a->motor.stiction;
    c.stuck = mode.friction == HUB_STICK && !held;
    reach_wall(&c);
    if (mode.contact) {
        press_wall(&c);
    }

    // motor and sliding friction at the hub, and the joint there
    const hub_force motor = forces_at_hub(a, w[0], mode.current);
    double hub = -motor.torque + sliding;
    c.damping_power = shape_sizes(a, w, shape);
    c.hub_joint = -hub;
    if (a->hub_spring) {
        const force_constants constants = force_constants_of(a, 0);
        c.hub_joint = joint_torque(&c, &constants, 0, q[1] - q[0], w[1] - w[0]);
        hub += c.hub_joint;
    }

    // tip to hub: eliminate each link's acceleration
    beyond b = beyond_tip(&c);
    for (int k = a->links - 1; k >= 0; k--) {
        eliminate(&c, k, &b);
    }

    // hub to tip: accelerations with and without the unit force, and the force
    const tip_base base = substitute(&c, alpha + a->first);
    close_wall(&c, base, alpha + a->first, reaction);
    reaction->friction = sliding;
    if (a->hub_spring) {
        alpha[0] = hub / a->hub_inertia;
        if (c.stuck) {
            reaction->friction = -hub;
            alpha[0] = 0;
        }
    } else if (c.stuck) {
        reaction->friction = -(b.root_free + reaction->force * b.root_unit);
    }
    reaction->viscous_power = motor.viscous;
    reaction->motor_torque = motor.drive;
    reaction->damping_power = c.damping_power;
}

// Accelerations of the chain by two sweeps; the derivation stands in chain.h. Two plain
// links have a closed form (chain_pair.h).
#include "src/arm/chain.h"

#include <math.h>

#include "src/arm/chain_pair.h"
#include "src/base/sincos.h"

#define KERNEL static inline __attribute__((always_inline))

// Sums of the rows of the modal damping, g'(bend rates), into sums[damped_modes] [N m
// s^(1/2)]; the torques are g times them. Returns the power lost [W].
static double modal_rates(const arm *a, const double *w, double *sums)
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

// What a sweep is of.
typedef struct sweep {
    const arm *a;
    chain_link *link;
    bool gives, face;      // the wall gives; its face has a mass
    bool constrained;      // contact ties the tip to wall or face
    bool stuck;            // the hub by friction
    const double *theta;   // angles of the links [rad]
    const double *omega;   // [rad/s]
    wall_contact wall;     // how the wall meets the last link
    double l_last, vx, vy; // length of the last link [m], velocity of its base [m/s]
    double pressed;        // force of a wall that gives [N]
    double held_back;      // and of the spring behind a face with a mass [N]
    double hub_joint; // torque of the joint before the first link, else less the motor's
                      // [N m]
    const double *modal;              // sums of the modal damping's rows
    double damping_power, wall_power; // lost [W]
} sweep;

// Directions of the links, place and velocity of the last one's base, and how the wall
// meets it.
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

// The answer of a wall that gives to place and velocity; of one with a mass that of its
// spring.
KERNEL void wall_answer(sweep *c)
{
    const wall_model *model = &c->a->wall;
    const int last = c->a->links - 1;
    const double lever =
        wall_last_lever(&c->wall, c->l_last, c->link[last].c, c->link[last].s);
    const double depth = c->wall.penetration;
    const double rate =
        wall_penetration_rate(&c->wall, c->vx, c->vy, lever, c->omega[last]) +
        wall_comes(model, c->wall.ex, c->wall.ey);
    if (c->face) {
        c->held_back = wall_force(model, depth, rate);
        c->wall_power = model->damping * rate * rate;
    } else {
        c->pressed = wall_force(model, depth, rate);
        // a step tries Kelvin-Voigt's law in front of the wall, too, and loses nothing
        // there
        const bool damper = model->law == WALL_KELVIN_VOIGT;
        c->wall_power = damper ? model->damping * rate * rate
                               : (c->pressed - wall_spring_force(model, depth)) * rate;
    }
}

// The links from one on to the tip, whose accelerations have been eliminated.
typedef struct beyond {
    double pxx, pxy, pyy;        // P: mass that they show
    double qx, qy;               // Q of velocity and springs
    double ux2, uy2;             // Q of a unit contact force
    double outer;                // torque of the joint before them
    double root_free, root_unit; // moments on the first link before division
    double end_x, end_y;         // velocity of the next link's end, where air drags
} beyond;

// Moment of the air on link k, its force into *x and *y.
KERNEL double drag_moment(sweep *c, int k, double l, beyond *b, double *x, double *y)
{
    const double air = c->a->air_drag * l, omega = c->omega[k];
    const double cosine = c->link[k].c, sine = c->link[k].s, half = 0.5 * l,
                 turn = l * omega;
    const double turning = c->a->air_drag * l * l * l / 12 * omega;
    *x = air * (b->end_x + half * sine * omega);
    *y = air * (b->end_y - half * cosine * omega);
    c->damping_power += (*x * *x + *y * *y) / air + turning * omega;
    b->end_x += sine * turn;
    b->end_y -= cosine * turn;
    return half * (cosine * *y - sine * *x) + turning;
}

// Torque of the joint before link k at a bend [rad] and its rate [rad/s].
KERNEL double joint_torque(sweep *c, int k, double bend, double rate)
{
    const double damping = arm_link_of(c->a, k).damping;
    double modal = 0;
    for (int i = 0; i < c->a->damped_modes; i++) {
        modal += c->a->modal_damping[i][k] * c->modal[i];
    }
    c->damping_power += damping * rate * rate;
    return (arm_link_of(c->a, k).stiffness * bend + damping * rate) +
           (arm_stiffening_torque(c->a, k, bend) + modal);
}

// Eliminates the acceleration of link k.
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
    const double fx = b->qx - l * w2 * prx, fy = b->qy - l * w2 * pry;
    double d =
        arm_link_of(a, k).inertia + m * half * half + l * l * (cosine * pty - sine * ptx);
    if (root && !a->hub_spring) {
        d += a->hub_inertia;
    }

    // the moments on it
    const double inner = root ? c->hub_joint
                              : joint_torque(c, k, c->theta[k] - c->theta[k - 1],
                                             c->omega[k] - c->omega[k - 1]);
    double moment = b->outer - inner - l * (cosine * fy - sine * fx);
    double moment2 = 0, drag_x = 0, drag_y = 0;
    b->outer = inner;
    moment -= (tip ? c->pressed * c->wall.lever : 0) + half * m * a->gravity * cosine;
    if (a->air_drag > 0) {
        moment -= drag_moment(c, k, l, b, &drag_x, &drag_y);
    }
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
    const double inv_d = 1 / d, free = moment * inv_d, unit = moment2 * inv_d;
    c->link[k] = (chain_link){cosine, sine, inv_d, ux, uy, free, unit};

    // what it and those beyond show to the one before
    if (root) {
        return;
    }
    b->qx = fx - m * half * w2 * cosine + ux * free + drag_x;
    b->qy = fy - m * half * w2 * sine + uy * free + m * a->gravity + drag_y;
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

// From hub to tip: the links' accelerations, into link[].unit those of a unit force.
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

// The force that d2g/dt2 = 0 gives, or what a face with a mass needs to go along, and
// what it makes of the accelerations; reactions of the wall.
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
    rate2 +=
        c->face ? 0 : comes_faster; // the mass of a face feels the acceleration in space
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
        rate2 = c->face ? rate2 + force * yields : 0;
    }
    rate2 += c->face ? comes_faster : 0;
    reaction->force = force;
    reaction->wall_work =
        (c->face ? c->held_back : force) * comes; // a face's foundation works
    reaction->wall_power = c->wall_power;
    reaction->gap_acceleration = -rate2;
    reaction->gap = wall_stands(model) ? -at->penetration : HUGE_VAL;
    reaction->gap_velocity =
        -(wall_penetration_rate(at, c->vx, c->vy, last, c->omega[N - 1]) + comes);
}

void chain_accelerations(const arm *a, chain_link *work, const double *q, const double *w,
                         contact_state mode, double *alpha, chain_reaction *reaction)
{
    if (pair_suits(a)) {
        pair_accelerations(a, q, w, mode, alpha, reaction);
        return;
    }
    double modal[PARAMETER_MODES_MOST];
    sweep c = {.a = a,
               .link = work,
               .theta = q + a->first,
               .omega = w + a->first,
               .modal = modal};
    c.gives = wall_gives(&a->wall) && wall_stands(&a->wall);
    c.face = c.gives && wall_has_face(&a->wall);
    c.constrained = mode.contact && (!c.gives || c.face);

    // a single link on a rigid hub is held by the wall alone; friction has no say
    const bool held = c.constrained && !c.face && a->dof == 1;
    const double sliding = held ? 0 : -mode.friction * a->motor.stiction;
    c.stuck = mode.friction == HUB_STICK && !held;
    reach_wall(&c);
    if (c.gives && mode.contact) {
        wall_answer(&c);
    }

    // motor, damping and sliding friction at the hub, and the joint there
    double hub = a->motor.torque - a->motor.damping * w[0] + sliding;
    reaction->motor_torque = 0;
    if (a->motor.electric) {
        reaction->motor_torque =
            a->motor.torque_constant * motor_current(&a->motor, mode.current, w[0]);
        hub += reaction->motor_torque;
    }
    c.damping_power = modal_rates(a, w, modal);
    c.hub_joint = -hub;
    if (a->hub_spring) {
        c.hub_joint = joint_torque(&c, 0, q[1] - q[0], w[1] - w[0]);
        hub += c.hub_joint;
    }

    // tip to hub: eliminate each link's acceleration
    const chain_link *end = &work[a->links - 1];
    beyond b = {.pxx = a->tip_mass,
                .pyy = a->tip_mass,
                .qx = c.pressed * c.wall.ex,
                .qy = c.pressed * c.wall.ey + a->tip_mass * a->gravity,
                .ux2 = c.wall.ex,
                .uy2 = c.wall.ey,
                .end_x = c.vx - c.l_last * end->s * c.omega[a->links - 1],
                .end_y = c.vy + c.l_last * end->c * c.omega[a->links - 1]};
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
    reaction->viscous_power = a->motor.damping * w[0] * w[0];
    reaction->damping_power = c.damping_power;
}

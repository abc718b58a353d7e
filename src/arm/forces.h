// The forces on the arm, each in one function that adds its value, the power it takes and
// its derivatives to those of the other forces at the same place. src/tables/force_list.h
// says which forces there are; here every place calls all of its own. The sweeps along
// the chain (chain_sweep.c), those of the stiff engine with its tangent, and the modes
// read them here and nowhere else.
//
// Every force and torque is positive where it acts against the motion or bend that its
// place has.
//
// Numbers are of the kind that the including file works with: FORCE_LANES side by side,
// or one. Where no lane needs a derivative, a power or an energy, the compiler leaves it
// out.
#pragma once

#include "src/arm/arm.h"
#include "src/base/kernel.h"

#ifdef FORCE_LANES
typedef double force_number __attribute__((vector_size(8 * FORCE_LANES)));
#else
typedef double force_number;
#endif

// --- links and their joints ------------------------------------------------------------

// What the forces on a link and in the joint before it are made of.
typedef struct force_constants {
    double stiffness, damping; // of the joint [N m/rad], [N m s/rad]
    double stiffening;         // its torque at a bend b is this times b^3 [N m/rad3]
    double air, turning;       // drag of the link [N s/m], [N m s/rad]
    double weight;             // of the link, in a tilted plane [N]
} force_constants;

KERNEL force_constants force_constants_of(const arm *a, int k)
{
    const arm_link own = arm_link_of(a, k);
    const double air = a->amount.air_drag * own.length;
    force_constants l = {.stiffness = own.stiffness,
                         .damping = own.damping,
                         .air = air,
                         .turning = air * own.length * own.length / 12,
                         .weight = a->amount.gravity * own.mass};

    // a hub spring of its own does not stiffen; a root is half a joint, which bends half
    // as far at the same curvature
    if (k > 0) {
        l.stiffening = own.stiffness * a->amount.stiffening;
    } else if (a->root_bends) {
        l.stiffening = own.stiffness * (4 * a->amount.stiffening);
    }
    return l;
}

// The same of what the tip carries, on which the forces on links act, too.
KERNEL force_constants force_constants_of_tip(const arm *a)
{
    return (force_constants){.weight = a->amount.gravity * a->tip_mass};
}

// --- in a joint ------------------------------------------------------------------------

typedef struct joint_force {
    force_number torque;           // [N m]
    force_number lost;             // power turned into heat [W]
    force_number energy;           // that the joint holds [J]
    force_number by_bend, by_rate; // derivatives of the torque [N m/rad], [N m s/rad]
} joint_force;

// Stiffness and structural damping in proportion to the bend and its rate.
KERNEL void joint_spring(const force_constants *l, force_number bend, force_number rate,
                         joint_force *f)
{
    f->torque += l->stiffness * bend + l->damping * rate;
    f->lost += l->damping * rate * rate;
    f->energy += l->stiffness * bend * bend / 2;
    f->by_bend += l->stiffness;
    f->by_rate += l->damping;
}

// Stiffness that grows with the square of the bend.
KERNEL void stiffening(const force_constants *l, const force_amounts *amount,
                       force_number bend, force_number rate, joint_force *f)
{
    (void)rate;
    if (amount->stiffening > 0) {
        f->torque += l->stiffening * bend * bend * bend;
        f->energy += l->stiffening * bend * bend * bend * bend / 4;
        f->by_bend += 3 * l->stiffening * bend * bend;
    }
}

// All forces of the joint before a link at a bend [rad] and its rate [rad/s].
KERNEL joint_force joint_forces(const force_constants *l, const force_amounts *amount,
                                force_number bend, force_number rate)
{
    joint_force f = {0};
    joint_spring(l, bend, rate, &f);
#define ADD_FORCE(feature, law, ...) law(l, amount, bend, rate, &f);
    JOINT_FORCES(ADD_FORCE)
#undef ADD_FORCE
    return f;
}

// --- on a link -------------------------------------------------------------------------

// Velocity of a link's centre of mass [m/s] and its angular velocity [rad/s].
typedef struct link_motion {
    force_number vx, vy, turn;
} link_motion;

typedef struct link_force {
    force_number x, y;        // at the centre of mass [N]
    force_number moment;      // about it [N m]
    force_number lost;        // [W]
    double by_speed, by_turn; // derivatives of force and moment [N s/m], [N m s/rad]
} link_force;

// Drag in proportion to the velocity of each piece of the link.
KERNEL void air_drag(const force_constants *l, const force_amounts *amount,
                     const link_motion *at, link_force *f)
{
    if (amount->air_drag > 0) {
        f->x += l->air * at->vx;
        f->y += l->air * at->vy;
        f->moment += l->turning * at->turn;
        f->lost += l->air * (at->vx * at->vx + at->vy * at->vy) +
                   l->turning * (at->turn * at->turn);
        f->by_speed += l->air;
        f->by_turn += l->turning;
    }
}

// Weight in a tilted plane, along the angle -pi/2.
KERNEL void gravity(const force_constants *l, const force_amounts *amount,
                    const link_motion *at, link_force *f)
{
    (void)amount;
    (void)at;
    f->y += l->weight;
}

// Derivative by its angle of the weight's moment about a link's base [N m/rad]: half of
// its own weight and all of that beyond hang at its end, `rise` [m] above its base.
KERNEL double weight_by_angle(const force_constants *l, double beyond, double rise)
{
    return -(beyond + 0.5 * l->weight) * rise;
}

// Adds all forces on a link to those in f.
KERNEL void add_link_forces(const force_constants *l, const force_amounts *amount,
                            const link_motion *at, link_force *f)
{
#define ADD_FORCE(feature, law, ...) law(l, amount, at, f);
    LINK_FORCES(ADD_FORCE)
#undef ADD_FORCE
}

// --- on a shape ------------------------------------------------------------------------

typedef struct shape_force {
    force_number size; // that a row of arm.modal_damping takes to torques
    force_number lost; // [W]
    double by_rate;
} shape_force;

// What a row of arm.modal_damping adds up to of the bends' rates damps its shape.
KERNEL void modal_damper(force_number rate, shape_force *f)
{
    f->size += rate;
    f->lost += rate * rate;
    f->by_rate += 1;
}

// All forces on a shape that changes at a rate.
KERNEL shape_force shape_forces(force_number rate)
{
    shape_force f = {0};
#define ADD_FORCE(feature, law, ...) law(rate, &f);
    SHAPE_FORCES(ADD_FORCE)
#undef ADD_FORCE
    return f;
}

// --- at the hub ------------------------------------------------------------------------

typedef struct hub_force {
    force_number torque;        // [N m]
    force_number viscous;       // lost to viscous friction and back EMF [W]
    force_number drive;         // torque of a current with an equation of its own [N m]
    double by_rate, by_current; // derivatives of the torque [N m s/rad], [N m/A]
} hub_force;

// The motor at its command; its damping is that of bearings and, where the current
// follows at once, of back EMF.
KERNEL void motor_torque(const motor_model *m, force_number w, hub_force *f)
{
    f->torque += m->damping * w;
    f->torque -= m->torque;
    f->viscous += m->damping * w * w;
    f->by_rate += m->damping;
}

// The current of a drive that has an equation for it; how it follows the hub is the
// engine's.
KERNEL void armature_current(const motor_model *m, force_number w, force_number current,
                             hub_force *f)
{
    (void)w;
    if (m->electric) {
        f->drive += m->torque_constant * current;
        f->torque -= m->torque_constant * current;
        f->by_current -= m->torque_constant;
    }
}

// Adds all forces at the hub but Coulomb friction, which is the contact machine's, at its
// velocity [rad/s] and a current [A].
KERNEL void add_hub_forces(const motor_model *m, force_number w, force_number current,
                           hub_force *f)
{
    motor_torque(m, w, f);
#define ADD_FORCE(feature, law, ...) law(m, w, current, f);
    HUB_FORCES(ADD_FORCE)
#undef ADD_FORCE
}

// --- at the wall -----------------------------------------------------------------------

// How an arm in contact meets the wall: its depth [m] and the rate of that [m/s], and how
// fast it slips along the wall or, of a point, along the last link [m/s].
typedef struct wall_meeting {
    force_number depth, rate, slip;
} wall_meeting;

typedef struct wall_answer {
    force_number normal;            // of a wall that gives, else 0 [N]
    force_number along;             // against the slip [N]
    force_number lost;              // [W]
    force_number by_depth, by_rate; // derivatives of the normal one [N/m], [N s/m]
    force_number by_slip;           // and of that along [N s/m]
} wall_answer;

// Hunt and Crossley's power of a depth and its derivative, x^n and n x^(n-1).
typedef struct wall_powers {
    force_number power, slope;
} wall_powers;

KERNEL wall_powers wall_powers_at(const wall_model *w, force_number depth)
{
    wall_powers at = {0};
#ifdef FORCE_LANES
    for (int i = 0; i < FORCE_LANES; i++) {
        at.power[i] = wall_power(w, depth[i]);
        at.slope[i] = wall_power_slope(w, depth[i], at.power[i]);
    }
#else
    at.power = wall_power(w, depth);
    at.slope = wall_power_slope(w, depth, at.power);
#endif
    return at;
}

// The law of a wall that gives (wall.h), also where a step tries it in front of the wall;
// of a face with a mass it is what spring and damper behind it answer.
KERNEL void wall_yields(const wall_model *w, const force_amounts *amount,
                        const wall_meeting *at, wall_answer *f)
{
    (void)amount;
    if (w->law == WALL_KELVIN_VOIGT) {
        f->normal += w->stiffness * at->depth + w->damping * at->rate;
        f->lost += w->damping * at->rate * at->rate;
        f->by_depth += w->stiffness;
        f->by_rate += w->damping;
    } else if (w->law == WALL_HUNT_CROSSLEY) {
        const wall_powers x = wall_powers_at(w, at->depth);
        const force_number factor = w->stiffness + w->damping * at->rate;
        f->normal += x.power * factor;
        f->lost += (x.power * factor - w->stiffness * x.power) * at->rate;
        f->by_depth += x.slope * factor;
        f->by_rate += w->damping * x.power;
    }
}

// All forces of a wall that is touched, but the reaction of a rigid one.
KERNEL wall_answer wall_forces(const wall_model *w, const force_amounts *amount,
                               const wall_meeting *at)
{
    wall_answer f = {0};
#define ADD_FORCE(feature, law, ...) law(w, amount, at, &f);
    WALL_FORCES(ADD_FORCE)
#undef ADD_FORCE
    return f;
}

// Force of a wall that gives at a depth [m] and its rate [m/s], without what slips.
KERNEL force_number wall_normal_force(const wall_model *w, force_number depth,
                                      force_number rate)
{
    const wall_meeting at = {.depth = depth, .rate = rate};
    return wall_forces(w, &(force_amounts){0}, &at).normal;
}

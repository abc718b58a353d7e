// What the arm is: hub, N links, springs, motor and wall as constants derived from the
// parameters.
//
// Coordinates. Every link has an absolute angle, measured from the reference direction
// and growing towards the wall. With a rigid hub joint, hub and first link share one;
// with a spring (k1, or the root k2 N of a beam) the hub has its own. Degree of freedom 0
// is always the body the motor turns. The unit vector along link k is r_k = (cos, sin),
// across it t_k = (-sin, cos).
//
// Contact. g(q) is the penetration: negative in free flight, zero in contact, gap = -g.
// The wall acts with the generalised force -J^T f, J = dg/dq, f >= 0.
#pragma once

#include "src/arm/motor.h"
#include "src/arm/wall.h"
#include "src/tables/features.h"

// A link and the joint before it.
typedef struct arm_link {
    double length;    // [m]
    double mass;      // [kg]
    double inertia;   // about the centre of mass [kg m2]
    double stiffness; // of the joint [N m/rad]
    double damping;   // of the joint [N m s/rad]
} arm_link;

// How much there is of each force of force_list.h, by the name of its law.
typedef struct force_amounts {
#define FORCE_AMOUNT(feature, law, ...) double law;
    FORCE_LIST(FORCE_AMOUNT)
#undef FORCE_AMOUNT
} force_amounts;

typedef struct arm {
    feature_set features;   // of the parameters it is made of
    int links;              // N
    int dof;                // degrees of freedom n: N, or N + 1 with a hub spring
    int first;              // index of the first link's angle: 0, or 1 with a hub spring
    bool hub_spring;        // the hub is a body of its own, on a spring
    bool root_bends;        // that spring is part of the beam: its root
    bool uneven;            // links and joints are those of `each`
    double link_length;     // l, of an uneven arm the mean [m]
    double link_mass;       // m, of an uneven arm the mean [kg]
    double link_inertia;    // about the centre of mass, of an uneven arm the mean [kg m2]
    double hub_inertia;     // I1 [kg m2]
    double tip_mass;        // that the tip carries [kg]
    double held_angle;      // initial.angle, at which modes take a hub to be held [rad]
    double hub_stiffness;   // k1 or k2 N, zero with a rigid hub joint [N m/rad]
    double joint_stiffness; // of each inner joint, k2 N/2, of an uneven arm the largest
                            // [N m/rad]
    double hub_joint_damping; // structural damping of the hub spring [N m s/rad]
    double
        joint_damping; // structural damping of each inner joint or that one [N m s/rad]
    force_amounts amount;
    int damped_modes;  // how many rows modal_damping has
    motor_model motor; // with the command in force
    wall_model wall;
    double highest_frequency; // upper estimate over the arm's free modes [rad/s]
    double fastest_decay;     // of overdamped modes and of the hub alone [1/s]
    double fastest_rate;      // of vibrations and, weighted, decays: sets the steps [1/s]
    arm_link each[PARAMETER_LIST_MOST]; // of an uneven arm, from the hub
    // row i, g, gives the joints the torques g (g'(bend rates)); g[k] belongs to the
    // joint before link k
    double modal_damping[PARAMETER_MODES_MOST]
                        [PARAMETER_MODAL_LINKS]; // [(N m s/rad)^(1/2)]
} arm;

// Whether the arm is equal bare links with equal linear joints, damped in proportion to
// their stiffness or not, with a motor whose current follows immediately: what the
// equations of special engines and predictors are for. In a level plane, the wall at
// rest.
static inline bool arm_is_plain(const arm *a)
{
    const feature_set more = NOT_OF_PAIR & ~HAS(GIVES);
    return !wall_moves(&a->wall) && (a->features & more) == 0;
}

// Link k from the hub, from 0.
static inline arm_link arm_link_of(const arm *a, int k)
{
    return a->uneven ? a->each[k]
                     : (arm_link){a->link_length, a->link_mass, a->link_inertia,
                                  k > 0 ? a->joint_stiffness : a->hub_stiffness,
                                  k > 0 ? a->joint_damping : a->hub_joint_damping};
}

// Derives the constants from resolved parameters (corrected model); the command is
// motor.voltage. Cost grows linearly with N. In arm_setup.c, which sweeps the chain for
// its fastest mode.
void arm_init(arm *a, const parameters *p);

// Puts another command [V] in force, at the cost of a multiplication; all else stays. The
// arm of a run under a controller is at the controller's command, whatever motor.voltage
// says.
void arm_set_voltage(arm *a, double volts);

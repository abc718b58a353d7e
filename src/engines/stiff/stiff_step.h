// A step of the stiff engine (stiff_engine.c): Radau IIA of seven stages for a chain of
// links, at a cost that grows linearly with their number.
//
// The arm, with everything that it may have, is R(q, w, a) = M(q) a + c(q, w) + torques
// of joints, air, motor and friction + J'f = 0, worked out by one sweep of accelerations
// outwards and one of forces inwards (inverse dynamics), for all stages side by side in
// lanes. With the stages' accelerations A as unknowns (h: the step, a: the formula's
// matrix),
//
//     W = w0 + h a A,    Q = q0 + h c w0 + h^2 a^2 A,    R(Q_i, W_i, A_i) = 0.
//
// Simplified Newton: (1 x M + h a x D + h^2 a^2 x K) dA = -R. With a = T diag(1/root)
// T^-1 and the numbers g = h/root of one real and three complex systems, which stand in
// lanes as well,
//
//     (M + g D + g^2 K) y = -T^-1 R,    dA = T y,    dW = T g y,    dQ = T g^2 y.
//
// M, D and K are those of masses, joints, air and hub at one instant of the step. What
// forces and velocities add to K is of the size of the turn within a step, as is the
// change of M, and left to the iteration. So the matrix is symmetric, and the links
// beyond a joint answer (a: acceleration of their base, z: y of the link before) with the
// force P a + p z and the torque p'a + tau z. With kappa = g^2 k + g c of the joint and t
// across the link, link k has
//
//     u = l P t + p + (m l/2) t,   d = l^2 t'Pt + 2 l p't + tau + I + m l^2/4,  pivot = d
//     + kappa, y = (r - l t'F0 - T0 - u'a + kappa z)/pivot, P <- P + m - u u'/pivot,  p
//     <- u kappa/pivot,  tau <- kappa d/pivot, F0 <- F0 + u y0,  T0 <- -kappa y0,      y0
//     = (r - l t'F0 - T0)/pivot.
//
// Air drags as a mass of g times its coefficient would. A stuck hub has no row.
//
// Borders. A damped mode's torques G (G'w) and the contact force J'f are of rank one.
// Their sizes are unknowns z and f of their own, with the answers Z = -(...)^-1 G and Y =
// -(...)^-1 J':
//
//     z = g G'y,    rigid wall: J y = -(T^-1 J w)/g,    one that gives: f = (M_f + g^2 k
//     + g c) J y,
//
// where M_f is the mass of the wall's face. On a rigid wall it is the rate of the gap
// that is zero at the stages (index 2).
#pragma once

#include "src/arm/forces.h"
#include "src/contact/motion.h"
#include "src/engines/stiff/stiff_formula.h"

// Four lanes; the eight of the stages are a pair of them. Four systems are complex lanes.
typedef double stiff_lanes __attribute__((vector_size(32)));
enum { STIFF_HALVES = 2, STIFF_BORDERS = PARAMETER_MODES_MOST + 1 };
typedef struct stiff_complex {
    stiff_lanes r, i;
} stiff_complex;

// How the wall acts, and which of the drive's equations holds.
typedef enum stiff_wall { STIFF_FREE, STIFF_RIGID, STIFF_GIVES } stiff_wall;
typedef enum stiff_drive {
    STIFF_DIRECT,
    STIFF_FOLLOWS,
    STIFF_FLOWS,
    STIFF_LIMITED
} stiff_drive;

// Courses of a step that a state keeps.
enum { STIFF_STAGE_VALUES = QUADRATURE_COUNT + 3 };

// A link and the joint before it, and the link's direction at the step's start.
typedef struct stiff_link {
    double length, mass, inertia; // [m], [kg], about the centre of mass [kg m2]
    force_constants forces;
    double cosine, sine;
} stiff_link;

// A body's stages: angle, velocity, acceleration and what its equation lacks.
typedef struct stiff_stage {
    stiff_lanes q[STIFF_HALVES], w[STIFF_HALVES], a[STIFF_HALVES], r[STIFF_HALVES];
} stiff_stage;

// A link's direction at the stages, and the force that moves it.
typedef struct stiff_body {
    stiff_lanes c[STIFF_HALVES], s[STIFF_HALVES], fx[STIFF_HALVES], fy[STIFF_HALVES];
} stiff_body;

// A link's row of the tangent.
typedef struct stiff_pivot {
    stiff_complex ux, uy, inverse, kappa, share; // share: kappa/pivot
    double lc, ls;                               // l t = (-ls, lc)
    // its part of D: the joint's, and drag of the link [N m s/rad], [N s/m], [N m s/rad]
    double joint_damping, drag, turning;
} stiff_pivot;

// Numbers of the stages and, in the last lane, of the start.
typedef union stiff_nodes {
    stiff_lanes half[STIFF_HALVES];
    double at[RADAU_LANES];
} stiff_nodes;

typedef struct stiff_step {
    // the arm, in its contact state
    int links, dof, first, modes;
    stiff_link *link; // [links]
    double *mode;     // G [modes][dof]
    double hub_inertia, friction, tip_mass;
    force_constants tip; // of the forces on what the tip carries
    bool stuck;
    stiff_wall contact;
    const wall_model *wall;
    const force_amounts *amount;
    const motor_model *motor;
    stiff_drive drive;
    double limited; // the current held [A]

    // the step
    double length;
    double *q0, *w0, *a0; // state at its start [dof]
    double current0, force0;
    stiff_stage *stage; // [dof]
    stiff_body *body;   // [links]
    stiff_nodes gap;
    union { // courses that a state keeps: first the quadratures' rates, in their order
        struct {
            stiff_nodes viscous, lost, force, wall_lost, current_rate, electric, pushed;
            stiff_nodes rate, hold, current;
        };
        stiff_nodes values[STIFF_STAGE_VALUES];
    };
    double time; // of its start [s]
    // of a wall that moves, else zeros: place and velocity [m], [m/s]
    stiff_nodes shift[2];

    // the tangent
    stiff_complex g; // h/root
    stiff_pivot *pivot;
    stiff_complex hub_inverse, press;     // press: of a wall that gives, f/(J y)
    double hub_damping;                   // of the motor [N m s/rad]
    double wall_damping;                  // of a wall that gives, there [N s/m]
    double along_x, along_y;              // along the wall
    double slip_damping;                  // of the force along it [N s/m]
    double *jacobian;                     // J [dof]
    stiff_complex *y;                     // right side, then solution [dof]
    stiff_complex *border[STIFF_BORDERS]; // the contact's last [dof]
    stiff_complex corner[STIFF_BORDERS][STIFF_BORDERS], unknown[STIFF_BORDERS];
} stiff_step;

// How many borders there are, and the row of one: the damped modes', then the contact's.
static inline int stiff_borders(const stiff_step *s)
{
    return s->modes + (s->contact != STIFF_FREE ? 1 : 0);
}
static inline const double *stiff_border_row(const stiff_step *s, int i)
{
    return i < s->modes ? s->mode + i * s->dof : s->jacobian;
}

// What is built for each width of the processor's vectors, with the same bits.
typedef struct stiff_loops {
    // Stages from accelerations at the stages of the step before, [dof][lane], with a
    // weight for each: [stage before][lane]; and the contact force from that at those
    // stages.
    void (*predict)(stiff_step *s, const double *before, const double *force,
                    const double *weight);
    // R at the stages, gap, its rate and the force of a wall that gives; powers and the
    // hub's hold where `account`. False where a link turns too far for its polynomials.
    bool (*residual)(stiff_step *s, bool account);
    // The tangent at the middle stage, with its borders.
    void (*factor)(stiff_step *s);
    // The embedded formula's sums of velocities and accelerations, less the last stage's:
    // x, v [dof].
    void (*differences)(const stiff_step *s, double *x, double *v);
    // One iteration; how much it changes the velocities, in [kg^(1/2) m/s] at the worst
    // stage.
    double (*correct)(stiff_step *s);
} stiff_loops;

extern const stiff_loops stiff_loops_1, stiff_loops_4;

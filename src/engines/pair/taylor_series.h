// The motion of two links as power series of the time since a step's start.
//
// One source, taylor_kernel.c, is compiled for every width of vectors the processor may
// have; an arm gets the same bits whichever lane it is in.
#pragma once

#include <stdbool.h>

#include "src/contact/edge_limits.h"

// Highest order of the velocities' series, even; steps that something cuts short take
// less.
enum { TAYLOR_MOST = 24, TAYLOR_WIDEST = 8 };

// 1/n
static const double inverse[TAYLOR_MOST + 2] = {
    0,       1,       1. / 2,  1. / 3,  1. / 4,  1. / 5,  1. / 6,  1. / 7,  1. / 8,
    1. / 9,  1. / 10, 1. / 11, 1. / 12, 1. / 13, 1. / 14, 1. / 15, 1. / 16, 1. / 17,
    1. / 18, 1. / 19, 1. / 20, 1. / 21, 1. / 22, 1. / 23, 1. / 24, 1. / 25};

// n (n - 1)
static const double falling[TAYLOR_MOST + 2] = {0,   0,   2,   6,   12,  20,  30,
                                                42,  56,  72,  90,  110, 132, 156,
                                                182, 210, 240, 272, 306, 342, 380,
                                                420, 462, 506, 552, 600};

// A block holds the inputs of the series of an arm and the coefficients computed from
// them: one number per lane and place, lanes side by side. An array of places begins at
// the constant of its name.
enum taylor_place {
    // constants of the arm
    AT_MASS,      // of a link [kg]
    AT_INERTIA,   // of a link, about its centre of mass [kg m2]
    AT_LENGTH,    // of a link [m]
    AT_STIFFNESS, // of the joint [N m/rad]
    AT_DAMPING,   // of the joint [N m s/rad]
    AT_WALL_X,    // point wall: the contact point [m]; plane: its direction
    AT_WALL_Y,
    AT_TORQUE,        // of the motor [N m]
    AT_STICTION,      // of the hub [N m]
    AT_VISCOUS,       // viscous friction and back EMF [N m s/rad]
    AT_HUB_INERTIA,   // [kg m2]
    AT_HUB_STIFFNESS, // of the hub spring [N m/rad]
    AT_HUB_DAMPING,   // [N m s/rad]
    // the state at the step's start
    AT_FRICTION,    // hub_friction: 0 with a stuck hub, else its sign
    AT_START_ANGLE, // hub (with a spring), first, second link [rad]
    AT_START_VELOCITY = AT_START_ANGLE + 3, // [rad/s]
    AT_WANTED = AT_START_VELOCITY + 3,      // length of the step that is wanted [s]
    // just after an event: the acceleration of a hub at rest below which it is only
    // rounding; else
    // -1 [rad/s2]
    AT_EDGE_RATE,
    AT_INPUTS, // how many of the above
    // what comes of it: powers of the time, from the zeroth
    AT_ALLOWED = AT_INPUTS, // length that the series are good for [s]
    // lower bounds within that length: of the gap [m], or in contact of the force [N]; of
    // the hub's velocity in the direction it slides [rad/s], or of a stuck hub's margin
    // to break-away [N m]; just after an event without the rounding at its start, and,
    // where the function starts at zero, divided by the time or its square
    AT_WALL_LEAST,
    AT_HUB_LEAST,
    // where the wall's function, or the sliding hub's, first falls below zero; -1 where
    // the pieces of the step do not tell [s]
    AT_WALL_ROOT,
    AT_HUB_ROOT,
    AT_FORCE_MOST, // and in contact no more than this force [N]
    AT_ANGLE_0,    // of the hub, with a spring [rad]
    AT_ANGLE_1 = AT_ANGLE_0 + TAYLOR_MOST + 2, // of the links; orders to TAYLOR_MOST + 1
    AT_ANGLE_2 = AT_ANGLE_1 + TAYLOR_MOST + 2,
    AT_RATE_0 =
        AT_ANGLE_2 + TAYLOR_MOST + 2, // angular velocities [rad/s]; to TAYLOR_MOST
    AT_RATE_1 = AT_RATE_0 + TAYLOR_MOST + 1,
    AT_RATE_2 = AT_RATE_1 + TAYLOR_MOST + 1,
    AT_GAP = AT_RATE_2 + TAYLOR_MOST + 1, // in free flight [m]; to TAYLOR_MOST + 1
    AT_FORCE = AT_GAP + TAYLOR_MOST + 2,  // in contact [N]; to TAYLOR_MOST - 1
    AT_HOLD = AT_FORCE + TAYLOR_MOST, // friction torque of a stuck hub [N m]; the same
    AT_HUB_SQUARE = AT_HOLD + TAYLOR_MOST, // square of the hub's velocity; the same
    AT_DISSIPATION =
        AT_HUB_SQUARE + TAYLOR_MOST, // power lost in the springs [W]; the same
    TAYLOR_PLACES = AT_DISSIPATION + TAYLOR_MOST
};

// Just after an event (edge_limits.h) the limit on the hub's acceleration is EDGE_RATE
// times motion_rounding_at; that on the gap's is LEFT_OUT times as much of the part of
// motion_rounding_at beyond 1, because the series' truncation of it exceeds rounding.
#define LEFT_OUT 1000.0

// Which equations a block is for, the same in all its lanes.
typedef struct taylor_form {
    bool contact;    // held on the wall, else in free flight
    bool point;      // the wall is a point, else a plane
    bool hub_spring; // the hub is a body of its own
    bool damped;     // some spring has damping: AT_DISSIPATION is wanted
    int order; // of the velocities' series, up to TAYLOR_MOST, once they are computed
} taylor_form;

// Values of the series at instants of their steps, side by side. Bodies are the hub (with
// a spring), the first and the second link.
typedef struct taylor_instants {
    double time[TAYLOR_WIDEST];             // given: since its start [s]
    double angle[3][TAYLOR_WIDEST];         // [rad]
    double velocity[3][TAYLOR_WIDEST];      // [rad/s]
    double acceleration[3][TAYLOR_WIDEST];  // [rad/s2]
    double gap[TAYLOR_WIDEST];              // to the wall [m]
    double gap_velocity[TAYLOR_WIDEST];     // [m/s]
    double gap_acceleration[TAYLOR_WIDEST]; // [m/s2]
    double force[TAYLOR_WIDEST];            // in contact [N]
    double pressed[TAYLOR_WIDEST];          // integral of the force [N s]
    double hold[TAYLOR_WIDEST];             // of a stuck hub [N m]
    double hub_square[TAYLOR_WIDEST];  // integral of the hub's velocity squared [rad2/s]
    double dissipation[TAYLOR_WIDEST]; // power lost in damped springs [W]
    double dissipated[TAYLOR_WIDEST];  // its integral [J]
    double kinetic[TAYLOR_WIDEST];     // energy of motion [J]
    double strain[TAYLOR_WIDEST];      // and of bending [J]
} taylor_instants;

// The contact force at the ends of equal pieces of a step, TAYLOR_PIECES at most: a lane
// has them at `width`, 2 `width`, and so on.
enum { TAYLOR_PIECES = 8 };
typedef struct taylor_pieces {
    double width[TAYLOR_WIDEST];                // given [s]
    double force[TAYLOR_PIECES][TAYLOR_WIDEST]; // [N]
    double slope[TAYLOR_PIECES][TAYLOR_WIDEST]; // [N/s]
} taylor_pieces;

// What is built for each width of the processor's vectors, with the same bits; of one arm
// also with AVX2's. Blocks are aligned to their vectors. The last three are of several
// arms only.
typedef struct taylor_loops {
    // Computes the series of as many arms as there are lanes. Returns their order, which
    // is even: where an arm needs a lower order only, its further terms are zero, which
    // changes no bit of the results.
    int (*series)(double *block, taylor_form form);
    // Evaluates the series of an arm, a block of its own, at as many instants.
    void (*instants)(const double *block, taylor_form form, taylor_instants *at);
    // Values and slopes of one of an arm's series, of `count` terms, at as many instants.
    void (*values)(const double *terms, int count, const double *time, double *value,
                   double *slope);
    // Copies the first AT_INPUTS places of the arms' own blocks into the lanes of one.
    void (*gather)(double *block, const double *const *own);
    // Evaluates the series of as many arms, each in its lane of the block at its own
    // instant.
    void (*ends)(const double *block, taylor_form form, taylor_instants *at);
    // Evaluates the first `count` pieces for each arm of the block.
    void (*pieces)(const double *block, int order, int count, taylor_pieces *pieces);
} taylor_loops;

extern const taylor_loops taylor_loops_1, taylor_loops_1_avx2;
extern const taylor_loops taylor_loops_2, taylor_loops_4,
    taylor_loops_8; // SSE2, AVX2, AVX-512

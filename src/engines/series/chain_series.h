// The motion of a chain of any number of links as power series of the time since a stride's start:
// the equations of chain.h by coefficient, in a time that grows with N and the square of the order.
//
// Time is counted in units of the stride's length L, so that no coefficient grows out of range:
// x = t/L, velocities w = dq/dx, accelerations a = d2q/dx2, forces times L^2. Of link k, r_k = (c,
// s) has the series
//
//     n c_n = -sum s_i w_(n-1-i),     n s_n = sum c_i w_(n-1-i),
//
// whose second derivative is a t + rho, rho known before a is. Its base is accelerated by A_k, and
// carries the force F_k to the link before:
//
//     A_(k+1) = A_k + l (a_k t_k + rho_k),     F_k = F_(k+1) + m (A_k + l/2 (a_k t_k + rho_k)),
//     I a_k + r_k x G_k = tau_k,               G_k = l/2 (F_k + F_(k+1)),
//
// with l, m and I of link k; beyond the last one F is what a mass at the tip demands.
//
// In the n-th coefficient of each equation, everything but a, A and F follows from earlier
// coefficients (products of series are Cauchy products). For a, A and F the equations are linear,
// with the matrix of the stride's start: the two sweeps of chain.h, F_k = P_k A_k + Q_k, with P_k
// the same for all orders. Only Q and A pass from link to link, each by two multiplications;
// everything else is computed for many links at once.
//
// On a plane the contact force pushes at the tip against a fixed direction e, so F_N = f e; on a
// point it pushes across the last link at the distance D along it, so that F_(N-1) gains f e and
// the last link's moment loses f (D - l/2), where e and D have series of their own. f_n follows
// from the n-th coefficient of d2g/dt2 = 0.
//
// The order of operations does not depend on the width of vectors, so every machine gives the same
// bits.
#pragma once

#include "src/arm/chain.h"
#include "src/engines/series/chain_loops.h"

// A polynomial in x.
typedef struct series_terms {
    double term[SERIES_TERMS];
} series_terms;

// The square of such a polynomial, with all its terms, since the square of a vibration has twice
// its frequency.
typedef struct series_square {
    double term[2 * SERIES_TERMS];
} series_square;

// What a drive's current follows (motor.h).
typedef enum chain_drive {
    DRIVE_FOLLOWS, // the voltage at once
    DRIVE_FLOWS,   // through the inductance
    DRIVE_HELD     // nothing: it is at its limit
} chain_drive;

// Longest stride, as a multiple of one over the fastest rate of modes, decays and wall [-].
#define SERIES_REACH 6.0

typedef struct chain_series {
    int links, order; // order: of the velocities
    contact_state mode;
    double length;                  // L [s]
    double allowed;                 // how far the series are good [s]
    bool damped;                    // the springs lose energy
    bool pinned;                    // the wall alone holds the arm still: friction has no say
    chain_rows rows;                // the links
    size_t first_place, last_place; // of first and last link in an array by link
    double *unit_x, *unit_y;        // by link: A of a unit contact force
    double response;                // of d2g/dt2 to it

    // single functions of x
    series_terms hub_angle, hub_rate;     // of a hub on a spring
    series_terms root_rate;               // of that spring's bend
    series_terms gap;                     // in free flight or within a wall that gives [m]
    series_terms force;                   // in contact, times L^2 [N s2]
    series_terms hold;                    // friction torque on a stuck hub, times L^2 [N m s2]
    series_square hub_square;             // of the hub's w
    series_square dissipation;            // power lost in the springs and air, times L^2 [J s2]
    int square_terms;                     // of these two
    series_terms tip_x, tip_y;            // of the tip [m]
    series_terms reach_x, reach_y, along; // from the last link's base to a point wall, and along it

    // of a wall that gives or a face with a mass
    bool gives;
    bool at_touch, graded;   // next to a touch that is not analytic; by the distance from one
    int graded_order;        // that this asks for
    double turning;          // fastest rate of arm and wall [1/s]
    series_terms power;      // depth to the law's exponent
    series_terms damper;     // what the damper gives, times L^2 [N s2]
    series_square wall_loss; // its power, times L^3 [J s2]

    // of a root that stiffens, and of damping by mode
    series_terms root_bend, root_square;          // [rad], [rad2]
    series_terms mode_rate[PARAMETER_MODES_MOST]; // g'(bend rates)

    // of an electric drive
    chain_drive drive;
    int limit_side;            // of the limit that the current is nearer to or at: 1 or -1
    series_terms current;      // [A]
    series_terms to_limit;     // to it, or of a held one what the voltage would drive beyond [A]
    series_terms to_far_limit; // [A]
    series_square motor_work;  // power of the torque, times L [J]
} chain_series;

// Bytes needed by the series of an arm, the arrays behind it included; places the arrays there.
size_t chain_series_size(const arm *a);
void chain_series_place(chain_series *s, const arm *a);

// How fast the arm's state can change by its own rates, its angles and velocities q[dof], w[dof]
// [1/s].
double chain_series_rate(const arm *a, const double *q, const double *w);

// An arm at its wall, where a stride begins.
typedef struct wall_approach {
    double own_rate, wall_rate; // chain_series_rate; the wall's own or its face's [1/s]
    double depth;               // within a wall that gives, else 0 [m]
    double speed, acceleration; // into the wall [m/s], [m/s2]
    double compliance;          // acceleration by a unit force, in Hunt and Crossley's wall [1/kg]
} wall_approach;

// How far a stride may go [s] by those rates, and by a touch that is not analytic. s->mode and
// s->gives are those of the stride to come.
double chain_series_wall_reach(chain_series *s, const arm *a, const wall_approach *at);

// Adds a face that swings on its own to the gap of the series computed. Returns the part of its
// velocity that the series leave out [m/s]: a decay so fast that it changes the face's position by
// rounding only.
double chain_series_add_face(chain_series *s, const arm *a, wall_face face);

// Says what the current of an electric drive follows in the stride to come, from what it is where
// it is a state of its own [A], and the hub's velocity and acceleration [rad/s], [rad/s2].
void chain_series_choose_drive(chain_series *s, const arm *a, double current, double w,
                               double acceleration);

// Computes the series of an arm from q[dof] and w[dof] [rad/s] in the contact state s->mode, for a
// stride of `length` up to chain_series_wall_reach [s], which comes first; of an electric drive
// after chain_series_choose_drive, with its current in the mode. s->allowed is then that length, or
// less where the last terms are more than rounding: of the velocities, and in free flight of the
// gap's rate over the arm's length, as a share of the largest velocity; of the contact force, of
// its first ones. 0 where they are not finite.
void chain_series_compute(chain_series *s, const arm *a, const double *q, const double *w,
                          double length);

// Coefficient n of w of the first link [rad].
double chain_series_first_rate(const chain_series *s, int n);

// Angles [rad] and angular velocities [rad/s] of all degrees of freedom at t in the stride.
void chain_series_state(const chain_series *s, const arm *a, double t, double *q, double *w);

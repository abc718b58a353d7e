// The parts of the implicit simulation: the arm in a phase, a step, events that end a
// phase.
#pragma once

#include <math.h>
#include <string.h>

#include "src/arm/arm.h"
#include "tests/reference/implicit_arm.h"

#define TINY_GAP 1e-14 // that counts as none [m]

// The state: angles q[n], velocities w[n], the motor's current, depth and velocity of the
// wall's face.
enum { MOST_BODIES = 26, ROWS = MOST_BODIES + 1, MOST = 2 * MOST_BODIES + 3, STAGES = 3 };
enum { SAMPLES = 8 }; // of a step, between which events are looked for

// What holds between events.
typedef struct phase {
    bool contact, parted; // parted: a face without a mass is on its way back
    int friction;         // 0 stuck, 1, -1: sliding
    int limited;          // the current is at its limit, 1 or -1
} phase;

// What a state entails.
typedef struct answer {
    double force, friction;                 // of the wall [N], of the hub [N m]
    double gap, gap_rate, gap_acceleration; // to the wall's place at rest; -g
    double current, free_current;
    double viscous, damping, wall; // power lost [W]
    double work;                   // of the motor [W]
} answer;

// Penetration g, its Jacobian and the part of its second derivative that velocities make.
typedef struct touch {
    double g, rate, velocity_terms;
    double j[MOST_BODIES];
} touch;

// Quadratures along the motion.
enum { SUM_FORCE, SUM_VISCOUS, SUM_DAMPING, SUM_WALL, SUM_WORK, SUM_FRICTION, SUMS };

typedef struct simulation {
    const arm *a;
    int n, first;
    double coupling[MOST_BODIES][MOST_BODIES]; // of links: factor of cos(difference)
    double y[MOST], t, h;
    phase now;
    double sums[SUMS];
    double largest_rate, largest_angle; // scales of what an iteration changes
    double start;                       // angle of all bodies at the start [rad]
    double turned[MOST_BODIES],
        rate[MOST_BODIES]; // scales of errors, each body's largest
    double tolerance;
    double jacobian[MOST][MOST]; // of the rates, at the step's start
    double stage[STAGES][MOST];  // of the step tried: state at the stages
    double end[MOST];            // and at its end
    double added[SUMS];
    double impulses, impact_loss;
    double left; // the wall, at last [s]
    chain_outcome *o;
} simulation;

typedef enum event {
    TOUCHES,
    RELEASES,
    STICKS,
    SLIPS_FORWARD,
    SLIPS_BACKWARD,
    LIMIT,
    EVENTS
} event;

// Factors the n x n matrix m, whose rows are `width` apart, by elimination with pivots,
// and solves with it in place.
void factor(int n, int width, double *m, int *pivot);
void solve_factored(int n, int width, const double *m, const int *pivot, double *b);

// The chain of the arm, and what its wall and inertia are at angles q and velocities w.
void build_chain(simulation *s);
touch touch_at(const simulation *s, const double *q, const double *w);
void mass_matrix(const simulation *s, const double *q, double m[][ROWS]);

// What an impulse of 1 N s of the wall changes: velocities in `change`, the hub's held if
// asked. Returns the change of the penetration's rate [m/s].
double yield_of(const simulation *s, const touch *t, bool held, double change[ROWS]);

// How fast a massless face at `depth` [m] moves that is on its way back [m/s].
double face_return(const wall_model *w, double depth);

// Derivative dy of a state in a phase, and what it entails.
void rate_of(const simulation *s, const phase *p, const double *y, double *dy, answer *r);

// The derivative of the rates by differences, at the step's start.
void find_jacobian(simulation *s);

// A step of length h from s->y: stages, end and quadratures. Returns the error of the
// embedded formula relative to the tolerance, HUGE_VAL where Newton's iteration does not
// converge.
double try_step(simulation *s, double h);

// The collocation polynomial through start and stages at x of the step.
void between_stages(const simulation *s, double x, double *y);

// The first event of the step just tried; its instant in *at [s]. `too_long` asks for a
// shorter step.
event first_event(simulation *s, double h, double *at, bool *too_long);

// The one combination of contact and friction that violates nothing, of two the one in
// contact; `left` was just left and is no candidate.
void resolve(simulation *s, bool touching, event left);

// Goes through an event.
void happen(simulation *s, event e);

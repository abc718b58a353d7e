// The interface of an engine: the integrator that advances the smooth motion within one contact
// state, stride by stride, and answers questions about the stride in hand. The contact machine uses
// every engine through this interface alone.
//
//     begin      prepares a stride from m->state, in its contact state, as long as is asked for or
//                accuracy allows;
//     state_at   gives the state anywhere within the stride: at its end, at an event, at a row;
//     look, bend (dense engines) let locate.h find events and peaks without another stride.
//
// Of a wall that gives an engine follows the arm alone. In contact the wall's law is a force on it
// (wall_force) or, where the face has a mass, one more mass (wall.h); the face goes along. In free
// flight the arm knows nothing of the face, which motion.c moves by its closed form; but gap and
// gap_at are those to it, so that with state_face_swings(m->state)
//
//     gap(h) = wall_face_after(wall, state_face(m->state), h).position - penetration(h),
//
// `bend` counts both, and a stride lasts at most wall_face_lasts(). Just after a release gap and
// rate start at zero, to rounding (motion_gap_edges).
//
// A dense engine provides dense output: after `begin` it holds the whole stride as a function of
// time (a power series, a collocation polynomial), so state_at is one evaluation. A
// stepping engine does not: there state_at takes one step of the method from the stride's start,
// and locate.h repeats such steps to locate events and peaks.
//
// A stride depends only on m->state and on the arguments of `begin`: a motion continued from a copy
// of its state gives the same bits. In particular it must not depend on m->cut, where a step may
// end early. A stride may be longer than the step for which it was begun: what the state keeps of
// it (motion_kept in motion.h) lets the next `begin` continue it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/arm/arm.h"
#include "src/base/fault.h"

typedef struct motion motion;

// Watched functions (event functions): each is positive as long as the present contact state can
// last, and falls below zero where it ends.
typedef enum event_function {
    EVENT_OF_GAP,      // the gap, in free flight; the depth, in contact without a constraint [m]
    EVENT_OF_FORCE,    // the contact force [N]
    EVENT_OF_HUB,      // the hub's velocity in the direction it slides [rad/s]
    EVENT_OF_STICTION, // margin to break-away while the hub sticks, kst - |friction| [N m]
    EVENT_OF_CURRENT,  // margin of an electric drive's current to its limit or, at the limit, to
                       // leaving it [A]; dense engines only: it ends a stride and is no event
    EVENT_FUNCTION_COUNT
} event_function;

// Value and slope of a function at an instant.
typedef struct value_and_slope {
    double value; // in its unit
    double slope; // its derivative by time
} value_and_slope;

// What a state holds.
typedef struct state_energy {
    double kinetic, strain; // [J]
} state_energy;

typedef struct engine {
    const char *name;

    // Prepares a stride from m->state, of an arm that is not held still, at most `remaining` [s]
    // long. `step` is the time step of the method's parameters [s]; an engine that controls its own
    // accuracy ignores it. Returns the stride's length [s], or a value that is not positive if no
    // stride is possible.
    double (*begin)(const arm *a, motion *m, double remaining, double step);

    // Angles, velocities, quadratures, accelerations, algorithmic accelerations, reactions and gap
    // at h in (0, length] into m->trial, whose other slots are set already; in contact the state is
    // projected onto the constraint. STATUS_NEWTON_FAILED or STATUS_UNSTABLE ask for a shorter
    // stride.
    status (*state_at)(const arm *a, motion *m, double h);

    // Dense engines, else NULL. The watched function and its slope at h in [0, length]. Where it
    // starts at zero (after a release, a bounce or a break-away) the engine may divide it by a
    // power of h: that removes the root at the start and keeps the sign and all other roots.
    value_and_slope (*event_function)(const arm *a, const motion *m, event_function w, double h);

    // Dense engines: a bound on the magnitude of the event function's second derivative by time,
    // for h from `from` to `to`. With it, the function is nowhere in between below the lower of its
    // ends less the bound times (to - from)^2 / 8. For stiction the bound is that of the friction
    // torque. It is expensive, and over a part of an interval hardly tighter.
    double (*second_derivative)(const arm *a, const motion *m, event_function w, double from,
                                double to);

    // Dense engines: cheap tests after which most strides need no search. `clear`: the
    // watched function certainly stays above zero up to h; `bounded`: the contact force certainly
    // stays at or below `most` [N]. False means that the test cannot tell.
    bool (*clear)(const arm *a, motion *m, event_function w, double h);
    bool (*bounded)(const arm *a, motion *m, double h, double most);

    // Dense engines: the contact force [N] and its slope [N/s], never divided by a power of h.
    value_and_slope (*force_at)(const arm *a, const motion *m, double h);

    // Dense engines, or NULL: force_at at the start and at the ends of `count` equal pieces of a
    // stride of length h [s], into at[count + 1].
    void (*forces_at)(const arm *a, const motion *m, double h, int count, value_and_slope *at);

    // Dense engines: the gap [m] and its rate [m/s] in free flight and within walls that
    // give, never divided by a power of h.
    value_and_slope (*gap_at)(const arm *a, const motion *m, double h);

    // Dense engines: the hub's angle [rad] and velocity [rad/s].
    value_and_slope (*hub_at)(const arm *a, const motion *m, double h);

    // Dense engines, or NULL: into `state`, at an instant [s] of the last step, what sensors and
    // the history of the force see, as the stride has it and not evaluated: angles, velocities and
    // accelerations of the hub, the first and the last link, SLOT_FORCE and QUADRATURE_FORCE.
    void (*sense_at)(const arm *a, const motion *m, double time, double *state);
    int parabolas; // that represent the force over a whole stride of such an engine

    // Dense engines, or NULL: state_at, to the last bit, for several h at once and from the
    // stride's start in `start`, into states[count], whose other slots are set already, with the
    // energy that each holds. Up to MOTION_TOGETHER; false if this arm's states must be computed
    // one by one.
    bool (*states_at)(const arm *a, motion *m, double *start, const double *h, int count,
                      double *const *states, state_energy *energies);

    // Dense engines, or NULL: state_at into m->state itself, whose other slots stay, and the energy
    // that it holds. Returns false and changes nothing if the state needs projection onto the
    // constraint or is not finite.
    bool (*move_to)(const arm *a, motion *m, double h, state_energy *has);

    // Dense engines: the first event, as dense_search_event (dense_location.h) has it.
    void (*first_event)(const arm *a, motion *m, double *h, event_function *first, bool *any);

    // Engines that can do so without evaluating the state, else NULL: adds to accelerations and
    // reactions of m->state the immediate effect of a change of the motor's torque [N m], while the
    // hub slides and the contact state stays the same.
    void (*retorque)(const arm *a, motion *m, double change);

    // Engines whose states keep more of a stride than KEPT_COUNT (motion.h), else NULL: so many
    // numbers of theirs follow it. Their states keep the energy ledger from the stride's start on.
    size_t (*kept_for)(const arm *a);

    // Engines whose memory grows with the arm, else NULL: bytes needed in m->memory, and the
    // function that initialises them.
    size_t (*memory_for)(const arm *a);
    void (*open)(const arm *a, motion *m);

    // Truncation error of the gap's acceleration at a release, as a multiple of the additional
    // rounding of stiff or fast arms (motion_rounding beyond 1); 0: nothing beyond rounding.
    double left_out;

    size_t link_scratch; // bytes needed in m->sweeps for each link
    size_t memory_size;  // bytes needed in m->memory, aligned to a cache line
} engine;

extern const engine newmark_engine;           // implicit, stepping
extern const engine generalized_alpha_engine; // the same step with other coefficients

extern const engine taylor_engine; // power series of the two-link arm; dense
extern const engine stiff_engine;  // Radau IIA of seven stages for every arm; dense

// Whether the two-link power series can integrate the arm: two links, hub joint and damping of any
// kind, and a rigid wall that is a point, a plane or none.
bool taylor_engine_suits(const arm *a);

// Whether the engine has dense output: events and peaks are located without further steps.
static inline bool engine_is_dense(const engine *e)
{
    return e->force_at != NULL;
}

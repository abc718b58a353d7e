// The interface of an engine: the integrator that advances the smooth motion within one
// contact state, internal step by internal step, and answers questions about the internal
// step in hand. The contact machine uses every engine through this interface alone.
//
//     init            how much memory it needs, and its contents at first;
//     advance         takes a step from m->state, in its contact state, as long as is
//     asked for or
//                     accuracy allows: the internal step;
//     state_at        the state anywhere within it: at its end, at an event, at a row.
//
// A dense engine has dense output: after `advance` it holds the whole internal step as a
// function of time (a power series, a collocation polynomial), so state_at is one
// evaluation, and
//
//     states_at, dense_output     give several states at once, or the course of one
//     quantity; event_function, second_derivative, excludes_event, first_event
//                     locate events by finding roots (locate.h), without another internal
//                     step.
//
// In a stepping engine state_at takes one step of the method from the internal step's
// start, and locate.h repeats such steps to locate events and peaks.
//
// Of a wall that gives an engine follows the arm alone. In contact the wall's law is a
// force on it (wall_force) or, where the face has a mass, one more mass (wall.h); the
// face goes along. In free flight the arm knows nothing of the face, which motion.c moves
// by its closed form; but gaps are those to it, so that with state_face_swings(m,
// m->state)
//
//     gap(h) = wall_face_after(wall, state_face(m->state), h).position - penetration(h),
//
// the second derivative is that of both, and an internal step lasts at most
// wall_face_lasts(). Just after a release gap and rate start at zero, to rounding
// (motion_gap_edges).
//
// An internal step depends only on m->state and on the arguments of `advance`: a motion
// continued from a copy of its state gives the same bits. In particular it must not
// depend on m->record.tstop, where a step may end early. An internal step may be longer
// than the step for which it was begun: what the state keeps of it (motion_kept in
// motion.h) lets the next `advance` continue it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/arm/arm.h"
#include "src/base/fault.h"

typedef struct motion motion;

// Divides one block of memory into parts, each on cache lines of its own. Adding parts
// without a block first gives the size that the block needs.
enum { CACHE_LINE = 64 }; // [bytes]
typedef struct layout {
    char *block;   // NULL: there is none yet
    size_t length; // [bytes]
} layout;

static inline void *layout_add(layout *l, size_t size)
{
    void *part = l->block != NULL ? l->block + l->length : NULL;
    l->length += (size + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    return part;
}

// Event functions: each is positive as long as the present contact state can
// last, and falls below zero where it ends.
typedef enum event_function {
    EVENT_OF_GAP,   // the gap, in free flight; the depth, in contact without a constraint
                    // [m]
    EVENT_OF_FORCE, // the contact force [N]
    EVENT_OF_HUB,   // the hub's velocity in the direction it slides [rad/s]
    EVENT_OF_STICTION, // margin to break-away while the hub sticks, kst - |friction| [N
                       // m]
    EVENT_OF_CURRENT,  // margin of an electric drive's current to its limit or, at the
                      // limit, to leaving it [A]; dense engines only: it ends an internal
                      // step and is no event
    EVENT_FUNCTION_COUNT
} event_function;

// How far a step goes, and whether an event ends it.
typedef struct step_end {
    double length;        // up to there [s]
    bool any;             // an event ends it
    event_function first; // that event's
} step_end;

// Value and slope of a function at an instant.
typedef struct value_and_slope {
    double value; // in its unit
    double slope; // its derivative by time
} value_and_slope;

// What a state holds.
typedef struct state_energy {
    double kinetic, strain; // [J]
} state_energy;

// How much of a state is wanted: all of it, or what sensors and the history of the force
// see of it, angles, velocities and accelerations of the hub, the first and the last
// link, SLOT_FORCE and QUADRATURE_FORCE. An engine may always give all.
typedef enum state_extent { STATE_WHOLE, STATE_SENSED } state_extent;

// Quantities of dense output.
typedef enum output_quantity {
    OUTPUT_FORCE, // of the contact [N]
    OUTPUT_GAP,   // in free flight and within walls that give [m]
    OUTPUT_HUB,   // the hub's angle [rad]
} output_quantity;

typedef struct engine {
    const char *name;

    // Initialises the engine's memory, which is aligned to a cache line; NULL: does
    // nothing. Returns the bytes that it needs.
    size_t (*init)(const arm *a, void *memory);

    // Prepares an internal step from m->state, of an arm that is not held still, at most
    // `remaining` [s] long. `step` is the time step of the method's parameters [s]; an
    // engine that controls its own accuracy ignores it. Returns the internal step's
    // length [s], or a value that is not positive if no internal step is possible. A
    // dense engine sets m->most_force.
    double (*advance)(const arm *a, motion *m, double remaining, double step);

    // Angles, velocities, quadratures, accelerations, algorithmic accelerations,
    // reactions and gap at h in (0, length] into m->trial, whose other slots are set
    // already; in contact the state is projected onto the constraint.
    // STATUS_NEWTON_FAILED or STATUS_UNSTABLE ask for a shorter internal step.
    status (*state_at)(const arm *a, motion *m, double h, state_extent extent);

    // Dense engines, or NULL: state_at, to the last bit, for several h at once, up to
    // MOTION_TOGETHER, into states[count], whose other slots are set already, with the
    // energy that each holds.
    void (*states_at)(const arm *a, motion *m, const double *h, int count,
                      double *const *states, state_energy *energies);

    // Dense engines, else NULL: a quantity and its slope at h = `from` in the internal
    // step and at the ends of `count` equal pieces of what lies between `from` and `to`
    // [s], into at[count + 1].
    void (*dense_output)(const arm *a, motion *m, output_quantity of, double from,
                         double to, int count, value_and_slope *at);

    // Dense engines. The event function and its slope at h in [0, length]. Where it
    // starts at zero (after a release, a bounce or a break-away) the engine may divide it
    // by a power of h: that removes the root at the start and keeps the sign and all
    // other roots.
    value_and_slope (*event_function)(const arm *a, const motion *m, event_function w,
                                      double h);

    // Dense engines: a bound on the magnitude of the event function's second derivative
    // by time, for h from `from` to `to`. With it, the function is nowhere in between
    // below the lower of its ends less the bound times (to - from)^2 / 8. For stiction
    // the bound is that of the friction torque. It is expensive, and over a part of an
    // interval hardly tighter.
    double (*second_derivative)(const arm *a, const motion *m, event_function w,
                                double from, double to);

    // Dense engines: a cheap test after which most internal steps need no search: the
    // event function certainly stays above zero to the internal step's end. False means
    // that the test cannot tell.
    bool (*excludes_event)(const motion *m, event_function w);

    // Dense engines: the first event, as dense_search_event (locate.h) has it.
    void (*first_event)(const arm *a, motion *m, step_end *end);

    // Engines that can do so without evaluating the state, else NULL: adds to
    // accelerations and reactions of m->state the immediate effect of a change of the
    // motor's torque [N m], while the hub slides and the contact state stays the same.
    void (*retorque)(const arm *a, motion *m, double change);

    // Numbers that states keep of an internal step behind KEPT_COUNT (motion.h), and more
    // for each body. Where there are any, states keep the energy ledger from the internal
    // step's start on.
    int kept, kept_for_body;

    bool implicit; // a stepping engine of an implicit method, which takes steps of any
                   // length

    int parabolas; // that represent the force over a whole internal step, 0 if that is
                   // not known

    // Truncation error of the gap's acceleration at a release, as a multiple of the
    // additional rounding of stiff or fast arms (motion_rounding beyond 1); 0: nothing
    // beyond rounding.
    double left_out;
} engine;

// Whether the engine has dense output: events and peaks are located without further
// steps.
static inline bool engine_is_dense(const engine *e)
{
    return e->dense_output != NULL;
}

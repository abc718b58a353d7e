// An engine: what advances the smooth motion of one contact state, and what it can tell of the
// stride it is in. The contact machine stands above all engines and knows nothing else of them.
//
//     begin      prepares a stride from m->state, in its contact state, as long as is asked for or
//                accuracy allows;
//     state_at   gives the state anywhere within the stride: at its end, at an event, at a row;
//     look, bend (dense engines) let locate.h find events and peaks without another stride.
//
// A dense engine has the whole stride in hand after `begin` (a series, a collocation polynomial, a
// sum of modes), so state_at costs an evaluation. A stepping engine has not: there state_at is a
// step of the method from the stride's start, and locate.h steps again for all it looks for.
//
// A stride depends on m->state and on what `begin` is given, on nothing else: a motion that goes on
// from a copy of its state goes on with the same bits. m->cut, where a stride may be broken off, is
// not to enter it. A stride may outlive the step that it is begun for: what the state keeps of it
// (motion.h) lets `begin` go on with it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/arm/arm.h"
#include "src/base/status.h"

typedef struct motion motion;

// Functions that are positive while the mode the motion is in may last.
typedef enum watch {
    WATCH_GAP,      // the gap, in free flight [m]
    WATCH_FORCE,    // the contact force [N]
    WATCH_HUB,      // the hub's velocity in the direction it slides [rad/s]
    WATCH_STICTION, // what friction has left while the hub sticks, kst - |friction| [N m]
    WATCH_CURRENT,  // what an electric drive's current has left to its limit, or to leave it [A];
                    // dense engines, whose strides end there: no event
    WATCHES
} watch;

// A function at an instant.
typedef struct glance {
    double value; // in its unit
    double slope; // its derivative by time
} glance;

// What a state holds.
typedef struct state_energy {
    double kinetic, strain; // [J]
} state_energy;

typedef struct engine {
    const char *name;

    // Prepares a stride from m->state, an arm that is not held still. It is not to go beyond
    // `remaining` [s]; `step` is the time step of the method's parameters [s], which an engine that
    // controls its own accuracy passes over. Returns its length [s], or a value that is not
    // positive if none can be made.
    double (*begin)(const arm *a, motion *m, double remaining, double step);

    // Angles, velocities, quadratures, accelerations, algorithmic accelerations, reactions and gap
    // at h in (0, length] into m->trial, whose other slots are set already; in contact the state is
    // back on the constraint. STATUS_NEWTON_FAILED or STATUS_UNSTABLE ask for a shorter stride.
    status (*state_at)(const arm *a, motion *m, double h);

    // Dense engines, else NULL. The watched function and its slope at h in [0, length]. Where it
    // begins at its edge (a release, a bounce, a break-away) the engine may divide it by a power of
    // h, so that it begins off the edge and has the same sign and roots else.
    glance (*look)(const arm *a, const motion *m, watch w, double h);

    // Dense engines: a bound on the magnitude of the second derivative by time of what `look` gives
    // for h from `from` to `to`. With it, the function is nowhere in between below the lower of its
    // ends less bend (to - from)^2 / 8. For stiction the bound is that of the friction torque.
    double (*bend)(const arm *a, const motion *m, watch w, double from, double to);
    bool bends_from_start; // that bound is hardly tighter for a part of the stride, and dear

    // Dense engines, or NULL: cheap tests that spare most strides the search. Whether the watched
    // function certainly stays above zero up to h; whether the contact force certainly stays at
    // `most` [N] or below. False says nothing.
    bool (*clear)(const arm *a, motion *m, watch w, double h);
    bool (*bounded)(const arm *a, motion *m, double h, double most);

    // Dense engines: the contact force [N] and its slope [N/s], never divided by anything.
    glance (*force_at)(const arm *a, const motion *m, double h);

    // Dense engines, or NULL: force_at at the start and at the ends of `count` equal pieces of a
    // stride of length h [s], into at[count + 1].
    void (*forces_at)(const arm *a, const motion *m, double h, int count, glance *at);

    // Dense engines, or NULL: the gap [m] and its rate [m/s] in free flight and within walls that
    // give, never divided by anything.
    glance (*gap_at)(const arm *a, const motion *m, double h);

    // Dense engines whose strides outlive steps, or NULL: the hub's angle [rad] and velocity
    // [rad/s].
    glance (*hub_at)(const arm *a, const motion *m, double h);

    // Dense engines, or NULL: state_at, to the last bit, for several h at once and from the
    // stride's start in `start`, into states[count], whose other slots are set already, with the
    // energy that each holds. Up to MOTION_TOGETHER; false if the arm's state has to be taken one
    // by one.
    bool (*states_at)(const arm *a, motion *m, double *start, const double *h, int count,
                      double *const *states, state_energy *energies);

    // Dense engines, or NULL: state_at into m->state itself, whose other slots stay, and the energy
    // that it holds. False, and nothing done, where the state is to be put back on the constraint
    // or is not finite.
    bool (*move_to)(const arm *a, motion *m, double h, state_energy *has);

    // Dense engines that have ways of their own, else NULL: what dense_first_event and dense_peak
    // of dense_location.h do.
    void (*first_event)(const arm *a, motion *m, double *h, watch *first, bool *any);
    void (*peak)(const arm *a, motion *m, double h);

    // Engines that know it without evaluating the state, else NULL: adds to accelerations and
    // reactions of m->state what a change of the motor's torque [N m] does to them at once, the hub
    // sliding, in the same contact state.
    void (*retorque)(const arm *a, motion *m, double change);

    // Engines whose memory grows with the arm, else NULL: bytes it wants in m->memory, and what
    // prepares them.
    size_t (*memory_for)(const arm *a);
    void (*open)(const arm *a, motion *m);

    // How many times more than rounding in stiff or fast arms (motion_rounding beyond 1) its states
    // lack of the gap's acceleration at a release; 0: no more.
    double left_out;

    size_t link_scratch; // bytes a link that it wants in m->sweeps
    size_t memory_size;  // bytes, aligned to a cache line, that it wants in m->memory
} engine;

extern const engine newmark_engine;           // implicit, stepping
extern const engine generalized_alpha_engine; // the same step with other coefficients

extern const engine series_engine; // power series of chains; dense
extern const engine modal_engine;  // exponential collocation for chains of many links; dense
extern const engine taylor_engine; // power series of the two-link arm; dense

// Whether the arm is one that the power series are for: two links, hub joint and damping of any
// kind, and a rigid wall that is a point, a plane or none.
bool taylor_engine_suits(const arm *a);

// Whether events and peaks are found in the stride itself.
static inline bool engine_is_dense(const engine *e)
{
    return e->force_at != NULL;
}

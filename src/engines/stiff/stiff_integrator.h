// The step in hand of the stiff engine (stiff_engine.c): how its stages are solved
// (stiff_stages.c), what it tells (stiff_output.c), and what of it a state keeps.
#pragma once

#include "src/engines/stiff/stiff_function.h"
#include "src/engines/stiff/stiff_step.h"

// What a state keeps of the step that it lies in or ends, behind KEPT_COUNT: all that its
// course and the next step depend on. Stages are those of RADAU_LANES.
enum stiff_kept {
    STIFF_LENGTH =
        KEPT_COUNT, // of the stages' step; up to rounding that of an event's end [s]
    STIFF_EVENT,    // 1 + the event function whose event ends it, or 0
    STIFF_NEXT,     // length proposed for the next step [s]
    STIFF_RATE,     // of Newton's iteration
    STIFF_SCALE,    // largest momentum so far, that errors are a share of [kg^(1/2) m/s]
    STIFF_LEARNED,  // length of the next step after an event [s]
    STIFF_GAP,      // at the step's end, as it grew since it was zero [m]
    STIFF_DRIVE,    // which of the drive's equations holds
    STIFF_TIME,     // of the step's start [s]
    STIFF_WORK,     // SLOT_MOTOR_WORK there [J]
    STIFF_RUBBED,   // SLOT_FRICTION_LOSS there [J]
    STIFF_FACE,     // place and velocity of a wall's face there [m], [m/s]
    STIFF_QUADRATURES = STIFF_FACE + 2,                  // at the step's start
    STIFF_VALUES = STIFF_QUADRATURES + QUADRATURE_COUNT, // those of stiff_step
    STIFF_GAPS = STIFF_VALUES +
                 STIFF_STAGE_VALUES * RADAU_LANES, // the gap's Bernstein coefficients [m]
    STIFF_HEAD = STIFF_GAPS + FUNCTION_MOST
    // then angles and velocities at the start [dof], accelerations at the stages
    // [dof][RADAU_LANES]
};

typedef struct stiff_integrator {
    stiff_step step;
    const stiff_loops *loops;
    double tolerance; // of a step's error, as a share of STIFF_SCALE
    double *kept;     // of the step in hand, as a state has it
    bool known;       // whether there is one
    double used;      // of it before m->state [s]

    // what the contact machine watches
    stiff_function function[EVENT_FUNCTION_COUNT], force, gap;
    stiff_function far[EVENT_FUNCTION_COUNT]; // the farther limit of stiction or current
    bool divided[EVENT_FUNCTION_COUNT];
    double stiction_excess; // than stiction, just after an event [N m]
    double *end;            // state at the step's end, without what it keeps
    bool ended;             // whether it is that
    bool turned;            // the step begins where the drive's equation changes
    int passed;             // 1 + the event function that a search leaves out, or 0

    double *scratch[4]; // [dof]
} stiff_integrator;

static inline double *
stiff_force(const stiff_integrator *s) // contact force at the stages [N]
{
    return s->kept + STIFF_VALUES + QUADRATURE_FORCE * RADAU_LANES;
}
static inline double *stiff_angles(const stiff_integrator *s)
{
    return s->kept + STIFF_HEAD;
}
static inline double *stiff_velocities(const stiff_integrator *s)
{
    return s->kept + STIFF_HEAD + s->step.dof;
}
static inline double *stiff_accelerations(const stiff_integrator *s)
{
    return s->kept + STIFF_HEAD + 2 * s->step.dof;
}

// Numbers of a state behind KEPT_COUNT, and bytes of it before what it keeps.
static inline size_t stiff_kept_size(const arm *a)
{
    return (size_t)(STIFF_HEAD - KEPT_COUNT) + (size_t)a->dof * (2 + RADAU_LANES);
}
static inline size_t stiff_head_size(const motion *m)
{
    return (SLOT_COUNT + 4 * (size_t)m->dof + QUADRATURE_COUNT) * sizeof(double);
}

// --- stiff_stages.c --------------------------------------------------------------------

// The arm in its contact state, and the state at the step's start.
void stiff_set_arm(stiff_integrator *s, const arm *a, const motion *m);
void stiff_set_start(stiff_integrator *s, motion *m);

// Solves the stages of a step of s->step.length: with the accelerations that the step
// kept has at `offset` + `ratio` c of its length, or none where `fresh`. *rate: of the
// iteration. False if that does not converge.
bool stiff_solve_stages(stiff_integrator *s, bool fresh, double offset, double ratio,
                        double *rate);

// Puts the stages into what is kept.
void stiff_keep_stages(stiff_integrator *s);

// Error of the step, as the embedded formula of order 7 shows it, filtered by the real
// system; a momentum as STIFF_SCALE is.
double stiff_error(stiff_integrator *s, bool twice);

// Momentum of velocities of the arm stretched out [kg^(1/2) m/s].
double stiff_momentum(const stiff_integrator *s, const double *w);

// --- stiff_output.c --------------------------------------------------------------------

// The event functions of the step, which begins at m->state.
void stiff_event_functions(stiff_integrator *s, const arm *a, const motion *m);

// Angles, velocities and what has added up at `time` [s] after the step's start,
// evaluated.
void stiff_state_within(const stiff_integrator *s, const arm *a, motion *m, double time,
                        double *state);

// An event function and its slope at x of the step, the nearer of two limits.
value_and_slope stiff_watched_at(const stiff_integrator *s, event_function w, double x);

// The engine's functions of these names (engine.h).
status stiff_state_at(const arm *a, motion *m, double h, state_extent extent);
void stiff_dense_output(const arm *a, motion *m, output_quantity of, double from,
                        double to, int count, value_and_slope *at);
value_and_slope stiff_event_function(const arm *a, const motion *m, event_function w,
                                     double h);
double stiff_second_derivative(const arm *a, const motion *m, event_function w,
                               double from, double to);
bool stiff_excludes_event(const motion *m, event_function w);
void stiff_first_event(const arm *a, motion *m, step_end *end);

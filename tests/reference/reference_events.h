// Steps of the independent simulation within one contact mode, and the functions whose
// signs end it.
#pragma once

#include <gsl/gsl_odeiv2.h>

#include "tests/reference/reference_bodies.h"

#define GAP_ROUNDING 1e-15 // of a gap [m]

typedef struct flow {
    const body_chain *arm;
    contact_mode mode;
} flow;

typedef struct simulation {
    const reference_case *c;
    body_chain arm;
    flow flow;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver;
    int size;
    double time;
    double y[STATE_MAX];
    double span;              // of the present step [s]
    double middle[STATE_MAX]; // state half way through it
    double end[STATE_MAX];    // and at its end
    double impact_loss;
    double start_energy; // kinetic [J]
    double impulses;     // of all impacts [N s]
    double phase_gap;    // largest gap of the present free phase
    double steady_from;  // integral of the force where the steady window begins
    bool in_first_pulse;
    int idle_events; // events in a row without time passing
    reference_answer *answer;
    char *message;
    int message_size;
} simulation;

// Functions that are positive while the mode lasts.
typedef enum event_function {
    GAP_OPEN,
    FORCE_PRESSES,
    HUB_MOVES,
    HUB_HELD,
    EVENT_FUNCTIONS
} event_function;

// The equations of motion as gsl wants them.
int simulation_derivative(double t, const double y[], double dydt[], void *context);

// Writes what went wrong and when into the message; false.
bool simulation_complain(simulation *s, const char *what);

// State after tau from `from`, in the present mode.
bool simulation_advance(simulation *s, const double *from, double tau, double *to);

// Brings a touching state back onto gap = 0 and rate of gap = 0, the hub held if it
// sticks.
bool simulation_project(simulation *s, double *y);

// The contact force of a state in the present mode [N].
double simulation_force(simulation *s, const double *y);

// Whether a function can end a mode.
bool event_active(contact_mode mode, event_function e);

// Value of an event function tau after the step's beginning.
double event_value_at(simulation *s, event_function e, double tau);

// Golden-section search over [lo, hi] for the least value of sign * (event function).
double extreme_at(simulation *s, event_function e, double sign, double lo, double hi);

// Where the parabola through three equally spaced values has its extremum, in units of
// the whole interval; NaN if it is straight.
double parabola_vertex(double v0, double vm, double v1);

// Looks for the first zero of one event function in the present step; returns its offset,
// just past the zero, or NEVER.
double event_offset(simulation *s, event_function e);

// A run that a program steps: to an instant, with inputs in between, and back to a state
// it kept.
//
// It is a run like any other, observed at the requested instants; stepped from sample to
// sample of the rig it equals the uninterrupted run to the last bit, cut elsewhere to
// rounding (1e-16). Such instants do not influence the choice of steps: a step that goes
// beyond one is cut there or, in flight on the rig, continues (corrected.h); the printed
// model, which has no states between the ends of its steps, stops at the end of the first
// step that reaches it. What is due at an instant (a sample of the rig, an action of the
// script) happens when the loop continues from it.
#pragma once

#include "src/rig/rig.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

typedef struct run_loop run_loop;

typedef struct loop_options {
    bool keep_trace;      // rows are kept
    bool commanded;       // the rig's command is what loop_command says, in the place of
                          // control.law
    struct given_law law; // in the place of control.law, if law.law is not NULL
    int (*ask)(
        void *context); // asked whether to stop before the instant; NULL: nobody is asked
    void *ask_context;
} loop_options;

// Wherever something may fail, f says why and is not NULL.

// Begins at the start. On failure f says why and there is nothing to be destroyed. The
// scenario is copied.
status loop_create(run_loop **created, const scenario *s, const loop_options *options,
                   fault *f);
void loop_destroy(run_loop *l); // l may be NULL

// Where it is [s], and whether it has come to the end of run.duration.
double loop_time(const run_loop *l);
bool loop_ended(const run_loop *l);

// Continues to an instant [s], at most to run.duration; one that is not later changes
// nothing. What ended the run stays: every further call returns it again. STATUS_STOPPED,
// if `ask` asked for it, does not: the loop stands between two steps, from where the next
// call goes on.
status loop_until(run_loop *l, double time, fault *f);
// Continues to the next sample of the rig, without one to the next multiple of
// method.step.
status loop_step(run_loop *l, fault *f);

// The command that a commanded loop puts out from its next sample on, until the next call
// [V].
void loop_command(run_loop *l, double volts);
// Gives a parameter that may change during a run another value, now.
status loop_set_number(run_loop *l, int parameter, double value, fault *f);
status loop_set_text(run_loop *l, int parameter, const char *text, fault *f);
// The same of one number of control.settings.
status loop_set_setting(run_loop *l, const char *name, double value, fault *f);
// An impulse at the tip, across the last link, now [N s]. STATUS_BAD_ARGUMENT for the
// printed model, which takes none.
status loop_push(run_loop *l, double impulse, fault *f);

// What the sensors read: of the sample due now, which the controller will be given, else
// of the last one. False without a rig.
bool loop_sense(run_loop *l, sensor_reading *reading);
// The present state as a row.
sample loop_row(run_loop *l);
// Angles of all degrees of freedom [rad], then their velocities [rad/s]; good until the
// loop goes on.
const double *loop_state(const run_loop *l, int *angle_count);

// What the run comes to so far; the status is STATUS_STOPPED until it has ended.
summary loop_summary(run_loop *l);
// Rows and events so far. Not its summary.
const run_result *loop_result(const run_loop *l);
// The scenario that is run.
const scenario *loop_scenario(const run_loop *l);

// The whole state as one block of bytes, for loops of the same scenario, program and
// machine. Rows, and what takes a whole run to know (settling time, smoothed force), are
// not part of it.
size_t loop_saved_size(const run_loop *l);
void loop_save(const run_loop *l, void *bytes);
// Goes back (or forth) to such a state; rows that are later than it are dropped.
// STATUS_BAD_ARGUMENT, and nothing is changed, if the bytes are damaged, of another
// scenario or version, or of a plug-in's loop that is not this one, whose memory may hold
// addresses; or if the controller is a process, which cannot go back.
status loop_restore(run_loop *l, const void *bytes, size_t size, fault *f);

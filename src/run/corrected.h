// A run of the corrected arm, step by step:
//
//     open -> (approach_step -> corrected_step) until it has ended or fails -> finish
//
// so that several can go side by side (src/run/run.c), and programs step them
// (src/run/loop.h).
#pragma once

#include "src/run/recording.h"
#include "src/contact/contact_machine.h"
#include "src/contact/motion.h"
#include "src/contact/zeno_monitor.h"

// A point on the way along a step: the instant, and what the sensors see there.
typedef struct sample_point {
    double time; // [s]
    sensed_motion at;
    double integral; // of the force [N s]
} sample_point;

// A step that continues beyond instants at which the run is observed: samples of the rig
// that change nothing, stops of a program. The motion still stands at the step's start
// and knows how far the step goes (m->step.coming; m->trial is a copy, as after a step);
// the run has come to an instant within it.
typedef struct open_step {
    bool goes_on;        // there is one
    double begun_for;    // the stop that it was begun for [s]
    double now;          // the run's instant [s]
    sample_point sensed; // up to where the sensors have followed the arm
} open_step;

// The stretch of motion between two stops of script, rig or window.
typedef struct stretch {
    double stop;       // where it ends at the latest, 0 before the first [s]
    double last_event; // in it, -1 if none [s]
    int at_once;       // events in a row without time passing
    open_step open;
} stretch;

typedef struct corrected_run {
    recording *recording;
    motion *motion;

    stretch stretch;   // that the motion is in
    zeno_monitor zeno; // of the whole run
    wall_path *path;   // of a wall that a file moves, else NULL
    arm arm;           // with the command in force
} corrected_run;

// The instant that the run has come to [s].
static inline double corrected_now(const corrected_run *c)
{
    return c->stretch.open.goes_on ? c->stretch.open.now : c->motion->state[SLOT_TIME];
}

// Begins a run, or takes one up, in the storage of a motion that is over (`spare`, which
// may be NULL and is used up). Whatever it returns, corrected_finish is due.
status corrected_open(corrected_run *c, recording *r, motion *spare, fault *f);

// Carries out what is due of script and rig until the next thing to do is a step, to
// c->stop at most; *ended is true if the run is complete instead.
status corrected_approach_step(corrected_run *c, bool *ended, fault *f);

// Sums up what is known of a run that has not come to its end (`failed` says if it
// failed) and that afterwards continues unchanged; the caller has to save and restore
// rows, events and recording.state.
void corrected_sum_up(corrected_run *c, status failed);

// Sums the run up, `failed` being what ended it, and frees it but for its motion's
// storage, which it returns: NULL if there is none.
motion *corrected_finish(corrected_run *c, status failed);

// --- a step, from where it is begun to what comes of its end ---------------------------

// Looks how far the next step goes (motion_examine_step), in flight beyond the instants
// of samples: it is under way then. Of an arm that a dense engine moves and nothing holds
// still.
void corrected_begin_step(corrected_run *c);

// Continues by one step, recorded with the event at its end: to the end of the stretch
// or, cut there, to `until` [s] at the most. What fails is explained in f.
status corrected_step(corrected_run *c, double until, fault *f)
    __attribute__((warn_unused_result));

// Ends the step under way, if there is one, at the instant that the run has come to.
status corrected_end_step(corrected_run *c, fault *f) __attribute__((warn_unused_result));

// The present state, as good as the next call of any function here or of the motion.
double *corrected_present(const corrected_run *c);

// What the sensors are fixed to at present.
sensed_motion corrected_sensed_now(const corrected_run *c);

// Carries out an action that belongs to no script, now.
status corrected_act_now(corrected_run *c, const action *todo, fault *f);

// The whole state but for recording and rig as bytes; and back, after recording and rig
// were restored.
size_t corrected_saved_size(const corrected_run *c);
void corrected_save(const corrected_run *c, void *bytes);
void corrected_restore(corrected_run *c, const void *bytes);

// --- between steps: events, the script, commands of the rig ----------------------------

// Derives the arm's constants from the parameters as they are now; the command in force
// stays.
void corrected_bind_arm(corrected_run *c);

// To be called of a run that begins: one that starts at rest on the wall is in its first
// contact, which no event begins. STATUS_NO_MEMORY.
status corrected_begin_in_contact(corrected_run *c);

// The first pulse is over: takes note of its length and of the largest force until now.
void corrected_close_first_pulse(corrected_run *c);

// The same of the landing's pulse.
void corrected_close_landing(corrected_run *c);

// The bounds [N] of a force into two numbers of the summary, which stay as they are where
// it is determined.
void corrected_tell_bounds(force_bounds bounds, double *low, double *high);

// Applies an event that the motion stopped at and records the rows on its both sides.
status corrected_pass_event(corrected_run *c, motion_report *report);

// Carries out one action now and records it as action `index` of the script (-1: of no
// script); the rows on its both sides show what it changed.
status corrected_act(corrected_run *c, const action *todo, int index, fault *f);

// Carries out the script's actions that are due. A failure is explained in f, or has a
// code only.
status corrected_run_script(corrected_run *c, fault *f);

// What the rig has done at this instant shows from here on: its sample, if it took one,
// and where the command `changed` the torque, and with it accelerations and force.
// Records the rows on both sides of the jump; there is none before the start.
status corrected_pass_sample(corrected_run *c, bool changed);

// --- what is recorded after every step -------------------------------------------------

// Records the residual of the energy balance. STATUS_UNSTABLE if the run gains energy,
// STATUS_NOT_FINITE if an energy is not finite.
status corrected_audit(corrected_run *c) __attribute__((warn_unused_result));

// The row of a state of the motion.
sample corrected_row(const corrected_run *c, double *state);

// Adds a row of a state of the motion, at which an impulse [N s] acts or none, if the run
// keeps rows. STATUS_NO_MEMORY.
status corrected_record_row(corrected_run *c, double *state, double impulse)
    __attribute__((warn_unused_result));

// Records the rows of the grid up to an instant [s] within the step under way.
// STATUS_NOT_FINITE if a state cannot be had, STATUS_NO_MEMORY, STATUS_STOPPED.
status corrected_record_rows_to(corrected_run *c, double time)
    __attribute__((warn_unused_result));

// Records the step just made: force, separation, ledger, and the rows of the grid that
// lie within it; of one at its end only if there is no event, which records rows of its
// own.
status corrected_record_step(corrected_run *c, bool at_event)
    __attribute__((warn_unused_result));

// --- a step's force and what the sensors see of it, in pieces --------------------------

// What the sensors are fixed to, in a state of the motion.
sensed_motion corrected_sensed_motion(const corrected_run *c, double *state);

// The point on the way that a state of the motion is.
sample_point corrected_sample_point_at(const corrected_run *c, double *state);

// Into how many pieces the force over a step in contact of this length [s] is divided for
// recording.
int corrected_force_pieces(const corrected_run *c, double length);

// Lets the sensors follow the arm within the step under way, which is in flight, to where
// it has come to `to`. STATUS_NOT_FINITE if a state on the way cannot be computed.
status corrected_follow_flight(corrected_run *c, const sample_point *to)
    __attribute__((warn_unused_result));

// Lets the sensors follow the arm over the step just made, or over what is left of it,
// and keeps its force. STATUS_NOT_FINITE as above, STATUS_NO_MEMORY.
status corrected_record_forces(corrected_run *c) __attribute__((warn_unused_result));

// --- what it comes to ------------------------------------------------------------------

// Sums up what is known of the run, also of one that failed or has not come to its end
// (`failed` then says so). What it has recorded is then that of a run that ended here.
void corrected_summarise(corrected_run *c, status failed);

// Says when and how the run failed, with the method's name. Returns s.
status corrected_explain(const corrected_run *c, status s, fault *f);

// Says why the motion could not make a step. Returns s.
status corrected_explain_step(const corrected_run *c, status s, fault *f);

// Says that the run no longer passes time after that event, and what makes it so. Returns
// STATUS_NO_PROGRESS.
status corrected_explain_standstill(const corrected_run *c, motion_event last, fault *f);

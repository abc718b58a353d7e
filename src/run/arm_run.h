// A run of the corrected arm, step by step:
//
//     open -> (prepare_step -> step) until it has ended or fails -> finish
//
// so that several can go side by side (src/run/together.c), and programs step them
// (src/run/run_loop.h).
//
// A run is made of parts. One file writes each of them: the others read a part, or call
// the function that changes it. Each file calls those below it alone, and has a section
// here.
//
//     arm_run.c          segment, under_way, zeno
//     arm_run_summary.c  none: it reads all of them
//     arm_run_inputs.c   arm, path, recording.state.next_action
//     arm_run_events.c   recording.state.contact
//     arm_run_rows.c     recording.state.rows
//     arm_run_forces.c   recording.state.force
//
// The motion moves by its own functions (src/contact/motion.h): arm_run.c makes its
// steps, arm_run_events.c applies the events that these end at, and arm_run_inputs.c what
// acts on the arm from outside.
#pragma once

#include "src/run/recording.h"
#include "src/run/run_model.h"
#include "src/contact/motion.h"
#include "src/contact/zeno_monitor.h"

// The motion between two instants at which script, rig or the window of the steady force
// are due.
typedef struct run_segment {
    double stop;         // where it ends at the latest, 0 before the first [s]
    double last_event;   // in it, -1 if none [s]
    int events_in_a_row; // without time passing between them
} run_segment;

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
typedef struct step_under_way {
    bool exists;
    double begun_for;      // the stop that it was begun for [s]
    double time;           // the run's instant [s]
    sample_point followed; // up to where the sensors have followed the arm
} step_under_way;

typedef struct arm_run {
    recording *recording;
    motion *motion;

    run_segment segment; // that the motion is in
    step_under_way under_way;
    zeno_monitor zeno; // of the whole run
    wall_path *path;   // of a wall that a file moves, else NULL
    arm arm;           // with the command in force
} arm_run;

// The corrected model as the driver knows it.
extern const run_model corrected_model;

// --- arm_run.c: beginning, steps, end --------------------------------------------------

// Begins a run, or takes one up, in the storage of a motion that is over (`spare`, which
// may be NULL and is used up). Whatever it returns, arm_run_finish is due.
status arm_run_open(arm_run *run, recording *r, motion *spare, fault *f);

// Carries out what is due of script and rig until the next thing to do is a step, to
// run->segment.stop at most; *ended is true if the run is complete instead.
status arm_run_prepare_step(arm_run *run, bool *ended, fault *f);

// Looks how far the next step goes (motion_examine_step), in flight beyond the instants
// of samples: it is under way then. Of an arm that a dense engine moves and nothing holds
// still.
void arm_run_begin_step(arm_run *run);

// Continues by one step, recorded with the event at its end: to the end of the segment
// or, cut there, to `until` [s] at the most. What fails is explained in f.
status arm_run_step(arm_run *run, double until, fault *f)
    __attribute__((warn_unused_result));

// Ends the step under way, if there is one, at the instant that the run has come to.
status arm_run_end_step(arm_run *run, fault *f) __attribute__((warn_unused_result));

// Sums the run up, `failed` being what ended it, and frees it but for its motion's
// storage, which it returns: NULL if there is none.
motion *arm_run_finish(arm_run *run, status failed);

// The instant that the run has come to [s].
static inline double arm_run_time(const arm_run *run)
{
    if (run->under_way.exists) {
        return run->under_way.time;
    }
    return run->motion->state[SLOT_TIME];
}

// --- arm_run_inputs.c: parameters, the script, commands of the rig ---------------------

// Derives the arm's constants from the parameters as they are now; the command in force
// stays.
void arm_run_bind_arm(arm_run *run);

// The wall moves as the parameters' file says, if they name one. STATUS_BAD_SCENARIO and
// others if it cannot be read.
status arm_run_read_path(arm_run *run, fault *f);

// Carries out one action now and records it as action `index` of the script (-1: of no
// script); the rows on its both sides show what it changed.
status arm_run_apply_action(arm_run *run, const action *todo, int index, fault *f);

// Carries out the script's actions that are due. A failure is explained in f, or has a
// code only.
status arm_run_script(arm_run *run, fault *f);

// What the rig has done at this instant shows from here on: its sample, if it took one,
// and where the command `changed` the torque, and with it accelerations and force.
// Records the rows on both sides of the jump; there is none before the start.
status arm_run_apply_sample(arm_run *run, bool changed);

// --- arm_run_events.c: events, contact and its pulses ----------------------------------

// To be called of a run that begins: one that starts at rest on the wall is in its first
// contact, which no event begins. STATUS_NO_MEMORY.
status arm_run_begin_in_contact(arm_run *run);

// Applies an event that the motion stopped at and records the rows on its both sides.
status arm_run_apply_event(arm_run *run, motion_report *report);

// Records what a push, which may be an impact, a change of a parameter or a command has
// done to the contact state `before` it.
status arm_run_record_change(arm_run *run, contact_state before, motion_report *report);

// The sensors feel the impulse of an impact that has just been applied.
void arm_run_strike_sensors(arm_run *run, const motion_report *report);

// The first pulse is over: takes note of its length and of the largest force until now.
void arm_run_close_first_pulse(arm_run *run);

// The same of the landing's pulse.
void arm_run_close_landing(arm_run *run);

// --- arm_run_forces.c: a step's force and what the sensors see of it, in pieces --------

// What the sensors are fixed to, in a state of the motion.
sensed_motion arm_run_sensed_motion(const arm_run *run, double *state);

// The point on the way that a state of the motion is.
sample_point arm_run_sample_point(const arm_run *run, double *state);

// Into how many pieces the force over a step in contact of this length [s] is divided for
// recording.
int arm_run_force_pieces(const arm_run *run, double length);

// Lets the sensors follow the arm within the step under way, which is in flight, to where
// it has come to `to`. STATUS_NOT_FINITE if a state on the way cannot be computed.
status arm_run_follow_flight(arm_run *run, const sample_point *to)
    __attribute__((warn_unused_result));

// Lets the sensors follow the arm over the step just made, or over what is left of it,
// and keeps its force. STATUS_NOT_FINITE as above, STATUS_NO_MEMORY.
status arm_run_record_forces(arm_run *run) __attribute__((warn_unused_result));

// Accelerations and force jump at this instant: what decays begins here.
void arm_run_note_jump(arm_run *run);

// The mean force of the end, and its bounds, count from this instant on.
void arm_run_begin_window(arm_run *run);

// The bounds of the largest force count from this instant on.
void arm_run_begin_bounds(arm_run *run);

// Writes the bounds [N] of a force into two numbers of the summary, which stay as they
// are where it is determined.
void arm_run_write_bounds(force_bounds bounds, double *low, double *high);

// --- arm_run_rows.c: rows, and the ledger after every step -----------------------------

// The flight is over: whether it was a separation, above SEPARATION_GAP at any instant.
bool arm_run_end_flight(arm_run *run);

// Records the residual of the energy balance. STATUS_UNSTABLE if the run gains energy,
// STATUS_NOT_FINITE if an energy is not finite.
status arm_run_audit(arm_run *run) __attribute__((warn_unused_result));

// What did so much work on the arm, or took it, put that in [J].
void arm_run_note_work(arm_run *run, double work);

// The present state, as good as the next call of any function here or of the motion.
double *arm_run_present_state(const arm_run *run);

// The row of a state of the motion.
sample arm_run_row(const arm_run *run, double *state);

// Adds a row of a state of the motion, at which an impulse [N s] acts or none, if the run
// keeps rows. STATUS_NO_MEMORY.
status arm_run_record_row(arm_run *run, double *state, double impulse)
    __attribute__((warn_unused_result));

// Computes the intervals of the grids that the run's rows lie on, and how far apart
// instants of theirs may lie that are one.
void arm_run_lay_out_rows(arm_run *run);

// Records the row of the start, with which the grid begins.
status arm_run_record_first_row(arm_run *run) __attribute__((warn_unused_result));

// Whether that has been done.
static inline bool arm_run_has_first_row(const arm_run *run)
{
    return run->recording->state.rows.next[GRID_OF_STEPS] > 0;
}

// Records the rows of the grid up to an instant [s] within the step under way.
// STATUS_NOT_FINITE if a state cannot be had, STATUS_NO_MEMORY, STATUS_STOPPED.
status arm_run_record_rows_to(arm_run *run, double time)
    __attribute__((warn_unused_result));

// Records the end of the run, `time` [s], if no row of the grid lies there.
status arm_run_record_last_row(arm_run *run, double time)
    __attribute__((warn_unused_result));

// Records the step just made: force, separation, ledger, and the rows of the grid that
// lie within it; of one at its end only if there is no event, which records rows of its
// own.
status arm_run_record_step(arm_run *run, bool at_event)
    __attribute__((warn_unused_result));

// --- arm_run_summary.c: what it comes to -----------------------------------------------

// Sums up what is known of the run, also of one that failed or has not come to its end
// (`failed` then says so). What it has recorded is then that of a run that ended here.
void arm_run_summarise(arm_run *run, status failed);

// Says when and how the run failed, with the method's name. Returns s.
status arm_run_explain(const arm_run *run, status s, fault *f);

// Says why the motion could not make a step. Returns s.
status arm_run_explain_step(const arm_run *run, status s, fault *f);

// Says that the run passes time no longer after that event, and what makes it so. Returns
// STATUS_NO_PROGRESS.
status arm_run_explain_standstill(const arm_run *run, motion_event last, fault *f);

// A run of the corrected arm in progress, and what it records after every step.
#pragma once

#include "src/run/recording.h"
#include "src/solve/contact_machine.h"
#include "src/solve/pace.h"

typedef struct corrected_run {
    recording *recording;
    motion *motion;

    // the stretch between two stops of script, rig or window that the motion is in
    double stop;       // where it ends at the latest, 0 before the first [s]
    double last_event; // in it, -1 if none [s]
    int at_once;       // events in a row without time passing
    pace pace;         // of the whole run

    arm arm; // with the command in force
} corrected_run;

// Takes note of the energy that the ledger does not account for. STATUS_UNSTABLE if the run makes
// energy, STATUS_NOT_FINITE if an energy is beyond all numbers.
status corrected_audit(corrected_run *c);

// The row of a state of the motion, at which an impulse [N s] acts or none.
sample corrected_row(const corrected_run *c, double *state, double impulse);

// Adds a row of a state of the motion, at which an impulse [N s] acts or none, if the run keeps
// rows. STATUS_NO_MEMORY.
status corrected_record_row(corrected_run *c, double *state, double impulse);

// Records the step just made: force, separation, ledger, and the rows of the grid that lie within
// it; of one at its end only if there is no event, which records rows of its own.
status corrected_record_step(corrected_run *c, bool at_event);

// In how many pieces the force over a step of this length [s] is kept that the motion makes in
// contact.
int corrected_force_pieces(const corrected_run *c, double length);

// What the sensors are fixed to, in a state of the motion.
sensed_motion corrected_sensed_motion(const corrected_run *c, double *state);

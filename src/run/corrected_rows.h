// What a run of the corrected arm records after every step.
#pragma once

#include "src/run/corrected_run.h"

// Records the residual of the energy balance. STATUS_UNSTABLE if the run gains energy,
// STATUS_NOT_FINITE if an energy is not finite.
status corrected_audit(corrected_run *c) __attribute__((warn_unused_result));

// The row of a state of the motion, at which an impulse [N s] acts or none.
sample corrected_row(const corrected_run *c, double *state, double impulse);

// Adds a row of a state of the motion, at which an impulse [N s] acts or none, if the run keeps
// rows. STATUS_NO_MEMORY.
status corrected_record_row(corrected_run *c, double *state, double impulse)
    __attribute__((warn_unused_result));

// Records the rows of the grid up to an instant [s] within the step under way. STATUS_NOT_FINITE if
// a state cannot be had, STATUS_NO_MEMORY, STATUS_STOPPED.
status corrected_record_rows_to(corrected_run *c, double time) __attribute__((warn_unused_result));

// Records the step just made: force, separation, ledger, and the rows of the grid that lie within
// it; of one at its end only if there is no event, which records rows of its own.
status corrected_record_step(corrected_run *c, bool at_event) __attribute__((warn_unused_result));

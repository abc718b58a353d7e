// The run of a session: computed with the inputs in effect, at once or beside the session.
#pragma once

#include "src/session/session_state.h"

// Computes the run with the inputs in effect and puts the cursor into it. On failure the present
// run stays and f says why.
status session_compute(session *s, fault *f);

// Takes note of what has been computed since the last call. True if anything has.
bool session_follow(session *s);
// Ends a run that is being computed; its rows so far stay, its status is STATUS_STOPPED. False if
// there was none, or it was just over.
bool session_stop(session *s);
// Computes what is missing of a run that was stopped.
status session_go_on(session *s, fault *f);

// The parameters as script and inputs have set them at an instant.
parameters session_parameters_at(const session *s, double time);

// Keeps a run for comparison, in the place of the one that is kept: its rows are shared, not
// copied. STATUS_NO_MEMORY.
status session_keep_beside(session *s, const run_result *run, fault *f);
// Forgets the run kept for comparison.
void session_forget_other(session *s);
// Lets the scenario load its plug-in or start its program, and computes the run with it. On failure
// nothing changes and f says why.
status session_allow_code(session *s, fault *f);

// What a process that is the controller went through again since this was asked last: all zero if
// nothing, and while a run is being computed.
struct process_replay session_take_replay(session *s);

// Forgets the run before the value that was adjusted last.
void session_forget_ghost(session *s);

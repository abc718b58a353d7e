// A session with one scenario: a run that is looked at from any instant, and changed on the way.
//
// The whole run is computed and kept as rows; "running" moves a cursor over them. What the user
// does (a changed parameter, a push) is an input with its instant, and the run is that of the
// scenario and all inputs. So a saved scenario gives the same run by construction, stepping back
// and forth changes nothing, undo is a shorter list of inputs, and a branch keeps the old run
// beside the new one; rows that both have are kept once.
//
// A run that takes longer than the session's patience is computed by a thread of its own. Until it
// is over `run` shows the rows there are, session_follow brings more, and `computing` is not NULL.
// The cursor may then stand at an instant that has no row yet: `row` is the last one there is.
//
// Rows before a change are those of the unchanged run to the last bit: no step is chosen for an
// input, one that goes beyond it is cut.
#pragma once

#include "src/session/cursor.h"
#include "src/session/inputs.h"
#include "src/session/session_run.h"

// Takes over the scenario (also on failure) and computes its run; waits no longer than `patience`
// [s] for a run's end, then it is computed in the background. A run that fails numerically is kept
// as far as it went, session.run.summary says why. STATUS_BAD_ARGUMENT if the rows would not fit
// into the memory budget (512 MiB), STATUS_NO_MEMORY; then there is no session.
status session_open(session *s, scenario *base, double patience, fault *f);
void session_finish(session *s);

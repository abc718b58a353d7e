// What the user does to a session: inputs, each with its instant, and their undoing.
#pragma once

#include "src/session/session_state.h"

// Gives a parameter another value: from the cursor's instant on if it may change during a run (and
// the cursor is not at the start), else from the start. Records an input and computes the run anew;
// what could be redone is forgotten. On failure nothing changes and f says why.
status session_change(session *s, int parameter, const char *text, fault *f);
// The same for an impulse at the tip [N s].
status session_push(session *s, double impulse, fault *f);

// Takes back the last input, or puts it in again. STATUS_BAD_ARGUMENT if there is none.
status session_undo(session *s, fault *f);
status session_redo(session *s, fault *f);

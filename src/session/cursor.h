// The cursor of a session: the instant that is looked at.
#pragma once

#include "src/session/session_state.h"

// The row at the cursor, never NULL.
const sample *session_sample(const session *s);
// The end of what has been computed [s].
double session_end(const session *s);

// Moves the cursor to an instant, kept within the run.
void session_seek(session *s, double time);
// Moves the cursor by rows, back if negative. False at an end.
bool session_step(session *s, long rows);
// The event at the cursor, or NULL.
const event *session_event(const session *s);

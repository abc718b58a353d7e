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
// Moves to the next event after the cursor (direction 1) or the one before it (-1): to the row just
// after the event. False if there is none. session_event tells the event at the cursor, or NULL.
bool session_step_event(session *s, int direction);
const event *session_event(const session *s);

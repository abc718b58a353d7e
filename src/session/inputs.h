// What the user does to a session: inputs, each with its instant, and their undoing.
#pragma once

#include "src/session/session_state.h"

// Gives a parameter another value: from the row at the cursor on if it may change during a run (and
// the cursor is not at the start), else from the start. At the row before an event the change comes
// before the event, and the cursor stands at it. Records an input and computes the run anew;
// what could be redone is forgotten. On failure nothing changes and f says why.
status session_change(session *s, int parameter, const char *text, fault *f);
// The same, in the place of the last input if that gave this parameter a value at this very
// instant: small steps to a value are one input (session.ghost is the run before them), and none
// once they have led back to where they began.
status session_adjust(session *s, int parameter, const char *text, fault *f);
// The same as session_change for an impulse at the tip [N s].
status session_push(session *s, double impulse, fault *f);

// Pushes that are one gesture: undone and put in again together. A number that no input has, and a
// push of that gesture (as session_push).
unsigned session_new_gesture(const session *s);
status session_pull(session *s, double impulse, unsigned gesture, fault *f);

// Gives another value to what inputs[index] changed, at its instant; an input of its own, which
// undoing takes back. STATUS_BAD_ARGUMENT for a push.
status session_change_input(session *s, int index, const char *text, fault *f);
// Takes inputs[index] out; it is the next that session_redo puts in, at the end.
status session_drop_input(session *s, int index, fault *f);

// Puts other inputs in the place of all there are, and computes their run; nothing can be redone
// then. On failure nothing changes and f says why.
status session_take_inputs(session *s, const session_input *inputs, int count, fault *f);

// Takes back the last input, or puts it in again; the cursor goes to where it was, or to where the
// input takes effect. STATUS_BAD_ARGUMENT if there is none.
status session_undo(session *s, fault *f);
status session_redo(session *s, fault *f);

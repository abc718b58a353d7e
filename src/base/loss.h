// Loss: what had to be left out of some output (a line, a member of an object) for want of memory.
// It is noted where it happens and asked for by whoever completes the output: a file before it is
// put in its place, a text before it is handed out, the program before it says that all went well.
#pragma once

#include <stdbool.h>

// Notes a loss on this thread, unless what was to be kept is.
void loss_unless(bool kept);

// Whether anything was lost on this thread since the last call: what it made is not whole.
bool loss_noted(void) __attribute__((warn_unused_result));

// Begins anew: what was lost before belongs to other output.
void loss_forget(void);

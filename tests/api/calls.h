// Calls every part of libimpactlab, for tests in which requests for memory fail.
#pragma once

#include <stdio.h>

// Writes what all came to, or the sentence of the first call that was refused; returns 0
// if none was. A refusal without a sentence, or one that leaves a handle, ends the
// process with 2.
int call_everything(FILE *out);

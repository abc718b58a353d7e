// The lines that a controller in a program of its own is asked by and answers with: JSON
// objects, as docs/howto/controller.md has them.
#pragma once

#include <stddef.h>

#include "src/base/fault.h"
#include "src/rig/controller.h"
#include "src/tables/parameters.h"

// The line that asks for a command at a sample, with its end, to be freed; NULL without
// memory. The first one tells the setup, control.* and control.settings, too; `setup` is
// NULL in the others.
char *process_question(const controller_setup *setup, const control_parameters *control,
                       const controller_input *in);

// What a line of so many bytes, its end left out, answers; what it leaves out of *out is
// NaN. STATUS_CONTROLLER_FAILED if it is no answer with a command, STATUS_NO_MEMORY if
// that cannot be known.
status process_read_answer(const char *line, size_t length, controller_output *out);

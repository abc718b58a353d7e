// Reference data over a figure: a CSV as `run --csv` writes it, or as a measurement may be brought
// into that form.
#pragma once

#include "src/base/fault.h"
#include "src/run/trace.h"

// Reads rows from a CSV whose first line names its columns as signals, with or without unit
// ("time[s],force[N]"): "time" and at least one more signal that the lab records. A cell that is
// empty is not drawn, columns of other names are ignored. Fills an empty trace, to be given to
// trace_finish also on failure. STATUS_CANNOT_READ for the file, STATUS_BAD_ARGUMENT with path and
// line for what is in it.
status overlay_read(trace *t, const char *path, fault *f);

// Reference data over a figure: a CSV as `run --csv` writes it, or as a measurement may be brought
// into that form.
#pragma once

#include "src/base/fault.h"
#include "render/plot/trace_plot.h"

// Reads measured data, FILE.csv[:COLUMN][@SHIFT]. The file's first line names its columns, with or
// without unit ("time[s],force[N]"): "time" and at least one more. A column named as a signal that
// the lab records lies over that signal; COLUMN takes one column alone, which if its name is no
// signal lies over the first signal of the panels that has its unit. SHIFT [s] is added to every
// time. A cell that is empty is not drawn, columns of other names are ignored. Fills an empty
// trace, to be given to trace_finish also on failure, and a name for the legend, to be given to
// g_free. STATUS_CANNOT_READ for the file, STATUS_BAD_ARGUMENT with path and line for what is in
// it.
status overlay_read(trace *t, const char *spec, const trace_panel *panels, int panel_count,
                    char **name, fault *f);

// The same with path, column (NULL: all that are signals) and shift apart.
status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name, fault *f);

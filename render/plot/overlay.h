// Reference data over a figure: a CSV as written by `run --csv`, or a measurement in that form.
#pragma once

#include "src/base/fault.h"
#include "render/plot/trace_plot.h"

// Reads measured data, FILE.csv[:COLUMN][@SHIFT]. The file's first line names its columns, with or
// without unit ("time[s],force[N]"): "time" and at least one more. A column with the name of a
// recorded signal is drawn over that signal. COLUMN selects a single column; if its name is not a
// signal, it is drawn over the first signal of the panels with its unit. SHIFT [s] is added to
// every time. Empty cells are not drawn, columns with other names are ignored. Fills an empty
// trace, to be freed with trace_finish also on failure, and a name for the legend, to be freed with
// g_free. STATUS_CANNOT_READ for the file, STATUS_BAD_ARGUMENT with path and line for its contents.
status overlay_read(trace *t, const char *spec, const trace_panel *panels, int panel_count,
                    char **name, fault *f);

// The same with separate path, column (NULL: all that are signals) and shift.
status overlay_read_column(trace *t, const char *path, const char *column, double shift,
                           const trace_panel *panels, int panel_count, char **name, fault *f);

// Pictures made by commands, with one set of options for all of them.
#pragma once

#include "render/drawing.h"
#include "ui/commands/command.h"

// Reads the options of page_options. Returns EXIT_DONE, or reports an error and returns
// the exit status.
int read_picture_options(const arguments *a, figure_options *o);

// A curve of a figure; what else there is to say of it comes afterwards.
static inline figure_series curve_of(const char *name, const char *label, const double *x,
                                     const double *y, size_t count, int slot)
{
    return (figure_series){name, label, x, y, count, .colour = slot};
}

// Draws a figure to --plot according to the options, with a CSV of its numbers next to
// it, with the title "SCENARIO'S TITLE: what it shows" and what was changed of the
// scenario. Returns the exit status.
int publish_titled(const arguments *a, const scenario *s, const char *shows,
                   const figure *fig);

// The same for a study's figure: panels side by side over one logarithmic axis.
int publish_study(const arguments *a, const scenario *s, const char *shows,
                  const figure *fig);

// The same for a figure that has its title and is destroyed then.
int publish_owned(const arguments *a, owned_figure *o);

// The same for a figure of runs: with the requested signals, measured data and range of
// time. `title` NULL: the first scenario's.
int publish_runs(const arguments *a, const char *title, const trace_run *runs,
                 int run_count);

// The --plot option of a command.
#define PLOT_OPTION(what) OPTION(PICTURE, "plot", "FILE.{png,pdf,svg}", what, PLACE(plot))

// --- the arm in space ------------------------------------------------------------------

// The view set by --gl, --camera and --size.
scene_options read_view(const arguments *a);

// Checks --camera. Returns the exit status.
int check_view(const arguments *a);

// Checks, before the run, that run --scene can write its file and that --at does not give
// too many instants. Returns the exit status.
int check_scene(const arguments *a);

// Writes the picture of run --scene. Returns the exit status.
int write_scene(const arguments *a, const scenario *s, const run_result *result);

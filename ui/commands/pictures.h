// Pictures made by commands, with one set of options for all of them.
#pragma once

#include "render/figures/artwork.h"
#include "render/figures/run_figure.h"
#include "ui/commands/command.h"

// Reads the options of page_options. Returns EXIT_DONE, or reports an error and returns the exit
// status.
int read_picture_options(const arguments *a, figure_options *o);

// Draws a figure to --plot according to the options, with a CSV of its numbers next to it. Returns
// the exit status.
int publish_figure(const arguments *a, const figure *fig);

// The same for a figure of runs: with the requested signals, measured data and range of time.
// `title` NULL: the first scenario's.
int publish_runs(const arguments *a, const char *title, const trace_run *runs, int run_count);

// The --plot option of a command.
#define PLOT_OPTION(what)                                                                          \
    {                                                                                              \
        .name = "plot", .type = OPTION_PICTURE, .value = "FILE.{png,pdf,svg}", .help = (what),     \
        PLACE(plot)                                                                                \
    }

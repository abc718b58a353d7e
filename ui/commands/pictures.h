// Pictures as the command line asks for them: one set of options for all commands.
#pragma once

#include "render/figures/publication.h"
#include "render/figures/run_figure.h"
#include "ui/commands/command.h"

// Takes the options of page_options. Returns EXIT_DONE, or complains and returns the exit status.
int read_picture_options(const arguments *a, figure_options *o);

// Draws a figure to --plot as the options ask, with its numbers beside it. Returns the exit status.
int publish_figure(const arguments *a, const figure *fig);

// The same for a figure of runs: the signals, measured data and stretch that were asked for.
// `title` NULL: the first scenario's.
int publish_runs(const arguments *a, const char *title, const trace_run *runs, int run_count);

// The --plot option of a command.
#define PLOT_OPTION(what)                                                                          \
    {                                                                                              \
        .name = "plot", .type = OPTION_PICTURE, .value = "FILE.{png,pdf,svg}", .help = (what),     \
        PLACE(plot)                                                                                \
    }

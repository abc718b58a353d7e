// The look of pictures as the command line asks for it.
#pragma once

#include "render/figures/artwork.h"
#include "ui/commands/command.h"

// Takes --mono, --dark, --width, --dpi and --overlay. Returns EXIT_DONE, or complains and returns
// the exit status.
int read_figure_options(const arguments *a, figure_options *o);

// Figures from recipes: files that say which runs, data and tables a figure shows, and how.
#pragma once

#include <stdbool.h>

#include "render/figures/artwork.h"
#include "src/scenario/scenario.h"

// Opens the recipe at `path`: reads it, runs what it names and describes its figure with the look
// of the options. Faults in the recipe are reported with file:line:column. artwork_finish
// afterwards. STATUS_BAD_SCENARIO if any was reported (*f then is empty), else what the runs and
// files return.
status recipe_open(const char *path, const figure_options *o, fault_handler report, void *context,
                   artwork *out, fault *f);

// Whether a file is a recipe: YAML with panels in it. False for what cannot be read.
bool recipe_is(const char *path);

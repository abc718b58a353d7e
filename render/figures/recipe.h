// Figures from recipes: files that define which runs, data and tables a figure shows, and how.
#pragma once

#include <stdbool.h>

#include "render/figures/artwork.h"
#include "src/scenario/scenario.h"

// Opens the recipe at `path`: reads it, makes its runs and describes its figure with the look of
// the options. Faults in the recipe are reported with file:line:column. To be ended with
// artwork_finish. STATUS_BAD_SCENARIO if any was reported (*f is then empty), otherwise the status
// of runs and files.
status recipe_open(const char *path, const figure_options *o, fault_handler report, void *context,
                   artwork *out, fault *f);

// Whether a file is a recipe: YAML with panels. False for a file that cannot be read.
bool recipe_is(const char *path);

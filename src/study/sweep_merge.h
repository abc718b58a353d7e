// Brings the parts of one sweep, computed apart, together in one database.
#pragma once

#include <stddef.h>

#include "src/base/fault.h"

// What a merged sweep holds.
typedef struct sweep_merged {
    size_t runs;  // that are there
    size_t total; // of the sweep
} sweep_merged;

// Merges the databases of `count` > 0 parts into a new one at `output`, whole or not at all: the
// rows of all of them under their common definition, in any order. STATUS_BAD_ARGUMENT if a file is
// no sweep of this program, holds another sweep than the first, or a run that another part holds
// too; f says which.
status sweep_merge(char *const *files, int count, const char *output, sweep_merged *merged,
                   fault *f);

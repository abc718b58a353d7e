// Columns of a sweep's database, for whoever draws them.
#pragma once

#include <stddef.h>

#include "src/base/fault.h"

// Reads two columns of the runs, by the keys of their headings (a parameter's path,
// "peak_force_N"), in ascending order of the first. Runs without a number in either are left out.
// *x and *y are to be freed. STATUS_CANNOT_READ with the path if the file is no sweep's database or
// has no such column.
status sweep_table_read(const char *path, const char *x_key, const char *y_key, double **x,
                        double **y, size_t *count, fault *f);

// Columns of a sweep's database, for whoever draws them.
#pragma once

#include <stddef.h>

#include "src/base/fault.h"

enum { SWEEP_TABLE_COLUMNS = 3 };

// Reads columns of the runs, by the keys of their headings (a parameter's path, "peak_force_N"), 1
// to SWEEP_TABLE_COLUMNS of them, in ascending order of the first and then of the second. Runs
// without a number in one of them are left out. columns[0 ... key_count - 1] are to be freed; on
// failure they are NULL. STATUS_CANNOT_READ or STATUS_BAD_ARGUMENT with the path if the file is no
// sweep's database, has no such column, or something infinite in it.
status sweep_table_read(const char *path, const char *const *keys, int key_count, double **columns,
                        size_t *count, fault *f);

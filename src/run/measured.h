// Recorded tables as traces: measured signals beside those of a run.
#pragma once

#include "src/base/csv_table.h"
#include "src/run/trace.h"

// Appends a row for each row of a table with a column "time": of the columns that are headed as
// signals, in their units, or of `column` alone (not NULL), which stands for `signal`. What was not
// measured is NaN. STATUS_BAD_ARGUMENT with the line in f: no time, times that fall, no such
// column, a field that is no number, no number at all; STATUS_NO_MEMORY.
status measured_rows(trace *t, const csv_table *table, const char *column, int signal, fault *f);

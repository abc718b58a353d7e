// Tables as people record them: rows of numbers below headings, read into columns.
//
// How a table may be written is in csv_layout.h, how its headings name units in
// csv_units.h. Whoever takes a column says in which unit it is wanted; mV, ms, deg and
// their kin are converted. Times come first: rows that have none are left out then.
#pragma once

#include "src/base/csv_layout.h"
#include "src/base/sample_clock.h"

// Reads a file with a row of headings and `least` rows of as many fields, as
// csv_layout_read does; where that fails the table is empty, and nothing is to be freed.
status csv_table_read(csv_table *t, const char *path, size_t least, fault *f);
void csv_table_finish(csv_table *t); // one of zeroes is allowed

// The column with a heading "name" or "name[unit]", or the heading itself, else in small
// and large letters alike; -1 if there is none.
int csv_table_find(const csv_table *t, const char *heading);

// The heading of the column that has the times: time, t or another usual name, else the
// only one in a unit of time, else one that counts samples. NULL if there is none.
const char *csv_table_clock(const csv_table *t);

// The unit of a column, in its heading or below it; false if none is said.
bool csv_table_unit(const csv_table *t, int column, char unit[32]);

// What an empty field, or one with "nan" or the like, is.
typedef enum csv_gaps {
    GAPS_REFUSED,
    GAPS_MISSING, // NaN: there is no reading
    GAPS_HELD     // the value above it, which goes on; above the first one, that one
} csv_gaps;

// The numbers of a column in `unit`, values[rows] on the heap. `heading` is what
// csv_table_find takes; a "[unit]" in it counts in the place of the file's, and a column
// without any has the unit that is wanted. STATUS_BAD_ARGUMENT where the column is
// missing, another one of its heading differs, its unit is unknown or a field not a
// finite number, with line and column;
// STATUS_NO_MEMORY.
status csv_table_numbers(const csv_table *t, const char *heading, const char *unit,
                         csv_gaps gaps, double **values, fault *f);

// The instants of the rows [s], values[rows] on the heap, and the clock by which they
// were recorded. `heading` is of the column with the times, NULL for csv_table_clock's.
// One that counts samples is divided by `rate` [1/s], refused where that is 0.
//
// Rows without a time are taken out of the table, and rows with a time before that of the
// row above put in order; both are counted. Of more than one in 20 the first is a fault,
// as are a row whose place is 100 rows above or more, where a recorder began anew, and
// all that csv_table_numbers finds. Stamps of a recording that are off its clock's
// samples by no more than their last digit and a hundredth of a period are replaced by
// the samples' instants.
status csv_table_times(csv_table *t, const char *heading, double rate,
                       sample_clock *clock, double **values, fault *f);

// The same for a recording that a run from 0 to `end` [s] plays, later by `shift`: where
// its clock is not the run's, its times count from its first row. A recording that is so
// slow that a run sees one row of it is refused: its unit is another one. told[] receives
// what a person should know of it, "" if there is nothing.
enum { CSV_TOLD = 320 };
status csv_table_play(csv_table *t, double rate, double shift, double end,
                      sample_clock *clock, double **values, char told[CSV_TOLD],
                      fault *f);

// Writes how many rows were left out or put in order, and why; "" if none was.
const char *csv_table_left_out(const csv_table *t, char *text, size_t size);

// The value of a column at an instant: that of the last row not later, or straight
// between rows; of the first or last row beyond them. times and values[rows], rows > 0.
double csv_table_at(const double *times, const double *values, size_t rows, double time,
                    bool linear);

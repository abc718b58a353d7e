// Tables as people record them: CSV with one row of headings, numbers below, read into
// columns.
//
// A heading is name[unit] or a name alone; fields may stand in quotes (RFC 4180). Whoever
// takes a column says in which unit it is wanted; mV, ms, deg and their kin are
// converted.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

typedef struct csv_table {
    char *file;      // its path; owned
    char *text;      // owned; headings and fields point into it
    int columns;     // headings, and fields of each row
    size_t rows;     // below the headings
    char **headings; // [columns], owned
    char **fields;   // row by row, owned
    int *lines;      // of each row in the file, from 1; owned
} csv_table;

// Reads a file with a row of headings and `least` rows of as many fields.
// STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT (too few rows, a row of another length; with
// the line) or STATUS_NO_MEMORY; then the table is empty, and nothing is to be freed.
status csv_table_read(csv_table *t, const char *path, size_t least, fault *f);
void csv_table_finish(csv_table *t); // one of zeroes is allowed

// The column with a heading "name" or "name[unit]", or the heading itself; -1 if there is
// none.
int csv_table_find(const csv_table *t, const char *heading);

// The numbers of a column in `unit`, values[rows] on the heap. `heading` is what
// csv_table_find takes; a "[unit]" in it counts in the place of the file's, and a column
// without any has the unit that is wanted. STATUS_BAD_ARGUMENT where the column is
// missing, its unit unknown or a field not a finite number, with line and column;
// STATUS_NO_MEMORY. With `gaps`, of readings, an empty field or "nan" is none: NaN.
status csv_table_numbers(const csv_table *t, const char *heading, const char *unit,
                         bool gaps, double **values, fault *f);

// As csv_table_numbers for "time" or another clock [s], whose values must not fall.
status csv_table_times(const csv_table *t, const char *heading, double **values,
                       fault *f);

// The value of a column at an instant: that of the last row not later, or straight
// between rows; of the first or last row beyond them. times and values[rows], rows > 0.
double csv_table_at(const double *times, const double *values, size_t rows, double time,
                    bool linear);

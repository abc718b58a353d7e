// How a table is written: finds the separator of its fields, its decimal sign, comments,
// the row of headings and what stands above it, a row of units, and divides it into
// fields.
//
// Fields are separated by commas, semicolons, tabs, strokes or blanks, whichever gives
// most rows the number of fields that the next one has, and may stand in quotes (RFC
// 4180); a quote that is not closed is part of its field. A line that begins with #, % or
// // is a comment. The headings are the first row without a number that twenty rows of
// numbers in as many fields follow, else the one that most do, else such a row in the
// comment above the first numbers.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

typedef struct csv_table {
    char *file;      // its path; owned
    char *text;      // owned; headings, units and fields point into it
    int columns;     // headings, and fields of each row
    size_t rows;     // below the headings
    char **headings; // [columns], owned
    int headings_line;
    char **units;  // [columns], of a row of units below the headings, owned; NULL if
                   // there is none
    char **fields; // row by row, owned
    int *lines;    // of each row in the file, from 1; owned
    char decimal;  // sign before the decimals, '.' or ','

    // rows that are left out, and rows that csv_table_times puts in order
    int cut_line;     // of a last row that breaks off; 0: there is none
    size_t untimed;   // left out, without a time
    int untimed_line; // of the first
    size_t receding;  // with a time before that of the row above
} csv_table;

// Divides a file into headings and at least `least` rows, at least one, of as many
// fields. A field too many at the end of a row may be there if it is empty, and one at
// its beginning if it counts the rows. STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT (too few
// rows, a row of another length, no headings; with the line) or STATUS_NO_MEMORY; then
// the table is to be finished.
status csv_layout_read(csv_table *t, const char *path, size_t least, fault *f);

// The finite number in a field, with that decimal sign and not the other one; false for
// all else.
bool csv_layout_number(const char *field, char decimal, double *number);

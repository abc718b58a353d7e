// A table as a MAT file: each column a variable.
//
// A variable's numbers lie together and behind their count, and neither is known while
// rows come one by one. They are kept in a file without a name beside the one that is
// written, in blocks of rows, and put into their order at the end: memory does not grow
// with rows.
#pragma once

#include "src/base/whole_file.h"

typedef struct mat_rows mat_rows;

// Begins a table of `count` > 0 columns that goes to `file`. NULL, with a sentence, if
// there is no memory or no place for what is kept.
mat_rows *mat_rows_begin(whole_file *file, int count, fault *f);

// The number of the present row in a column; then every column has got its number.
void mat_rows_number(mat_rows *m, int column, double value);
void mat_rows_end_row(mat_rows *m);

// Writes the file: the variables of those names [count]. STATUS_CANNOT_WRITE, with a
// sentence, if a variable has more rows than such a file takes, or if what was kept could
// not be written or read. Other texts may follow in the stream.
status mat_rows_end(mat_rows *m, const char *const *names, fault *f);

void mat_rows_destroy(mat_rows *m); // may be NULL

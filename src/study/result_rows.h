// Rows of results under one set of columns: as CSV, as objects of JSON, and for people.
#pragma once

#include <jansson.h>

#include "src/base/csv.h"

typedef struct result_column {
    const char *key;         // in JSON, its unit at the end
    const char *name, *unit; // in CSV
} result_column;

typedef struct result_cell {
    const char *text; // NULL: a number
    double number;    // NaN where it is missing
} result_cell;

// The first row of CSV, and the others.
void result_headings(csv_writer *w, const result_column *columns, int count);
void result_row(csv_writer *w, const result_cell *cells, int count);

// Puts the cells into an object under their keys.
void result_put(json_t *object, const result_column *columns, const result_cell *cells, int count);

// Prints a cell of a table for people, of column 0, 1 ...: of columns of blanks, to the left where
// the width is negative, or of a table of a Markdown page; result_page_rule then goes under its
// headings. The row is not ended.
void result_print(FILE *stream, bool page, int column, int width, const char *text);
void result_page_rule(FILE *stream, int columns);

// Rows of results under one set of columns: as CSV, as objects of JSON, and for people.
#pragma once

#include <jansson.h>

#include "src/base/csv.h"

// What a row holds at a column's place.
typedef enum result_kind {
    RESULT_NUMBER, // a double, times the column's `times`
    RESULT_COUNT,  // a size_t
    RESULT_TEXT    // a const char *
} result_kind;

typedef struct result_column {
    const char *key;         // in JSON, its unit at the end
    const char *name, *unit; // in CSV
    size_t place;            // of tables: offset in a row
    double times;
    result_kind kind;
} result_column;

typedef struct result_cell {
    const char *text; // NULL: a number
    double number;    // NaN where it is missing
} result_cell;

// Rows in memory, one behind the other.
typedef struct result_table {
    const result_column *columns;
    int column_count;
    const void *rows;
    size_t row_size; // [bytes]
    int row_count;
} result_table;

// The cell of a row in one of the columns.
result_cell result_cell_of(const result_table *t, int row, const result_column *column);

// The whole table, as an array of objects, NULL without memory, and as CSV.
json_t *result_json(const result_table *t);
void result_csv(FILE *stream, const result_table *t);

// Of other tables: the first row of CSV, and a field of the others; a member of an
// object.
void result_headings(csv_writer *w, const result_column *columns, int count);
void result_field(csv_writer *w, result_cell cell);
void result_put(json_t *object, const char *key, result_cell cell);

// Prints a cell of a table for people, of column 0, 1 ...: of columns of blanks, to the
// left where the width is negative, or of a table of a Markdown page; result_page_rule
// then goes under its headings. The row is not ended.
void result_print(FILE *stream, bool page, int column, int width, const char *text);
void result_page_rule(FILE *stream, int columns);

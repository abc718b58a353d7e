// Tables as Parquet, which pandas, polars, DuckDB and Spark read.
//
// A file is written from its beginning to its end and needs no more memory for more rows:
// groups of rows, each column of a group in one plain page, then the footer that says
// where they are (parquet.thrift of the Apache Parquet format, 2.10). A number or text
// that is missing is a null. Units and other notes are key-value pairs of the footer:
// "unit.NAME" is the unit of a column.
//
//     parquet_begin -> (parquet_number or parquet_text for each column ->
//     parquet_end_row) for each row -> parquet_end
#pragma once

#include <stdio.h>

#include "src/base/fault.h"

typedef enum parquet_type {
    PARQUET_NUMBER,
    PARQUET_WHOLE_NUMBER,
    PARQUET_TEXT
} parquet_type;

typedef struct parquet_column {
    const char *name, *unit; // unit "" for none
    parquet_type type;
} parquet_column;

// What the file says of itself.
typedef struct parquet_note {
    const char *key, *value;
} parquet_note;

typedef struct parquet_file parquet_file;

// Begins a file of `count` > 0 columns, which live as long as it. NULL without memory.
// Errors of the stream stay in it.
parquet_file *parquet_begin(FILE *stream, const parquet_column *columns, int count);

// The field of the present row in a column: a number (NaN: missing), which a column of
// whole numbers holds exactly up to 2^53, or a text (NULL: missing).
void parquet_number(parquet_file *p, int column, double value);
void parquet_text(parquet_file *p, int column, const char *text);

// Every column has got its field.
void parquet_end_row(parquet_file *p);

// Ends the file with these notes, and frees it; NULL is nothing. What was lost for want
// of memory is noted (text_stream.h).
void parquet_end(parquet_file *p, const parquet_note *notes, int note_count);

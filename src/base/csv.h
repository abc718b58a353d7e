// Tables as CSV, the one convention of all files the program writes (RFC 4180 with a line
// feed).
//
// The first row holds a heading name[unit] for each column, name[] where a quantity has
// no unit or the column holds a text; a name alone where the unit stands in another
// column. A number that is missing leaves its field empty. Errors stay in the stream.
#pragma once

#include <stdbool.h>
#include <stdio.h>

typedef struct csv_writer {
    FILE *stream;
    bool in_row; // a comma comes before the next field
} csv_writer;

// A writer at the beginning of a table.
csv_writer csv_begin(FILE *stream);

// A heading of the first row; unit NULL for a name alone.
void csv_heading(csv_writer *w, const char *name, const char *unit);

// A text, in quotes where commas, quotes or ends of lines need them; what is unprintable
// (words.h) becomes '?', but for line feeds.
#define csv_text(w, text) csv_heading(w, text, NULL)

// A number as number_format gives it; NaN is missing.
void csv_number(csv_writer *w, double value);

void csv_end_row(csv_writer *w);

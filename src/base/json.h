// JSON beyond jansson: numbers that may be missing, texts that may be no UTF-8, and how a value is
// laid out in a file.
#pragma once

#include <jansson.h>
#include <stdio.h>

// A JSON number, or null where value is not finite.
json_t *json_number(double value);

// An array of `count` such numbers.
json_t *json_numbers(const double *values, int count);

// A JSON string; in a text that is not UTF-8 every byte beyond ASCII becomes '?'.
json_t *json_text(const char *text);

// Writes a JSON value with two spaces of indentation, keys in the order in which they were set and
// numbers as number_format gives them. Errors stay in the stream (ferror).
void json_write(FILE *stream, const json_t *value);

// JSON beyond jansson: numbers that may be missing, texts that may be no UTF-8, and how a value is
// laid out in a file.
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

// A JSON number, or null where value is not finite.
json_t *json_number(double value);

// An array of `count` such numbers.
json_t *json_numbers(const double *values, int count);

// A JSON string; in a text that is not UTF-8 every byte beyond ASCII becomes '?'.
json_t *json_text(const char *text);

// From now on every allocation of jansson is watched, for the whole program: what fails to be set
// for want of memory would be missing from an object without a word.
void json_watch_memory(void);

// Whether this thread was refused memory for JSON since the last call, in a program that watches:
// what it made may lack something and is not to be written.
bool json_lost_something(void);

// Writes a JSON value with two spaces of indentation, keys in the order in which they were set and
// numbers as number_format gives them. Errors stay in the stream (ferror).
void json_write(FILE *stream, const json_t *value);

// The same within an array or object that the caller writes, `depth` levels deep, without the end
// of the line: for what is too long to be held as one value.
void json_write_member(FILE *stream, const json_t *value, int depth);

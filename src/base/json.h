// JSON beyond jansson: numbers that may be missing, texts that may be no UTF-8, and how a
// value is laid out in a file.
#pragma once

#include <jansson.h>
#include <stdio.h>

// A JSON number, or null where value is not finite.
json_t *json_number(double value);

// An array of `count` such numbers.
json_t *json_numbers(const double *values, int count);

// A JSON string; in a text that is not UTF-8 every byte beyond ASCII becomes '?'.
json_t *json_text(const char *text);

// Puts a member into an object, an element at the end of an array, and takes the value
// over. What cannot be put for want of memory (value or container may be NULL then) is
// lost, and noted (text_stream.h).
void json_put(json_t *object, const char *key, json_t *value);
void json_add(json_t *array, json_t *value);

// Puts members into an object and returns it: each word "KEY:T" of `members` takes an
// argument, n a double (json_number), i an int, b a bool, t a text (json_text), o a
// json_t *, which is taken over. json_of makes the object, too:
//
//     json_of("path:t value:n", axis->name, limit->value)
json_t *json_members(json_t *object, const char *members, ...);
#define json_of(...) json_members(json_object(), __VA_ARGS__)

// Writes a JSON value with two spaces of indentation, keys in the order in which they
// were set and numbers as number_format gives them. Errors stay in the stream (ferror);
// NULL, for which there was no memory, is lost.
void json_write(FILE *stream, const json_t *value);

// The same within an array or object that the caller writes, `depth` levels deep, without
// the end of the line: for what is too long to be held as one value.
void json_write_member(FILE *stream, const json_t *value, int depth);

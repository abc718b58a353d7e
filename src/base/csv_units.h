// Units in headings of tables, as programs and people write them: name[V], name (V),
// "name, V", name/V, name_V, name V.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { UNIT_TEXT = 32 }; // room for a unit

// Divides a heading into name and unit. Square brackets always hold a unit, what stands
// in another way is one if it is known here, else part of the name. Returns whether there
// is a unit, which unit[] receives then; *length becomes that of the name.
bool csv_unit_split(const char *heading, size_t *length, char unit[UNIT_TEXT]);

// Takes a field without the brackets around it for a unit; whether it is a known one.
bool csv_unit_alone(const char *field, char unit[UNIT_TEXT]);

// How many of `wanted` a unit is, 0 if it cannot be converted to it.
double csv_unit_factor(const char *unit, const char *wanted);

// Whether a unit says that a column counts samples, no time.
bool csv_unit_counts(const char *unit);

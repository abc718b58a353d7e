// Results as files: JSON of a run, CSV of a trace.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/run/run.h"

enum { NUMBER_TEXT = 32 }; // room for any number written by number_format

// The version of the lab, "0.1.0".
const char *lab_version(void);

// Writes value with as few digits as read back as the same number ("0.1", "1e-05", "12"; -0 is
// written "0", a number that is not finite "nan", "inf" or "-inf"). text has NUMBER_TEXT bytes.
void number_format(char *text, double value);

// A JSON number, or null where value is not finite.
json_t *json_number(double value);

// A JSON string; in a text that is not UTF-8 every byte beyond ASCII becomes '?'.
json_t *json_text(const char *text);

// Writes a JSON value with two spaces of indentation, keys in the order in which they were set and
// numbers as number_format gives them. Errors stay in the stream (ferror).
void json_write(FILE *stream, const json_t *value);

// The object of `run --json`: scenario, version, status, message, parameters, the summary,
// expectations (if the scenario has any) and events. Quantities that did not occur are null. NULL
// without memory. The caller calls json_decref.
json_t *export_run(const scenario *s, const run_result *result);

// Writes a trace as CSV: one header row of name[unit], then a row for each sample; for more than
// two links the angle of every body follows as angle_1[rad], angle_2[rad]... Errors stay in the
// stream.
void export_csv(FILE *stream, const trace *t, int links);

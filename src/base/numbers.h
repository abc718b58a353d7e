// Numbers as text: written so that they read back as the same number, and read as people write
// them.
#pragma once

#include <stdbool.h>

enum { NUMBER_TEXT = 32 }; // room for any number written below

// Writes value with as few digits as read back as the same number ("0.1", "1e-05", "1000000"; -0
// is written "0", a number that is not finite "nan", "inf" or "-inf"). text has NUMBER_TEXT bytes.
void number_format(char *text, double value);

// The same with an exponent from a million on ("1e+06"), as people write parameters, and with the
// sign of a zero, which a run can tell.
void number_format_short(char *text, double value);

// Reads a decimal number at the start of text: no hexadecimal, infinity or NaN. *rest is what
// follows number and blanks. False if there is none.
bool decimal_read(const char *text, double *value, const char **rest);

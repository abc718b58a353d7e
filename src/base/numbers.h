// Numbers as text: written so that they read back as the same number, and read as people
// write them.
//
// All with a decimal point: a program that uses the library may have set a locale that
// writes "0,5", which must change neither files nor pictures. Every number that src/ and
// render/ read from a text or write to one goes through here.
#pragma once

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

enum { NUMBER_TEXT = 32 }; // room for any number written below

// Writes value with as few digits as read back as the same number: "0.1", "1e-05",
// "1000000"; -0 is written "0", a number that is not finite "nan", "inf" or "-inf". text
// has NUMBER_TEXT bytes.
void number_format(char *text, double value);

// The same with an exponent from a million on ("1e+06"), as people write parameters, and
// with the sign of a zero, which a run can tell.
void number_format_short(char *text, double value);

// Reads a decimal number at the start of text: no hexadecimal, infinity or NaN. *rest is
// what follows number and blanks. False if there is none.
bool decimal_read(const char *text, double *value, const char **rest);

// A blank, tabulator or line end, and any control character, of ASCII: the C library's
// isspace and iscntrl ask the locale, and in some find them in the middle of UTF-8
// characters.
static inline bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}
static inline bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

// As snprintf.
int decimal_print(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
int decimal_vprint(char *text, size_t size, const char *format, va_list list)
    __attribute__((format(printf, 3, 0)));

// The printed text, to be freed; NULL without memory.
char *decimal_vtext(const char *format, va_list list)
    __attribute__((format(printf, 1, 0)));

// As strtod.
double decimal_parse(const char *text, char **end);

// For qsort and bsearch of doubles: ascending, with NaN behind all numbers.
int compare_numbers(const void *a, const void *b);

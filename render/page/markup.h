// Words of figures: markup, units, numbers and labels.
#pragma once

#include <glib.h>

// Replaces <sub>..</sub> and <sup>..</sup> by spans for letters of the given size on a page of the
// given scale (points of the page to a point of the size), spaces at which a line must not end by
// no-break spaces (between a number and its unit, around an equals sign, before a version), and a
// straight apostrophe within a word by a typographic one. Free the result with g_free.
char *text_translate(const char *markup, double size, double scale);

// A unit as the SI brochure sets it: "rad/s2" gives "rad/s²", "kg m2" gives "kg·m²".
void text_unit(const char *unit, char *out, size_t size);

// A number of `digits` significant digits, zeros at its end too, and its unit: "5.40\u2009N". Free
// the result with g_free.
char *text_quantity(double value, int digits, const char *unit);

// A number of at most `digits` significant digits as markup: with a true minus sign, and a power of
// ten instead of many zeros, "2·10<sup>−5</sup>". Free the result with g_free.
char *text_number(double value, int digits);

// The beginning of a description as a label: up to its first comma, colon or bracket, with a
// capital letter. Plain text; free the result with g_free.
char *text_label(const char *description);

// The markup's bare text, valid UTF-8. Free the result with g_free.
char *text_plain(const char *markup);

// Any bytes as valid UTF-8, escaped for markup, printable characters only (src/base/words.h). Free
// the result with g_free.
char *text_escape(const char *bytes);

// As g_strdup_printf and g_string_append_printf, with a decimal point in every locale.
char *text_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
void text_append(GString *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Any bytes as valid UTF-8 of printable characters and line feeds. Free the result with g_free.
char *text_printable(const char *bytes);

// Size of an index (subscript or superscript) in a line of letters of the given size [pt].
double text_index_letters(double size);

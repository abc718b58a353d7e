// Texts of figures: their words (markup.c), and how Pango sets them (text.c).
#pragma once

#include <glib.h>
#include <pango/pangocairo.h>
#include <stdarg.h>
#include <stdbool.h>

#include "render/page/page.h"
#include "src/base/fault.h"

// An expression over bytes, of GLib's regular expressions, kept compiled: static.
typedef struct text_pattern {
    const char *expression;
    gsize compiled;
} text_pattern;

// The text with what `give` makes of every match, as g_regex_replace_eval has it. Free
// the result with g_free; without memory the program ends.
char *text_replaced(text_pattern *p, const char *text, GRegexEvalCallback give,
                    gpointer context);

// Replaces <sub>..</sub> and <sup>..</sup> by spans of 70 % of the given size, spaces at
// which a line must not end by no-break spaces (between a number and its unit, around an
// equals sign, before a version), and a straight apostrophe within a word by a
// typographic one. Free the result with g_free.
char *text_translate(const char *markup, double size);

// A unit as the SI brochure sets it: "rad/s2" gives "rad/s²", "kg m2" gives "kg·m²". Free
// the result with g_free.
char *text_unit(const char *unit);

// A symbol of the parameter table as markup: "k_2" gives "<i>k</i><sub>2</sub>". Free the
// result with g_free.
char *text_symbol(const char *symbol);

// A number of `digits` significant digits, zeros at its end too, and its unit:
// "5.40\u2009N". Free the result with g_free.
char *text_quantity(double value, int digits, const char *unit);

// A number of at most `digits` significant digits as markup: with a true minus sign, and
// a power of ten instead of many zeros, "2·10<sup>−5</sup>". Free the result with g_free.
char *text_number(double value, int digits);

// The beginning of a description as a label: up to its first comma, colon or bracket,
// with a capital letter. Plain text; free the result with g_free.
char *text_label(const char *description);

// The markup's bare text, valid UTF-8. Free the result with g_free.
char *text_plain(const char *markup);

// Any bytes as valid UTF-8, escaped for markup, printable characters only
// (src/base/words.h). Free the result with g_free.
char *text_escape(const char *bytes);

// As g_strdup_printf and g_string_append_printf, with a decimal point in every locale; a
// refused request for memory ends the program, where those leave the text out.
char *text_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
char *text_vprintf(const char *format, va_list list)
    __attribute__((format(printf, 1, 0)));
void text_append(GString *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// The text, or another one where there is none (NULL).
const char *text_or(const char *text, const char *otherwise);

// A true minus sign (U+2212) for a negative number, otherwise an empty text.
const char *text_sign(double value);

// Any bytes as valid UTF-8 of printable characters and line feeds. Free the result with
// g_free.
char *text_printable(const char *bytes);

// The default family.
#define TEXT_FAMILY "DejaVu Sans"

typedef enum text_align { TEXT_LEFT, TEXT_CENTRE, TEXT_RIGHT } text_align;

// The point of a text that is at its place, as shares of its width and height: (0, 0) is
// its upper left corner.
typedef struct anchor {
    double x, y;
} anchor;

// A text to draw or measure.
typedef struct text_block {
    const char *markup;
    double size;        // of the letters
    const char *family; // NULL: TEXT_FAMILY
    bool bold;
    text_align align; // of its lines
    double leading; // distance of lines, relative to that of letters without powers; 0: 1
    double width;   // at which lines are wrapped; 0: never
    bool balanced;  // lines of about equal length, with no single word in the last
} text_block;

// Fails with STATUS_CANNOT_READ if TEXT_FAMILY is not installed, with what to install in
// f.
status text_check_font(fault *f);

// Fails with STATUS_BAD_ARGUMENT if no font of the family is installed.
status text_check_family(const char *family, fault *f);

// A context whose layouts do not depend on the surface: no hinting, no rounding, 72 per
// inch. To be freed with g_object_unref.
PangoContext *text_context_create(void);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(PangoContext, g_object_unref)

// A layout of t, to be freed with g_object_unref. Markup that cannot be parsed is shown
// unchanged.
PangoLayout *text_layout_create(PangoContext *context, const text_block *t);

typedef struct text_size {
    double width, height;
} text_size;

text_size text_measure(PangoContext *context, const text_block *t);

// Draws t in a colour with its anchor at (x, y) of a possibly rotated cr. Returns where
// it is.
figure_rect text_put(cairo_t *cr, PangoContext *context, const text_block *t, double x,
                     double y, anchor part, colour c);

// Sets the function that is called with a reason, and must not return, if GLib fails
// fatally, mostly for lack of memory, or if Pango warns that it cannot draw a text
// correctly. Without it GLib ends the program by a signal, and Pango draws what it can.
void text_when_giving_up(void (*end)(const char *reason));

#include "render/page/text.h"

#include <assert.h>
#include <math.h>
#include <pango/pango.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/page.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

#define INDEX_SIZE 0.72 // of its line's letters, but never too small to read

// Whether the word at `text` is a unit and ends there.
static bool is_unit(const char *text)
{
    static const char *const units[] = {"N",  "N·s", "N·m", "V", "A",   "s",  "ms",    "µs",
                                        "Hz", "kHz", "mm",  "m", "kg",  "J",  "mJ",    "rad",
                                        "dB", "%",   "Ω",   "W", "N s", "kΩ", "rad/s", "m/s"};

    // neither the start of a longer word nor the numerator of a longer unit
    for (size_t i = 0; i < G_N_ELEMENTS(units); i++) {
        size_t length = strlen(units[i]);
        bool ends = strncmp(text, units[i], length) == 0 && !g_ascii_isalnum(text[length]) &&
                    text[length] != '/' && (unsigned char)text[length] < 0x80;
        if (ends) {
            return true;
        }
    }
    return false;
}

// Whether the space at `space` joins what must stay in one line: a number and its unit, both sides
// of an equals sign, a name and the number after it.
static bool space_joins(const char *start, const char *space)
{
    bool equals = space[1] == '=' && space[2] == ' ';
    bool after_equals = space - start >= 2 && space[-1] == '=' && space[-2] == ' ';
    bool number = space > start && g_ascii_isdigit(space[-1]) && is_unit(space + 1);
    bool version = space > start && g_ascii_isalpha(space[-1]) && g_ascii_isdigit(space[1]) &&
                   strchr(space + 1, '.') != NULL &&
                   strspn(space + 1, "0123456789") == strcspn(space + 1, ".");
    bool figure = space - start >= 4 && strncmp(space - 4, "Fig.", 4) == 0;
    return equals || after_equals || number || version || figure;
}

// Whether the slash at `slash` stands before the last part of a unit: "N·m/rad", "m/s²".
static bool slash_joins(const char *start, const char *slash)
{
    static const char *const lower[] = {"rad", "s", "m", "V", "A", "N"};

    // a path has longer words
    bool after_letter = slash > start && g_ascii_isalpha(slash[-1]);
    for (size_t i = 0; i < G_N_ELEMENTS(lower); i++) {
        size_t length = strlen(lower[i]);
        if (after_letter && strncmp(slash + 1, lower[i], length) == 0 &&
            !g_ascii_isalpha(slash[1 + length])) {
            return true;
        }
    }
    return false;
}

// Length of a typewriter's apostrophe within a word ("Newmark's", or as g_markup_escape_text writes
// it) that begins at `mark`; 0 if none does.
static size_t apostrophe_length(const char *start, const char *mark)
{
    size_t length = *mark == '\'' ? 1 : strncmp(mark, "&apos;", 6) == 0 ? 6 : 0;
    length = strncmp(mark, "&#39;", 5) == 0 ? 5 : length;
    bool within = mark > start && g_ascii_isalpha(mark[-1]) && g_ascii_isalpha(mark[length]);
    return within ? length : 0;
}

double text_index_letters(double size)
{
    return fmax(INDEX_SIZE * size, fmin(size, LETTERS_LEAST));
}

char *text_translate(const char *markup, double size, double scale)
{
    assert(size > 0 && scale > 0);
    GString *out = g_string_new(NULL);

    bool in_tag = false;
    for (const char *c = markup; *c != '\0';) {
        in_tag = *c == '<' || (in_tag && *c != '>');
        bool lowered = strncmp(c, "<sub>", 5) == 0, raised = strncmp(c, "<sup>", 5) == 0;
        if (lowered || raised) {
            // in 1/1024 of a point, which every version of Pango understands
            double small = text_index_letters(size * scale) / scale;
            text_append(out, "<span size=\"%d\" rise=\"%d\">", (int)(small * 1024),
                        (int)((raised ? 0.35 : -0.2) * size * 1024));
            in_tag = false;
            c += 5;
        } else if (strncmp(c, "</sub>", 6) == 0 || strncmp(c, "</sup>", 6) == 0) {
            g_string_append(out, "</span>");
            in_tag = false;
            c += 6;
        } else if (strncmp(c, "\u2009", 3) == 0) {
            // a thin space stands between a number and its unit: its twin that does not break
            g_string_append(out, "\u202f");
            c += 3;
        } else if (*c == ' ' && !in_tag && space_joins(markup, c)) {
            g_string_append(out, "\u00a0");
            c++;
        } else if (!in_tag && apostrophe_length(markup, c) > 0) {
            g_string_append(out, "\u2019");
            c += apostrophe_length(markup, c);
        } else if (*c == '/' && !in_tag && slash_joins(markup, c)) {
            // a word joiner: no line ends after the slash
            g_string_append(out, "/\u2060");
            c++;
        } else {
            g_string_append_c(out, *c++);
        }
    }
    return g_string_free(out, FALSE);
}

char *text_unit(const char *unit)
{
    static const char *const powers[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

    GString *shown = g_string_new(NULL);
    for (const char *c = unit; *c != '\0'; c++) {
        bool after_letter = c > unit && (g_ascii_isalpha(c[-1]) || g_ascii_isdigit(c[-1]));
        if (*c == ' ') {
            g_string_append(shown, "\u00b7");
        } else if (g_ascii_isdigit(*c)) {
            g_string_append(shown, powers[*c - '0']);
        } else if (*c == '-' && after_letter && g_ascii_isdigit(c[1])) {
            g_string_append(shown, "\u207b");
        } else {
            g_string_append_c(shown, *c);
        }
    }
    return g_string_free(shown, FALSE);
}

char *text_quantity(double value, int digits, const char *unit)
{
    assert(digits > 0);
    char number[48];
    decimal_print(number, sizeof number, "%#.*g", digits, fabs(value));
    size_t length = strlen(number);
    if (length > 0 && number[length - 1] == '.') {
        number[length - 1] = '\0';
    }
    g_autofree char *shown = text_unit(unit);
    return text_printf("%s%s\u2009%s", value < 0 ? "\u2212" : "", number, shown);
}

char *text_number(double value, int digits)
{
    assert(digits > 0);
    char number[48];
    const char *sign = value < 0 ? "\u2212" : "";
    decimal_print(number, sizeof number, "%.*g", digits, fabs(value));
    char *exponent = strchr(number, 'e');
    if (exponent == NULL) {
        return text_printf("%s%s", sign, number);
    }

    // mantissa and power of ten; a mantissa of 1 goes without saying
    int power = atoi(exponent + 1);
    *exponent = '\0';
    bool one = strcmp(number, "1") == 0;
    return text_printf("%s%s%s10<sup>%s%d</sup>", sign, one ? "" : number, one ? "" : "\u00b7",
                       power < 0 ? "\u2212" : "", abs(power));
}

char *text_label(const char *description)
{
    g_autofree char *valid = g_utf8_make_valid(description, -1);
    g_autofree char *label = g_strndup(valid, strcspn(valid, ",:;("));
    g_strchomp(label);
    gunichar first = g_utf8_get_char(label);
    char letter[8] = "";
    letter[g_unichar_to_utf8(g_unichar_toupper(first), letter)] = '\0';
    char *whole = g_strconcat(letter, label[0] != '\0' ? g_utf8_next_char(label) : "", NULL);
    return whole;
}

char *text_printable(const char *bytes)
{
    char *valid = g_utf8_make_valid(bytes, -1);
    make_printable(valid, '\n');
    return valid;
}

char *text_plain(const char *markup)
{
    char *valid = text_printable(markup), *plain = NULL;
    if (pango_parse_markup(valid, -1, 0, NULL, &plain, NULL, NULL)) {
        // an entity may have become what the markup did not hold
        make_printable(plain, '\n');
        g_free(valid);
        return plain;
    }
    return valid;
}

char *text_escape(const char *bytes)
{
    char *valid = text_printable(bytes), *escaped = g_markup_escape_text(valid, -1);
    g_free(valid);
    return escaped;
}

// Without memory GLib ends the program, and so does this; GLib's own printing leaves the text out
// and says nothing.
char *text_vprintf(const char *format, va_list list)
{
    char *printed = decimal_vtext(format, list);
    if (printed == NULL) {
        g_error("out of memory");
    }
    char *text = g_strdup(printed);
    free(printed);
    return text;
}

char *text_printf(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    char *text = text_vprintf(format, list);
    va_end(list);
    return text;
}

void text_append(GString *text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    g_autofree char *printed = text_vprintf(format, list);
    va_end(list);
    g_string_append(text, printed);
}

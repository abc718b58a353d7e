// Words of figures: markup, units, numbers, and plain text.
#include "render/page/text.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/page.h"
#include "src/base/numbers.h"
#include "src/base/words.h"

#define INDEX_SIZE 0.7 // of its line's letters

// ---- one text in place of another

char *text_replaced(text_pattern *p, const char *text, GRegexEvalCallback give,
                    gpointer context)
{
    // compiled by whichever thread comes first
    if (g_once_init_enter(&p->compiled)) {
        const GRegexCompileFlags flags = G_REGEX_RAW | G_REGEX_DOTALL | G_REGEX_OPTIMIZE;
        GRegex *regex = g_regex_new(p->expression, flags, 0, NULL);
        g_once_init_leave(&p->compiled, (gsize)regex);
    }

    g_autoptr(GError) error = NULL;
    const GRegex *regex = (const GRegex *)p->compiled;
    char *out = g_regex_replace_eval(regex, text, -1, 0, 0, give, context, &error);
    if (out == NULL) {
        g_error("a text cannot be searched: %s", error->message);
    }
    return out;
}

// A unit, neither the start of a longer word nor the numerator of a longer unit.
#define UNIT                                                                             \
    "(?:N|N·s|N·m|V|A|s|ms|µs|Hz|kHz|mm|m|kg|J|mJ|rad|dB|%|Ω|W|N s|kΩ|rad/s|m/s)"   \
    "(?![A-Za-z0-9/\\x80-\\xff])"

// Spaces that join what must stay in one line: both sides of an equals sign, a number and
// its unit, a name and the version or the number after it.
#define JOINT                                                                            \
    " (?== )|(?<= =) |(?<=[0-9]) (?=" UNIT ")|(?<=[A-Za-z]) (?=[0-9]+\\.)|(?<=Fig\\.) "

// A typewriter's apostrophe within a word, also as g_markup_escape_text writes it; the
// slash before the last part of a unit, "N·m/rad", for a path has longer words.
#define APOSTROPHE "(?<=[A-Za-z])(?:'|&apos;|&#39;)(?=[A-Za-z])"
#define SLASH      "(?<=[A-Za-z])/(?=(?:rad|s|m|V|A|N)(?![A-Za-z]))"

// What text_translate looks for, by the groups of its expression; a tag of any other kind
// is in none of them.
enum {
    OTHER_TAG,
    SUBSCRIPT,
    SUPERSCRIPT,
    INDEX_END,
    THIN_SPACE,
    JOINED_SPACE,
    TYPED_APOSTROPHE,
    UNIT_SLASH
};

// The letters of an index, raised by a share of the line's size.
static void begin_index(GString *out, double size, double rise)
{
    // in 1/1024 of a point, which every version of Pango understands
    text_append(out, "<span size=\"%d\" rise=\"%d\">", (int)(INDEX_SIZE * size * 1024),
                (int)(rise * size * 1024));
}

// What stands in the place of a match of text_translate.
static gboolean translate(const GMatchInfo *match, GString *out, gpointer context)
{
    // a thin space stands between a number and its unit: its twin does not break, and
    // behind a word joiner no line ends
    static const char *const instead[] = {[INDEX_END] = "</span>",
                                          [THIN_SPACE] = "\u202f",
                                          [JOINED_SPACE] = "\u00a0",
                                          [TYPED_APOSTROPHE] = "\u2019",
                                          [UNIT_SLASH] = "/\u2060"};
    const int group = g_match_info_get_match_count(match) - 1;
    const double *size = context;
    switch (group) {
    case OTHER_TAG: {
        g_autofree char *tag = g_match_info_fetch(match, 0);
        g_string_append(out, tag);
        break;
    }
    case SUBSCRIPT:
        begin_index(out, *size, -0.2);
        break;
    case SUPERSCRIPT:
        begin_index(out, *size, 0.35);
        break;
    default:
        g_string_append(out, instead[group]);
    }
    return FALSE;
}

char *text_translate(const char *markup, double size)
{
    assert(size > 0);
    static text_pattern words = {"(<sub>)|(<sup>)|(</su[bp]>)|<[^<>]*|(\u2009)|(" JOINT
                                 ")|(" APOSTROPHE ")|(" SLASH ")"};
    return text_replaced(&words, markup, translate, &size);
}

// Blanks become dots, digits and minus signs raised ones; a slash stays.
char *text_unit(const char *unit)
{
    static const char *const powers[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3",
                                         "\u2074", "\u2075", "\u2076", "\u2077",
                                         "\u2078", "\u2079"};

    GString *shown = g_string_new(NULL);
    for (const char *c = unit; *c != '\0'; c++) {
        bool after_letter =
            c > unit && (g_ascii_isalpha(c[-1]) || g_ascii_isdigit(c[-1]));
        if (*c == ' ') {
            g_string_append(shown, "\u00b7");
        } else if (g_ascii_isdigit(*c) && c > unit) { // not the 1 of 1/s
            g_string_append(shown, powers[*c - '0']);
        } else if (*c == '-' && after_letter && g_ascii_isdigit(c[1])) {
            g_string_append(shown, "\u207b");
        } else {
            g_string_append_c(shown, *c);
        }
    }
    return g_string_free(shown, FALSE);
}

char *text_symbol(const char *symbol)
{
    const size_t letters = strcspn(symbol, "_");
    if (symbol[letters] == '\0') {
        return text_printf("<i>%s</i>", symbol);
    }
    return text_printf("<i>%.*s</i><sub>%s</sub>", (int)letters, symbol,
                       symbol + letters + 1);
}

const char *text_or(const char *text, const char *otherwise)
{
    if (text != NULL) {
        return text;
    }
    return otherwise;
}

const char *text_sign(double value)
{
    if (value < 0) {
        return "\u2212";
    }
    return "";
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
    return text_printf("%s%s\u2009%s", text_sign(value), number, shown);
}

// Numbers that %g writes with an exponent get a power of ten.
char *text_number(double value, int digits)
{
    assert(digits > 0);
    char number[48];
    const char *sign = text_sign(value);
    decimal_print(number, sizeof number, "%.*g", digits, fabs(value));
    char *exponent = strchr(number, 'e');
    if (exponent == NULL) {
        return text_printf("%s%s", sign, number);
    }

    // a power of ten; a mantissa of 1 is left out
    int power = atoi(exponent + 1);
    *exponent = '\0';
    g_autofree char *ten = text_printf("10<sup>%s%d</sup>", text_sign(power), abs(power));
    if (strcmp(number, "1") == 0) {
        return text_printf("%s%s", sign, ten);
    }
    return text_printf("%s%s\u00b7%s", sign, number, ten);
}

// The first words of a sentence, with a capital letter.
char *text_label(const char *description)
{
    g_autofree char *valid = g_utf8_make_valid(description, -1);
    g_autofree char *label = g_strndup(valid, strcspn(valid, ",:;("));
    g_strchomp(label);
    gunichar first = g_utf8_get_char(label);
    char letter[8] = "";
    letter[g_unichar_to_utf8(g_unichar_toupper(first), letter)] = '\0';
    if (label[0] == '\0') {
        return g_strdup(letter);
    }
    return text_printf("%s%s", letter, g_utf8_next_char(label));
}

char *text_printable(const char *bytes)
{
    char *valid = g_utf8_make_valid(bytes, -1);
    make_printable(valid, '\n');
    return valid;
}

char *text_escape(const char *bytes)
{
    g_autofree char *valid = text_printable(bytes);
    return g_markup_escape_text(valid, -1);
}

// Without memory GLib ends the program, and so does this; GLib's own printing leaves the
// text out and says nothing.
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

// ---- what ends the program

static void (*end_of_program)(const char *reason);

static void on_log(const char *domain, GLogLevelFlags level, const char *reason,
                   void *context)
{
    if ((level & G_LOG_LEVEL_ERROR) != 0) {
        end_of_program(reason);
    }
    g_log_default_handler(domain, level, reason, context);
}

// Pango warns where it draws text as well as it can, without the font or letters
// elsewhere: such a picture is none.
static GLogWriterOutput on_warning(GLogLevelFlags level, const GLogField *fields,
                                   gsize count, void *context)
{
    const char *domain = "", *reason = "";
    for (gsize i = 0; i < count; i++) {
        if (strcmp(fields[i].key, "GLIB_DOMAIN") == 0) {
            domain = fields[i].value;
        }
        if (strcmp(fields[i].key, "MESSAGE") == 0) {
            reason = fields[i].value;
        }
    }
    if ((level & (G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING)) != 0 &&
        strcmp(domain, "Pango") == 0) {
        end_of_program(reason);
    }
    return g_log_writer_default(level, fields, count, context);
}

void text_when_giving_up(void (*end)(const char *reason))
{
    end_of_program = end;
    g_log_set_default_handler(on_log, NULL);
    g_log_set_writer_func(on_warning, NULL, NULL);
}

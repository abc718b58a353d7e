#include "src/base/numbers.h"

#include <assert.h>
#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Gives the calling thread the "C" locale; returns the one to go back to. The C library keeps the
// "C" locale for good: it is neither allocated here nor freed.
static locale_t enter_plain(void)
{
    return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

int decimal_vprint(char *text, size_t size, const char *format, va_list list)
{
    locale_t before = enter_plain();
    int length = vsnprintf(text, size, format, list);
    uselocale(before);
    return length;
}

int decimal_print(char *text, size_t size, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = decimal_vprint(text, size, format, list);
    va_end(list);
    return length;
}

char *decimal_vtext(const char *format, va_list list)
{
    char *text;
    locale_t before = enter_plain();
    int length = vasprintf(&text, format, list);
    uselocale(before);
    return length < 0 ? NULL : text;
}

double decimal_parse(const char *text, char **end)
{
    locale_t before = enter_plain();
    double value = strtod(text, end);
    uselocale(before);
    return value;
}

// Writes with the fewest digits, from `least` on, that read back as the same number.
static void write_digits(char *text, double value, int least)
{
    if (!isfinite(value)) {
        snprintf(text, NUMBER_TEXT, "%s", isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }

    for (int digits = least; digits <= 17; digits++) {
        decimal_print(text, NUMBER_TEXT, "%.*g", digits, value);
        if (digits == 17 || decimal_parse(text, NULL) == value) {
            return;
        }
    }
}

void number_format(char *text, double value)
{
    assert(text != NULL);

    // the sign of a zero says nothing to a reader
    write_digits(text, value == 0 ? 0 : value, 15);
}

void number_format_short(char *text, double value)
{
    assert(text != NULL);
    write_digits(text, value, 6);
}

bool decimal_read(const char *text, double *value, const char **rest)
{
    assert(text != NULL && value != NULL && rest != NULL);

    // what strtod would take beyond a decimal number
    const char *digits = text + (*text == '+' || *text == '-');
    bool begins = isdigit((unsigned char)digits[0]) ||
                  (digits[0] == '.' && isdigit((unsigned char)digits[1]));
    if (!begins || (digits[0] == '0' && tolower((unsigned char)digits[1]) == 'x')) {
        return false;
    }

    char *end;
    *value = decimal_parse(text, &end);
    while (is_blank(*end)) {
        end++;
    }
    *rest = end;
    return true;
}

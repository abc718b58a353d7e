#include "src/base/numbers.h"

#include <assert.h>
#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

// The decimal digits of a number above zero, two at a time from the last; returns how many.
static int write_whole(char *text, uint64_t number)
{
    static const char pairs[] = "00010203040506070809101112131415161718192021222324"
                                "25262728293031323334353637383940414243444546474849"
                                "50515253545556575859606162636465666768697071727374"
                                "75767778798081828384858687888990919293949596979899";
    char digits[20], *first = digits + sizeof digits;
    for (; number >= 10; number /= 100) {
        first -= 2;
        memcpy(first, pairs + 2 * (number % 100), 2);
    }
    if (number > 0) {
        *--first = (char)('0' + number);
    }

    const int count = (int)(digits + sizeof digits - first);
    memcpy(text, first, (size_t)count);
    return count;
}

// Digits d1 d2 ... dn as 0.000d1d2, as d1d2.d3 or as d1d2000; `place` is how many of them stand
// between d1 and the point, negative for zeros behind it. Returns the end.
static char *write_plain(char *text, const char *digits, int count, int place)
{
    if (place < 0) {
        memcpy(text, "0.0000", 6);
        memcpy(text + 1 - place, digits, (size_t)count);
        return text + 1 - place + count;
    }

    const int whole = count <= place ? count : place + 1;
    memcpy(text, digits, (size_t)whole);
    memset(text + whole, '0', (size_t)(place + 1 - whole));
    text += place + 1;
    if (whole < count) {
        *text = '.';
        memcpy(text + 1, digits + whole, (size_t)(count - whole));
        text += 1 + count - whole;
    }
    return text;
}

static char *write_with_exponent(char *text, const char *digits, int count, int place)
{
    const unsigned size = (unsigned)abs(place);
    text = write_plain(text, digits, count, 0);
    *text++ = 'e';
    *text++ = place < 0 ? '-' : '+';
    if (size < 10) {
        *text++ = '0'; // two digits at least
    }
    return text + write_whole(text, size);
}

// Writes with the fewest digits that read back as the same number: with an exponent below 1e-4, and
// from 10^(digits) on, but not for less than `most_plain` of them.
static void write_digits(char *text, double value, int most_plain)
{
    if (!isfinite(value)) {
        snprintf(text, NUMBER_TEXT, "%s", isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }
    if (signbit(value)) {
        *text++ = '-';
    }
    if (value == 0) {
        memcpy(text, "0", 2);
        return;
    }

    char digits[20];
    const decimal d = shortest_decimal(fabs(value));
    const int count = write_whole(digits, d.digits), place = count - 1 + d.exponent;
    const bool plain = place >= -4 && place < (count > most_plain ? count : most_plain);
    *(plain ? write_plain : write_with_exponent)(text, digits, count, place) = '\0';
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

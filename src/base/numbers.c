#include "src/base/numbers.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

// Writes with the fewest digits, from `least` on, that read back as the same number.
static void write_digits(char *text, double value, int least)
{
    if (!isfinite(value)) {
        snprintf(text, NUMBER_TEXT, "%s", isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
        return;
    }

    for (int digits = least; digits <= 17; digits++) {
        snprintf(text, NUMBER_TEXT, "%.*g", digits, value);
        if (digits == 17 || strtod(text, NULL) == value) {
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
    *value = strtod(text, &end);
    while (isspace((unsigned char)*end)) {
        end++;
    }
    *rest = end;
    return true;
}

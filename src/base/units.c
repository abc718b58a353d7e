#include "src/base/units.h"

#include <string.h>

#define DEGREE 0.017453292519943295 // pi / 180

// Takes a prefix off a unit; 1 and the whole unit where there is none.
static double take_prefix(const char **unit)
{
    static const struct {
        char letter;
        double factor;
    } prefixes[] = {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2},
                    {'k', 1e3},  {'M', 1e6},  {'G', 1e9}};
    for (size_t i = 0; i < sizeof prefixes / sizeof prefixes[0]; i++) {
        if (**unit == prefixes[i].letter && (*unit)[1] != '\0') {
            *unit += 1;
            return prefixes[i].factor;
        }
    }
    return 1;
}

// Whether two units are the same but for deg in the place of rad, which is multiplied to
// *factor, and behind a stroke divides it.
static bool same_but_degrees(const char *from, const char *to, double *factor)
{
    bool divides = false;
    while (*from != '\0' && *to != '\0') {
        const bool degree = strncmp(from, "deg", 3) == 0 && strncmp(to, "rad", 3) == 0;
        if (degree) {
            *factor = divides ? *factor / DEGREE : *factor * DEGREE;
            from += 3;
            to += 3;
        } else if (*from == *to) {
            divides = divides || *from == '/';
            from++;
            to++;
        } else {
            return false;
        }
    }
    return *from == *to;
}

bool unit_factor(const char *from, const char *to, double *factor)
{
    *factor = 1;
    if (same_but_degrees(from, to, factor)) {
        return true;
    }

    // with a prefix on either side: "mm" for "m", "g" for "kg"
    const char *plain_from = from, *plain_to = to;
    const double up = take_prefix(&plain_from), down = take_prefix(&plain_to);
    *factor = up;
    if (up != 1 && same_but_degrees(plain_from, to, factor)) {
        return true;
    }
    *factor = 1 / down;
    if (down != 1 && same_but_degrees(from, plain_to, factor)) {
        return true;
    }
    *factor = up / down;
    return up != 1 && down != 1 && same_but_degrees(plain_from, plain_to, factor);
}

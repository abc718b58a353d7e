#include "src/base/csv_units.h"

#include <stdio.h>
#include <string.h>

#include "src/base/numbers.h"

#define DEGREE (3.14159265358979323846 / 180)

// The units that a column may have beside the wanted one, and how many of that they are.
// Some stand twice, as UTF-8 and in one byte.
static const struct {
    const char *unit, *wanted;
    double factor;
} units[] = {
    {"sec", "s", 1},
    {"second", "s", 1},
    {"seconds", "s", 1},
    {"ms", "s", 1e-3},
    {"msec", "s", 1e-3},
    {"milliseconds", "s", 1e-3},
    {"us", "s", 1e-6},
    {"µs", "s", 1e-6},
    {"μs", "s", 1e-6},
    {"\xB5s", "s", 1e-6},
    {"usec", "s", 1e-6},
    {"microseconds", "s", 1e-6},
    {"ns", "s", 1e-9},
    {"min", "s", 60},
    {"volt", "V", 1},
    {"volts", "V", 1},
    {"mV", "V", 1e-3},
    {"kV", "V", 1e3},
    {"newtons", "N", 1},
    {"mN", "N", 1e-3},
    {"kN", "N", 1e3},
    {"radians", "rad", 1},
    {"mrad", "rad", 1e-3},
    {"deg", "rad", DEGREE},
    {"degrees", "rad", DEGREE},
    {"°", "rad", DEGREE},
    {"\xB0", "rad", DEGREE},
    {"rev", "rad", 360 * DEGREE},
    {"mrad/s", "rad/s", 1e-3},
    {"rad/sec", "rad/s", 1},
    {"deg/s", "rad/s", DEGREE},
    {"deg/sec", "rad/s", DEGREE},
    {"°/s", "rad/s", DEGREE},
    {"\xB0/s", "rad/s", DEGREE},
    {"rpm", "rad/s", 6 * DEGREE},
    {"rad/s^2", "rad/s2", 1},
    {"rad/s²", "rad/s2", 1},
    {"rad/s\xB2", "rad/s2", 1},
    {"deg/s2", "rad/s2", DEGREE},
    {"deg/s^2", "rad/s2", DEGREE},
    {"deg/s²", "rad/s2", DEGREE},
    {"mm", "m", 1e-3},
    {"um", "m", 1e-6},
    {"µm", "m", 1e-6},
    {"cm", "m", 1e-2},
    {"Nm", "N m", 1},
    {"mA", "A", 1e-3},
};

enum { UNITS = sizeof units / sizeof *units };

// What says that a time is the number of a sample.
static const char *const counts[] = {"count", "counts", "sample", "samples", "#"};

bool csv_unit_counts(const char *unit)
{
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        if (strcmp(unit, counts[i]) == 0) {
            return true;
        }
    }
    return false;
}

double csv_unit_factor(const char *unit, const char *wanted)
{
    if (strcmp(unit, wanted) == 0) {
        return 1;
    }
    for (int i = 0; i < UNITS; i++) {
        if (strcmp(units[i].unit, unit) == 0 && strcmp(units[i].wanted, wanted) == 0) {
            return units[i].factor;
        }
    }
    return 0;
}

static bool is_known(const char *unit)
{
    for (int i = 0; i < UNITS; i++) {
        if (strcmp(units[i].unit, unit) == 0 || strcmp(units[i].wanted, unit) == 0) {
            return true;
        }
    }
    return csv_unit_counts(unit);
}

// Copies what lies between two places, without the blanks around it; false if it has no
// room.
static bool copy_between(const char *from, const char *end, char unit[UNIT_TEXT])
{
    while (from < end && is_blank(*from)) {
        from++;
    }
    while (end > from && is_blank(end[-1])) {
        end--;
    }
    return snprintf(unit, UNIT_TEXT, "%.*s", (int)(end - from), from) < UNIT_TEXT;
}

bool csv_unit_alone(const char *field, char unit[UNIT_TEXT])
{
    const char *end = field + strlen(field);
    const bool square = field[0] == '[' && end[-1] == ']';
    const bool round = field[0] == '(' && end[-1] == ')';
    if (square || round) {
        field++;
        end--;
    }
    return copy_between(field, end, unit) && is_known(unit);
}

// Whether the last word before a place in a heading is a unit, as in "speed m/s".
static bool ends_with_unit(const char *heading, const char *end)
{
    const char *word = end;
    char unit[UNIT_TEXT];
    while (word > heading && strchr(" _:,", word[-1]) == NULL) {
        word--;
    }
    return word > heading && copy_between(word, end, unit) && is_known(unit);
}

// The place where a heading's unit begins with a sign, at which its name ends; NULL if
// what follows there is no unit.
static const char *find_unit(const char *heading, char unit[UNIT_TEXT])
{
    const char *end = heading + strlen(heading);
    const char *bracket = strrchr(heading, '[');
    if (bracket != NULL && end[-1] == ']') {
        copy_between(bracket + 1, end - 1, unit);
        return bracket;
    }
    bracket = strrchr(heading, '(');
    if (bracket != NULL && csv_unit_alone(bracket, unit)) {
        return bracket;
    }

    // a comma, an underline, a blank or a stroke (the first, as in v/rad/s) before it
    const char *const signs[] = {strrchr(heading, ','), strrchr(heading, '_'),
                                 strrchr(heading, ' '), strchr(heading, '/')};
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        const bool has_name = signs[i] != NULL && signs[i] > heading &&
                              (*signs[i] != '/' || !ends_with_unit(heading, signs[i]));
        if (has_name && copy_between(signs[i] + 1, end, unit) && is_known(unit)) {
            return signs[i];
        }
    }
    return NULL;
}

bool csv_unit_split(const char *heading, size_t *length, char unit[UNIT_TEXT])
{
    const char *sign = find_unit(heading, unit);
    *length = strlen(heading);
    if (sign == NULL) {
        unit[0] = '\0';
        return false;
    }

    // the name, without what stands between them
    while (sign > heading && (is_blank(sign[-1]) || sign[-1] == '_')) {
        sign--;
    }
    *length = (size_t)(sign - heading);
    return true;
}

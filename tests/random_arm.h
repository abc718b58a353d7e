// Arms drawn at random, for the programs that compare engines on them: settings as
// "path=value", kept as text so that an arm that was found wrong can be made again by
// hand.
#pragma once

#include "tests/arm_fixture.h"

enum { MOST_SETTINGS = 24, LONGEST_SETTING = 2400 };

// An arm in front of its wall.
typedef struct random_arm {
    parameters parameters;
    double angle, velocity;
    char settings[MOST_SETTINGS][LONGEST_SETTING];
    int count;
} random_arm;

// A number whose logarithm is spread evenly.
static double between(random_generator *g, double from, double to)
{
    return from * exp(random_uniform(g) * log(to / from));
}

static __attribute__((format(printf, 2, 3))) void set(random_arm *r, const char *format,
                                                      ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(r->settings[r->count], sizeof r->settings[0], format, values);
    va_end(values);
    r->count++;
}

// A list of numbers of one beam in pieces: `mean` times or over so much.
static void set_list(random_arm *r, random_generator *g, const char *path, int count,
                     double mean, double share)
{
    char list[LONGEST_SETTING - 32];
    int at = 0;
    for (int k = 0; k < count; k++) {
        at += snprintf(list + at, sizeof list - (size_t)at, "%s%.2g", k > 0 ? "," : "",
                       mean * between(g, 1 / share, share));
    }
    set(r, "%s=%s", path, list);
}

static void describe(const random_arm *r, int number, const char *what)
{
    printf("%d: %s: %g rad, %g rad/s:", number, what, r->angle, r->velocity);
    for (int i = 0; i < r->count; i++) {
        printf(" %s", r->settings[i]);
    }
    printf("\n");
    fflush(stdout);
}

// Runs of random settings, for the programs that look at what holds of each.
#pragma once

#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <unistd.h>

#include "src/base/random.h"
#include "src/run/run.h"

// How a number is spread over its range.
typedef enum spread {
    EVEN,        // evenly
    LOGARITHMIC, // its logarithm evenly
    OR_ZERO,     // half of the time zero, else its logarithm evenly
    ENDS,        // a quarter of the time each end, else evenly
} spread;

static double number_within(random_generator *g, double from, double to, spread how)
{
    const double first = random_uniform(g), second = random_uniform(g);
    switch (how) {
    case EVEN:
        return from + (to - from) * second;
    case LOGARITHMIC:
        return from * exp(second * log(to / from));
    case OR_ZERO:
        return first < 0.5 ? 0 : from * exp(second * log(to / from));
    case ENDS:
        return first < 0.25 ? from : first < 0.5 ? to : from + (to - from) * second;
    }
    return from;
}

// A run of random settings, kept as options of the command line too.
typedef struct random_run {
    int kind;
    uint64_t number;
    bool must_fit; // whether a value out of its range is a fault of the program
    random_generator chance;
    scenario scenario;
    char options[4096];
} random_run;

// Nothing set yet; `seed` is what its numbers are drawn from.
static void begin_run(random_run *r, int kind, uint64_t number, uint64_t seed)
{
    static char name[] = "random", none[] = "";
    *r = (random_run){.kind = kind, .number = number};
    r->scenario =
        (scenario){.name = name, .file = none, .title = none, .description = none};
    parameters_defaults(&r->scenario.parameters, ARM_CORRECTED);
    random_seed(&r->chance, seed);
}

// Sets a parameter, unless the value is out of its range.
static void set(random_run *r, const char *path, const char *value)
{
    const size_t length = strlen(r->options);
    fault f = {0};
    if (parameter_set_text(&r->scenario.parameters, parameter_index(path), value, &f) ==
        STATUS_OK) {
        snprintf(r->options + length, sizeof r->options - length, " --set %s=%s", path,
                 value);
    } else if (r->must_fit) {
        fprintf(stderr, "%s=%s: %s\n", path, value, f.text);
        exit(2);
    }
}

static void set_number(random_run *r, const char *path, double value)
{
    char text[32];
    const bool whole = parameter_table[parameter_index(path)].type == PARAMETER_INTEGER;
    snprintf(text, sizeof text, "%.17g", whole ? floor(value) : value);
    set(r, path, text);
}

// Ends the program, whatever it does, with a sentence.
static void end_with(const char *sentence)
{
    ssize_t ignored = write(STDOUT_FILENO, sentence, strlen(sentence));
    (void)ignored;
    _exit(2);
}

// What is expected of a value, and what was found wrong, by kind.
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

enum { MOST_KINDS = 64, MOST_SAID = 8 };

// Where the lab does not agree yet, by how much at most, and why. These count apart; a
// line goes with what it is about.
static const struct known {
    const char *what;
    double most;
    const char *why;
} known[] = {
    {"force_reading with hysteresis alone", (double)INFINITY,
     "extremes of parabolas, to 1e-3"},
    {"max_penetration_m", 1e-4, "a depth beyond the end of a step"},
    {"smoothed_over_command_N", 1e-5, "the largest window is found nearly"},
};

// Whether a disagreement of this size is known.
static bool is_known(const char *what, double off)
{
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        if (strcmp(known[k].what, what) == 0) {
            return off <= known[k].most;
        }
    }
    return false;
}

// Complaints by kind, over all rigs.
struct kind {
    const char *what;
    long rigs, values;
    uint64_t last, worst_rig;
    double worst; // the largest distance from what is expected
};

static struct kind kinds[MOST_KINDS];
static int kind_count;
static long checked;

static struct kind *kind_of(const char *what)
{
    int k = 0;
    while (k < kind_count && strcmp(kinds[k].what, what) != 0) {
        k++;
    }
    if (k == kind_count) {
        kinds[kind_count++] = (struct kind){.what = what, .last = UINT64_MAX};
    }
    return &kinds[k];
}

void expect(rig *r, const char *what, double at, double got, double low, double high)
{
    checked++;
    if (got >= low && got <= high) {
        return;
    }
    const double off = got < low ? low - got : got - high;
    const bool counts = !is_known(what, off);
    struct kind *k = kind_of(what);
    if (k->last != r->number) {
        k->last = r->number;
        k->rigs++;
    }
    if (counts && r->wrong < MOST_SAID) {
        printf("%" PRIu64 ": %s at %.9g s is %.10g, expected %.10g to %.10g\n", r->number,
               what, at, got, low, high);
    }
    if (!(off <= k->worst)) {
        k->worst = off;
        k->worst_rig = r->number;
    }
    k->values++;
    r->wrong += counts;
}

void expect_near(rig *r, const char *what, double at, double got, double wanted,
                 double error)
{
    if (isnan(wanted) && isnan(got)) {
        return;
    }
    expect(r, what, at, got, wanted - error, wanted + error);
}

void print_what_was_wrong(void)
{
    for (int k = 0; k < kind_count; k++) {
        printf("    %s: %ld rigs, %ld values, off by up to %.3g (rig %" PRIu64 ")\n",
               kinds[k].what, kinds[k].rigs, kinds[k].values, kinds[k].worst,
               kinds[k].worst_rig);
    }
}

long values_checked(void)
{
    return checked;
}

// Compares values of the lab with what is expected of them, prints those that are wrong
// and keeps a tally of them by kind. A kind is named by the text that each call of
// expect() gives, "peak_force_N" for instance.
#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

enum { MOST_KINDS = 64, MOST_LINES_OF_A_RIG = 8 };

// Kinds of values in which the lab is known to differ from what is expected: by how much
// at most, and why. Such a value appears in the tally but does not make the rig wrong.
static const struct known_difference {
    const char *kind;
    double most;
    const char *why;
} known_differences[] = {
    {"force_reading with hysteresis alone", (double)INFINITY,
     "extremes of parabolas, to 1e-3"},
    {"max_penetration_m", 1e-4, "a depth beyond the end of a step"},
    {"smoothed_over_command_N", 1e-5, "the largest window is found nearly"},
};

static bool is_known_difference(const char *kind, double difference)
{
    for (size_t k = 0; k < sizeof known_differences / sizeof known_differences[0]; k++) {
        if (strcmp(known_differences[k].kind, kind) == 0) {
            return difference <= known_differences[k].most;
        }
    }
    return false;
}

// The wrong values of one kind, over all rigs.
struct tally {
    const char *kind;
    long rigs, values;            // how many rigs had one, and how many there were
    uint64_t last_rig, worst_rig; // numbers of rigs
    double worst;                 // the largest difference from what is expected
};

static struct tally tallies[MOST_KINDS];
static int tally_count;
static long checked;

// The tally of a kind; a new one when the kind has none yet.
static struct tally *tally_of(const char *kind)
{
    for (int k = 0; k < tally_count; k++) {
        if (strcmp(tallies[k].kind, kind) == 0) {
            return &tallies[k];
        }
    }
    assert(tally_count < MOST_KINDS);
    struct tally *added = &tallies[tally_count++];
    *added = (struct tally){.kind = kind, .last_rig = UINT64_MAX};
    return added;
}

static void add_to_tally(const char *kind, uint64_t rig_number, double difference)
{
    struct tally *t = tally_of(kind);
    t->values++;
    if (t->last_rig != rig_number) {
        t->last_rig = rig_number;
        t->rigs++;
    }

    // not `difference > t->worst`, which would be false of a NaN
    if (!(difference <= t->worst)) {
        t->worst = difference;
        t->worst_rig = rig_number;
    }
}

// Counts the value and, if it is not within the bounds, adds it to the tally. Unless the
// difference is a known one, it also makes the rig wrong, and the first few such values
// of a rig are printed. A NaN is never within bounds.
void expect(rig *r, const char *what, double at, double got, double low, double high)
{
    checked++;
    if (got >= low && got <= high) {
        return;
    }

    const double difference = got < low ? low - got : got - high;
    add_to_tally(what, r->number, difference);
    if (is_known_difference(what, difference)) {
        return;
    }

    if (r->wrong < MOST_LINES_OF_A_RIG) {
        printf("%" PRIu64 ": %s at %.9g s is %.10g, expected %.10g to %.10g\n", r->number,
               what, at, got, low, high);
    }
    r->wrong++;
}

// The value is `wanted` to within `error`; both may be NaN, which stands for "none".
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
    for (int k = 0; k < tally_count; k++) {
        const struct tally *t = &tallies[k];
        printf("    %s: %ld rigs, %ld values, off by up to %.3g (rig %" PRIu64 ")\n",
               t->kind, t->rigs, t->values, t->worst, t->worst_rig);
    }
}

long values_checked(void)
{
    return checked;
}

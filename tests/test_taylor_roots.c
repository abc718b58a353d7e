// Where a watched function first falls below zero (taylor_roots.h): of functions that
// come back above zero and fall again the first fall is found, or none.
#define LANES 1
#include "src/engines/pair/taylor_roots.h"

#include "tests/check.h"

enum { TERMS = 4, FUNCTIONS = 20000 };

// Puts three numbers into ascending order.
static void sort_three(double *x)
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            if (x[k] > x[k + 1]) {
                const double larger = x[k];
                x[k] = x[k + 1];
                x[k + 1] = larger;
            }
        }
    }
}

// (r0 - t) (r1 - t) (r2 - t), times the sign, for times from 0 to 1: what is found of its
// roots.
static double root_found(const double *r, double sign)
{
    const double terms[TERMS] = {sign * r[0] * r[1] * r[2],
                                 -sign * (r[0] * r[1] + r[0] * r[2] + r[1] * r[2]),
                                 sign * (r[0] + r[1] + r[2]), -sign};
    const enclosure c = enclosure_of(terms, TERMS, 1);
    const edge_limits limits = {EDGE_GAP, EDGE_RATE, EDGE_MORE};
    const double first = least_at_first(&c, terms, sign, 1, 0, &limits);
    const enclosed_function f = {terms, TERMS, &c, sign, first, 1, 0};
    return first_root(&f);
}

TEST(of_three_roots_the_first_is_found)
{
    random_generator g = seeded(31);
    int found = 0, last = 0;
    for (int i = 0; i < FUNCTIONS; i++) {
        double r[3];
        for (int k = 0; k < 3; k++) {
            r[k] = 0.01 + random_uniform(&g);
        }
        sort_three(r);
        const double root = root_found(r, i % 2 ? 1 : -1);
        if (root >= 0) {
            check_close(root, r[0], 1e-6);
            found++;
            last += r[1] < 0.75 && r[2] < 1;
        }
    }

    // many are, some of functions that fall again later
    assert_true(found > FUNCTIONS / 20);
    assert_true(last > FUNCTIONS / 50);
}

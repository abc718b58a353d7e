// The products of which the series of two links are made (taylor_kernel.c), summed up by
// coefficient.
//
// The products of a coefficient are summed up in two turns, even and odd, and those of
// the newest factors added at last: so additions wait neither for each other nor for what
// is being computed.
#pragma once

#include <stddef.h>

#include "src/engines/pair/taylor_numbers.h"
#include "src/engines/pair/taylor_series.h"

// Sums of products go four, or two, side by side. Those of a single arm fill a vector so;
// with several arms each is a vector of its own.
#if LANES == 1
typedef double two __attribute__((vector_size(16)));
typedef double four __attribute__((vector_size(32)));
typedef two both;
typedef four halves; // low, low, high, high
#define TWO(a, b)        ((two){a, b})
#define FOUR(a, b, c, d) ((four){a, b, c, d})
#define PART(x, i)       ((x)[i])
#else
typedef struct two {
    real part[2];
} two;
typedef struct four {
    real part[4];
} four;
#define TWO(a, b)        ((two){{a, b}})
#define FOUR(a, b, c, d) ((four){{a, b, c, d}})
#define PART(x, i)       ((x).part[i])
#endif

typedef struct sums {
    four turning;  // v c, v s, w2 C2, w2 S2; of the next coefficient
    four products; // c w2 of the next coefficient, w1 w2, s w1 w2, the hub's square
    two levered;   // in contact: f c, f C2; plane: f C1, f C2
    two turning1;  // plane: w1 C1, w1 S1; of the next coefficient
} sums;

static const sums no_sums;

// Factors of the products, by coefficient.
#if LANES == 1
typedef struct order_factors {
    halves rates;    // v, w2
    four directions; // c, s of the bend; C2, S2
    four left;       // c_(n+1), w1_n, s_(n+1), the hub's velocity
    four right;      // w2_n, w2_n, (w1 w2)_(n-1), the hub's velocity
    both forces;     // in contact: f
    two levers;      // in contact: c, C2; plane: C1, C2
    both rate1;      // plane: w1
    two direction1;  // plane: C1, S1
} order_factors;
typedef struct factors {
    order_factors of[TAYLOR_MOST + 2];
    real v[TAYLOR_MOST + 2], coupled[TAYLOR_MOST + 2]; // of the bend; (w1 w2)_(n-1)
} factors;

#define DIRECTIONS(x, n) ((x)->of[n].directions)
#define DIRECTION1(x, n) ((x)->of[n].direction1)
#else
#define DIRECTIONS(x, n) ((x)->directions[n])
#define DIRECTION1(x, n) ((x)->direction1[n])
typedef struct factors {
    four directions[TAYLOR_MOST + 2];
    two direction1[TAYLOR_MOST + 2];
    real v[TAYLOR_MOST + 2], coupled[TAYLOR_MOST + 2]; // of the bend; (w1 w2)_(n-1)
    const real *w1, *w2, *hub, *f;                     // in the block
} factors;
#endif

// Which sums a product is for, all of `sums` unless more is said there.
enum product_sum { TURNING = 1, PRODUCTS = 2, LEVERED = 4, TURNING1 = 8 };

// Adds the j-th products for the n-th coefficient to these sums.
#if LANES == 1
KERNEL void accumulate_products(sums *s, const factors *x, ptrdiff_t j, ptrdiff_t n,
                                const int to, const int point)
{
    const order_factors *at = &x->of[j];
    (void)point;
    if (to & TURNING) {
        s->turning += at->rates * x->of[n + 1 - j].directions;
    }
    if (to & PRODUCTS) {
        s->products += at->left * x->of[n - j].right;
    }
    if (to & LEVERED) {
        s->levered += at->forces * x->of[n - j].levers;
    }
    if (to & TURNING1) {
        s->turning1 += at->rate1 * x->of[n + 1 - j].direction1;
    }
}
#else
KERNEL void accumulate_products(sums *s, const factors *x, ptrdiff_t j, ptrdiff_t n,
                                const int to, const int point)
{
    if (to & TURNING) {
        const four *next = &x->directions[n + 1 - j];
        s->turning.part[0] += x->v[j] * next->part[0];
        s->turning.part[1] += x->v[j] * next->part[1];
        s->turning.part[2] += x->w2[j] * next->part[2];
        s->turning.part[3] += x->w2[j] * next->part[3];
    }
    if (to & PRODUCTS) {
        s->products.part[0] += x->directions[j + 1].part[0] * x->w2[n - j];
        s->products.part[1] += x->w1[j] * x->w2[n - j];
        s->products.part[2] += x->directions[j + 1].part[1] * x->coupled[n - j];
        s->products.part[3] += x->hub[j] * x->hub[n - j];
    }
    if (to & LEVERED) {
        const four *other = &x->directions[n - j];
        s->levered.part[0] +=
            x->f[j] * (point ? other->part[0] : x->direction1[n - j].part[0]);
        s->levered.part[1] += x->f[j] * other->part[2];
    }
    if (to & TURNING1) {
        s->turning1.part[0] += x->w1[j] * x->direction1[n + 1 - j].part[0];
        s->turning1.part[1] += x->w1[j] * x->direction1[n + 1 - j].part[1];
    }
}
#endif

// Sums for the n-th coefficient from j = 1 to n - 1, two at least: the first and the last
// are left to be added.
KERNEL void add_in_turns(sums *even, sums *odd, const factors *x, ptrdiff_t n,
                         const int to, const int point)
{
    ptrdiff_t j = 3;
    accumulate_products(even, x, 1, n, to, point);
    accumulate_products(odd, x, 2, n, to, point);
    for (; j + 1 < n; j += 2) {
        accumulate_products(even, x, j, n, to, point);
        accumulate_products(odd, x, j + 1, n, to, point);
    }
    if (j < n) {
        accumulate_products(even, x, j, n, to, point);
    }
}

KERNEL void inner_sums(const factors *x, ptrdiff_t n, const int to, const int point,
                       sums *result)
{
    // a sum begins with -0, to which any number adds up to itself
    const real none = -(real){0};
    const four four_none = FOUR(none, none, none, none);
    const two two_none = TWO(none, none);
    const sums nothing = {four_none, four_none, two_none, two_none};
    if (n < 3) {
        *result = no_sums;
        if (n == 2) { // one of them
            *result = nothing;
            accumulate_products(result, x, 1, n, to, point);
        }
        return;
    }

    sums even = nothing, odd = nothing;
#if LANES == 1 || LANES == 8
    // all together, as one arm and AVX-512 leave registers enough
    add_in_turns(&even, &odd, x, n, to, point);
#else
    add_in_turns(&even, &odd, x, n, TURNING, point);
    add_in_turns(&even, &odd, x, n, PRODUCTS, point);
    if (to & LEVERED) {
        add_in_turns(&even, &odd, x, n, LEVERED, point);
    }
    if (to & TURNING1) {
        add_in_turns(&even, &odd, x, n, TURNING1, point);
    }
#endif
    for (int i = 0; i < 4; i++) {
        PART(result->turning, i) = PART(even.turning, i) + PART(odd.turning, i);
        PART(result->products, i) = PART(even.products, i) + PART(odd.products, i);
    }
    for (int i = 0; i < 2; i++) {
        PART(result->levered, i) = PART(even.levered, i) + PART(odd.levered, i);
        PART(result->turning1, i) = PART(even.turning1, i) + PART(odd.turning1, i);
    }
}

// (x^2)_n: twice the half of the sum.
KERNEL real square(const real *x, int n)
{
    real sum = (real){0};
    for (int j = (n + 1) / 2 - 1; j >= 0; j--) {
        sum += x[j] * x[n - j];
    }
    sum += sum;
    return n % 2 == 0 ? sum + x[n / 2] * x[n / 2] : sum;
}

// What the newest coefficients are to the products, where that is not read from the
// series.
#if LANES == 1
#define KEEP(x, n, factor, value) ((x)->of[n].factor = (value))
#else
#define KEEP(x, n, factor, value) ((void)(x), (void)(n), (void)(value))
#endif
KERNEL void keep_rates(factors *x, ptrdiff_t n, real v, real w1, real w2)
{
    x->v[n] = v;
    KEEP(x, n, rates, FOUR(v, v, w2, w2));
    KEEP(x, n, rate1, TWO(w1, w1));
}

KERNEL void keep_products(factors *x, ptrdiff_t n, real w1, real w2, real coupled,
                          real hub)
{
    const four next = DIRECTIONS(x, n + 1);
    x->coupled[n] = coupled;
    KEEP(x, n, left, FOUR(PART(next, 0), w1, PART(next, 1), hub));
    KEEP(x, n, right, FOUR(w2, w2, coupled, hub));
}

KERNEL void keep_levers(factors *x, ptrdiff_t n, const int point)
{
    const real first = point ? PART(DIRECTIONS(x, n), 0) : PART(DIRECTION1(x, n), 0);
    KEEP(x, n, levers, TWO(first, PART(DIRECTIONS(x, n), 2)));
}

KERNEL void store_force(factors *x, ptrdiff_t n, real f)
{
    KEEP(x, n, forces, TWO(f, f));
}

// Cosines and sines of two angles, and of one, from the sums of the order before, v c and
// v s.
KERNEL void set_directions(const four *sum, double share, four *direction)
{
    *direction = FOUR(PART(*sum, 1) * -share, PART(*sum, 0) * share,
                      PART(*sum, 3) * -share, PART(*sum, 2) * share);
}

KERNEL void turn_one(const two *sum, double share, two *direction)
{
    *direction = TWO(PART(*sum, 1) * -share, PART(*sum, 0) * share);
}

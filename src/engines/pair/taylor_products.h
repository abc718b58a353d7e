// The products of which the series of two links are made (taylor_kernel.h), summed up by
// coefficient.
//
// The products of a coefficient are summed up in two turns, even and odd, and those of the newest
// factors added at last: so additions wait neither for each other nor for what is being computed.
#pragma once

#include <stddef.h>

#include "src/engines/pair/taylor_numbers.h"
#include "src/engines/pair/taylor_series.h"

// Sums of products go four, or two, side by side. Those of a single arm fill a vector so; with
// several arms each is a vector of its own.
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
    real v[TAYLOR_MOST + 2]; // of the bend
} factors;

#define DIRECTIONS(x, n)         ((x)->of[n].directions)
#define DIRECTION1(x, n)         ((x)->of[n].direction1)
#define TURNING(s, op, x, j, n)  ((s).turning op(x)->of[j].rates * (x)->of[(n) + 1 - (j)].directions)
#define PRODUCTS(s, op, x, j, n) ((s).products op(x)->of[j].left * (x)->of[(n) - (j)].right)
#define LEVERED(s, op, x, j, n)  ((s).levered op(x)->of[j].forces * (x)->of[(n) - (j)].levers)
#define TURNING1(s, op, x, j, n)                                                                   \
    ((s).turning1 op(x)->of[j].rate1 * (x)->of[(n) + 1 - (j)].direction1)
#else
#define DIRECTIONS(x, n) ((x)->directions[n])
#define DIRECTION1(x, n) ((x)->direction1[n])
typedef struct factors {
    four directions[TAYLOR_MOST + 2];
    two direction1[TAYLOR_MOST + 2];
    real v[TAYLOR_MOST + 2], coupled[TAYLOR_MOST + 2]; // of the bend; (w1 w2)_(n-1)
    const real *w1, *w2, *hub, *f;                     // in the block
} factors;

#define TURNING(s, op, x, j, n)                                                                    \
    ((s).turning.part[0] op(x)->v[j] * (x)->directions[(n) + 1 - (j)].part[0],                     \
     (s).turning.part[1] op(x)->v[j] * (x)->directions[(n) + 1 - (j)].part[1],                     \
     (s).turning.part[2] op(x)->w2[j] * (x)->directions[(n) + 1 - (j)].part[2],                    \
     (s).turning.part[3] op(x)->w2[j] * (x)->directions[(n) + 1 - (j)].part[3])
#define PRODUCTS(s, op, x, j, n)                                                                   \
    ((s).products.part[0] op(x)->directions[(j) + 1].part[0] * (x)->w2[(n) - (j)],                 \
     (s).products.part[1] op(x)->w1[j] * (x)->w2[(n) - (j)],                                       \
     (s).products.part[2] op(x)->directions[(j) + 1].part[1] * (x)->coupled[(n) - (j)],            \
     (s).products.part[3] op(x)->hub[j] * (x)->hub[(n) - (j)])
#define LEVERED(s, op, x, j, n)                                                                    \
    ((s).levered.part[0] op(x)->f[j] *                                                             \
         (point ? (x)->directions[(n) - (j)].part[0] : (x)->direction1[(n) - (j)].part[0]),        \
     (s).levered.part[1] op(x)->f[j] * (x)->directions[(n) - (j)].part[2])
#define TURNING1(s, op, x, j, n)                                                                   \
    ((s).turning1.part[0] op(x)->w1[j] * (x)->direction1[(n) + 1 - (j)].part[0],                   \
     (s).turning1.part[1] op(x)->w1[j] * (x)->direction1[(n) + 1 - (j)].part[1])
#endif

#define ADD_TURNING(s, x, j, n)  TURNING(s, +=, x, j, n)
#define ADD_PRODUCTS(s, x, j, n) PRODUCTS(s, +=, x, j, n)
#define ADD_LEVERED(s, x, j, n)  LEVERED(s, +=, x, j, n)
#define ADD_TURNING1(s, x, j, n) TURNING1(s, +=, x, j, n)

// Sums for the n-th coefficient from j = 1 to n - 1, two at least: the first and the last are left
// to be added.
#define IN_TURNS(SUM)                                                                              \
    do {                                                                                           \
        ptrdiff_t j = 3;                                                                           \
        SUM(even, =, x, 1, n);                                                                     \
        SUM(odd, =, x, 2, n);                                                                      \
        for (; j + 1 < n; j += 2) {                                                                \
            SUM(even, +=, x, j, n);                                                                \
            SUM(odd, +=, x, j + 1, n);                                                             \
        }                                                                                          \
        if (j < n) {                                                                               \
            SUM(even, +=, x, j, n);                                                                \
        }                                                                                          \
    } while (0)

KERNEL void inner_sums(const factors *x, ptrdiff_t n, const int contact, const int point,
                       sums *result)
{
    // none, or one of them
#define SUM_ALL(s, op, x, j, n)                                                                    \
    do {                                                                                           \
        TURNING(s, op, x, j, n);                                                                   \
        PRODUCTS(s, op, x, j, n);                                                                  \
        if (contact) {                                                                             \
            LEVERED(s, op, x, j, n);                                                               \
        }                                                                                          \
        if (!point) {                                                                              \
            TURNING1(s, op, x, j, n);                                                              \
        }                                                                                          \
    } while (0)
    if (n < 3) {
        *result = no_sums;
        if (n == 2) {
            SUM_ALL(*result, =, x, 1, n);
        }
        return;
    }

    sums even, odd;
#if LANES == 1 || LANES == 8
    // all together, as one arm and AVX-512 leave registers enough
    IN_TURNS(SUM_ALL);
#else
    IN_TURNS(TURNING);
    IN_TURNS(PRODUCTS);
    if (contact) {
        IN_TURNS(LEVERED);
    }
    if (!point) {
        IN_TURNS(TURNING1);
    }
#endif
    for (int i = 0; i < 4; i++) {
        PART(result->turning, i) = PART(even.turning, i) + PART(odd.turning, i);
        PART(result->products, i) = PART(even.products, i) + PART(odd.products, i);
    }
    for (int i = 0; i < 2; i++) {
        if (contact) {
            PART(result->levered, i) = PART(even.levered, i) + PART(odd.levered, i);
        }
        if (!point) {
            PART(result->turning1, i) = PART(even.turning1, i) + PART(odd.turning1, i);
        }
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

// What the newest coefficients are to the products, where that is not read from the series.
#if LANES == 1
KERNEL void keep_rates(factors *x, ptrdiff_t n, real v, real w1, real w2)
{
    x->v[n] = v;
    x->of[n].rates = FOUR(v, v, w2, w2);
    x->of[n].rate1 = TWO(w1, w1);
}

KERNEL void keep_products(factors *x, ptrdiff_t n, real w1, real w2, real coupled, real hub)
{
    const four next = x->of[n + 1].directions;
    x->of[n].left = FOUR(next[0], w1, next[1], hub);
    x->of[n].right = FOUR(w2, w2, coupled, hub);
}

KERNEL void keep_levers(factors *x, ptrdiff_t n, const int point)
{
    const order_factors *at = &x->of[n];
    x->of[n].levers = TWO(point ? at->directions[0] : at->direction1[0], at->directions[2]);
}

KERNEL void keep_force(factors *x, ptrdiff_t n, real f)
{
    x->of[n].forces = TWO(f, f);
}
#else
KERNEL void keep_rates(factors *x, ptrdiff_t n, real v, real w1, real w2)
{
    x->v[n] = v;
    (void)w1, (void)w2;
}

KERNEL void keep_products(factors *x, ptrdiff_t n, real w1, real w2, real coupled, real hub)
{
    (void)w1, (void)w2, (void)hub;
    x->coupled[n] = coupled;
}

KERNEL void keep_levers(factors *x, ptrdiff_t n, const int point)
{
    (void)x, (void)n, (void)point;
}

KERNEL void keep_force(factors *x, ptrdiff_t n, real f)
{
    (void)x, (void)n, (void)f;
}
#endif

// Cosines and sines of two angles, and of one, from the sums of the order before, v c and v s.
#if LANES == 1
KERNEL void turn(const four *sum, double share, four *direction)
{
    *direction =
        __builtin_shufflevector(*sum, *sum, 1, 0, 3, 2) * FOUR(-share, share, -share, share);
}

KERNEL void turn_one(const two *sum, double share, two *direction)
{
    *direction = __builtin_shufflevector(*sum, *sum, 1, 0) * TWO(-share, share);
}
#else
KERNEL void turn(const four *sum, double share, four *direction)
{
    *direction = FOUR(PART(*sum, 1) * -share, PART(*sum, 0) * share, PART(*sum, 3) * -share,
                      PART(*sum, 2) * share);
}

KERNEL void turn_one(const two *sum, double share, two *direction)
{
    *direction = TWO(PART(*sum, 1) * -share, PART(*sum, 0) * share);
}
#endif

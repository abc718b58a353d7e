// Numbers in vectors of LANES (a power of two, given by meson.build): those of the
// compiler. Every operation is written out in its order, without a branch on what a lane
// holds but where all take the same value from both ways, so that all widths give the
// same bits.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#if defined __x86_64__
#include <immintrin.h>
#endif

#include "src/base/kernel.h"
#include "src/base/sincos.h"
#include "src/engines/pair/taylor_series.h"

#if LANES == 1
typedef double real;
typedef int64_t mask;
#define MASK(condition) ((condition) ? (mask)-1 : (mask)0)
#else
typedef double real __attribute__((vector_size(8 * LANES)));
typedef int64_t mask __attribute__((vector_size(8 * LANES)));
#define MASK(condition) ((mask)(condition))
#endif

KERNEL mask bits_of(real x)
{
    mask m;
    memcpy(&m, &x, sizeof m);
    return m;
}

KERNEL real real_of(mask m)
{
    real x;
    memcpy(&x, &m, sizeof x);
    return x;
}

KERNEL real select_lanes(mask where, real yes, real no)
{
    return real_of((where & bits_of(yes)) | (~where & bits_of(no)));
}

KERNEL real magnitude(real x)
{
    return real_of(bits_of(x) & INT64_MAX);
}

KERNEL real greater(real x, real y)
{
    return select_lanes(MASK(x > y), x, y);
}

// Whether some lane of a mask is set: by the signs of all its lanes at once, where there
// is an instruction for that.
KERNEL bool any(mask m)
{
#if LANES == 1
    return m != 0;
#elif LANES == 2 && defined __SSE2__
    return _mm_movemask_pd((__m128d)m) != 0;
#elif LANES == 4 && defined __AVX2__
    return _mm256_movemask_pd((__m256d)m) != 0;
#elif LANES == 8 && defined __AVX512DQ__
    return _mm512_movepi64_mask((__m512i)m) != 0;
#else
    int64_t some = 0;
    for (int i = 0; i < LANES; i++) {
        some |= m[i];
    }
    return some != 0;
#endif
}

// What inline_sincos gives, for |x| < 1e5.
KERNEL void sine_cosine(real x, real *sine, real *cosine)
{
    real r = x;
    mask quadrant = (mask){0};
    const mask large = ~MASK(magnitude(x) <= 0.78539816339744831);
    const bool reduced = any(large);
    if (reduced) {
        const real shifted = SINCOS_QUARTERS(x) + SINCOS_ROUND;
        const real n = select_lanes(large, shifted - SINCOS_ROUND, (real){0});
        quadrant = large & bits_of(shifted) & 3;
        SINCOS_REDUCE(real, x, n, r);
        r = select_lanes(large, r, x);
    }

    real s, c;
    SINCOS_NEAR_ZERO(real, r, s, c);
    *sine = s;
    *cosine = c;
    if (reduced) {
        const mask odd = -(quadrant & 1), lower = -((quadrant >> 1) & 1);
        const mask left = -(((quadrant + 1) >> 1) & 1);
        const real a = select_lanes(odd, c, s), b = select_lanes(odd, s, c);
        *sine = select_lanes(lower, -a, a);
        *cosine = select_lanes(left, -b, b);
    }
}

// The same of two angles: those of a single arm share a vector.
KERNEL void sines_cosines(const real x[2], real sine[2], real cosine[2])
{
#if LANES == 1
    typedef double two __attribute__((vector_size(16)));
    if (fabs(x[0]) <= 0.78539816339744831 && fabs(x[1]) <= 0.78539816339744831) {
        const two r = {x[0], x[1]};
        two s, c;
        SINCOS_NEAR_ZERO(two, r, s, c);
        memcpy(sine, &s, sizeof s);
        memcpy(cosine, &c, sizeof c);
        return;
    }
#endif
    for (int i = 0; i < 2; i++) {
        sine_cosine(x[i], &sine[i], &cosine[i]);
    }
}

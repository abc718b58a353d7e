// Additions to cmocka for every test program: comparisons of doubles that print both values.
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

// Fails unless |a - b| <= tolerance; NaN never passes.
#define check_close(a, b, tolerance)                                                               \
    do {                                                                                           \
        double check_a = (a), check_b = (b), check_t = (tolerance);                                \
        if (!(fabs(check_a - check_b) <= check_t)) {                                               \
            fail_msg("%s = %.17g, expected %s = %.17g within %g (off by %g)", #a, check_a, #b,     \
                     check_b, check_t, check_a - check_b);                                         \
        }                                                                                          \
    } while (0)

// Fails unless |a - b| <= relative * |b|.
#define check_relative(a, b, relative) check_close(a, b, (relative)*fabs(b))

// Fails unless a < b; prints both.
#define check_below(a, b)                                                                          \
    do {                                                                                           \
        double check_a = (a), check_b = (b);                                                       \
        if (!(check_a < check_b)) {                                                                \
            fail_msg("%s = %.17g is not below %s = %.17g", #a, check_a, #b, check_b);              \
        }                                                                                          \
    } while (0)

// The bits of a number in double precision: sign, 11 of the exponent, 52 of the fraction (IEEE
// 754).
#pragma once

#include <stdint.h>
#include <string.h>

static inline uint64_t double_bits(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double double_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

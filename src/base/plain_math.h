// Exponential, logarithm, power and arctangents from nothing but IEEE
// additions, multiplications, divisions and square roots.
//
// The C library picks its code for them (with or without fused multiply-add) by the
// processor, so that their last bit, and with it that of a run, would depend on the
// machine. These give the same bits everywhere, within 2 units in the last place where
// nothing else is said; sine and cosine are in sincos.h.
#pragma once

#include <stdint.h>
#include <string.h>

// e^x; 0 and infinity beyond the range of doubles.
double plain_exp(double x);

// Natural logarithm of a number above zero; -infinity at zero, NaN of NaN.
double plain_log(double x);

// x^y for x above zero or zero; within y log(x) units in the last place.
double plain_pow(double x, double y);

// The angle of the point (x, y) from the x axis, from -pi to pi [rad], both finite; 0 at
// the origin.
double plain_atan2(double y, double x);

// The bits of a number in double precision: sign, 11 of the exponent, 52 of the fraction
// (IEEE 754); and the number of such bits.
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

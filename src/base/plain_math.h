// Exponential, logarithm and power from nothing but IEEE additions, multiplications and divisions.
//
// The C library picks its code for them (with or without fused multiply-add) by the processor, so
// that their last bit, and with it that of a run, would depend on the machine. These give the same
// bits everywhere, within 2 units in the last place; sine and cosine are in sincos.h.
#pragma once

// e^x; 0 and infinity beyond the range of doubles.
double plain_exp(double x);

// Natural logarithm of a normal number above zero; -infinity at zero.
double plain_log(double x);

// x^y for x above zero or zero; within y log(x) units in the last place.
double plain_pow(double x, double y);

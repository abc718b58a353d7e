// The larger and the smaller of two numbers as one instruction each. The C library's fmax and fmin
// answer for NaN, too, and are calls for it; these say what they say of two numbers that are none.
#pragma once

// y if one of them is NaN.
static inline double larger(double x, double y)
{
    return x > y ? x : y;
}

// y if one of them is NaN.
static inline double smaller(double x, double y)
{
    return x < y ? x : y;
}

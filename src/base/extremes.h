// The larger and the smaller of two numbers as one instruction each. The C library's fmax
// and fmin also handle NaN and are therefore function calls; for arguments that are not
// NaN these return the same.
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

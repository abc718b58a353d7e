// The shortest decimal number that reads back as a given double, of those the nearest to it: the
// algorithm Schubfach of R. Giulietti, The Schubfach way to render doubles, 2020.
#pragma once

#include <stdint.h>

// value = digits * 10^exponent; digits does not end in a zero.
typedef struct decimal {
    uint64_t digits;
    int exponent;
} decimal;

// That number for a finite value above zero.
decimal shortest_decimal(double value);

// 10^k / 2^(floor(log2(10^k)) - 127) for k from POWERS_FROM to POWERS_TO, rounded up: high and low
// half, the highest bit set.
enum { POWERS_FROM = -292, POWERS_TO = 324 };
extern const uint64_t powers_of_ten[POWERS_TO - POWERS_FROM + 1][2];

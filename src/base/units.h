// Units that people type in the place of others: prefixes, degrees.
#pragma once

#include <stdbool.h>

// By what a number in the unit `from` is to be multiplied to be one in the unit `to`,
// both as the tables write them ("N m/rad"): of the first of their parts the prefix n, u,
// m, c, k, M or G may differ, and deg may stand for rad anywhere. False if they do not
// measure the same.
bool unit_factor(const char *from, const char *to, double *factor);

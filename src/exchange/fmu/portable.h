// Stands first in every source of an FMU, for compilers of other systems and without the
// project's options.
#pragma once

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif

// one width of vectors, that every processor has: all give the same bits
#define ONE_WIDTH

// no fused multiply-add behind our back
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#elif defined __GNUC__
#pragma GCC optimize("fp-contract=off")
#endif

#ifdef __GNUC__ // vectors stay within a file
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

#ifdef _WIN32
#include <locale.h>
#include <math.h>

// a thread has no locale of its own there
typedef int locale_t;
#define LC_ALL_MASK 0
static inline locale_t newlocale(int mask, const char *name, locale_t base)
{
    (void)mask;
    (void)name;
    return base;
}
static inline locale_t uselocale(locale_t locale)
{
    return locale;
}
#define memccpy(to, from, end, size) _memccpy(to, from, end, size)
#endif

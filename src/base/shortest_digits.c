#include "src/base/shortest_digits.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "src/base/double_bits.h"

// value = c 2^q: bits of c that are stored, and the exponent that the stored one is counted from.
enum { STORED_BITS = 52, EXPONENT_OFFSET = 1075 };

__extension__ typedef unsigned __int128 wide;

// floor(log2(10^e)), and floor(log10(2^q)) or, a quarter being gone below, floor(log10(3/4 2^q)):
// products with the logarithms in fixed point, exact over the range of doubles.
static int floor_log2_power(int e)
{
    return (e * 1741647) >> 19;
}

static int floor_log10_power(int q, bool closer_below)
{
    return (q * 1262611 - (closer_below ? 524031 : 0)) >> 22;
}

// g c / 2^128 rounded to odd: its last bit says that something was left over. With that every
// comparison with a multiple of four of such numbers comes out right.
static uint64_t round_to_odd(const uint64_t g[2], uint64_t c)
{
    const wide low = (wide)g[1] * c;
    const wide high = (wide)g[0] * c + (uint64_t)(low >> 64);
    return (uint64_t)(high >> 64) | ((uint64_t)high > 1);
}

static decimal without_zeros(decimal d)
{
    while (d.digits % 100 == 0) {
        d.digits /= 100;
        d.exponent += 2;
    }
    if (d.digits % 10 == 0) {
        d.digits /= 10;
        d.exponent++;
    }
    return d;
}

// The nearest multiple of 10^k, of 10^(k+1) if one of those reads back: value and the ends of its
// interval are given as quarters of 10^k, rounded to odd.
static decimal nearest_within(uint64_t lower, uint64_t value, uint64_t upper, int k)
{
    // a digit less
    const uint64_t s = value / 4, tens = s / 10;
    if (s >= 10) {
        const bool down = lower <= 40 * tens, up = 40 * tens + 40 <= upper;
        if (down != up) {
            return (decimal){tens + up, k + 1};
        }
    }

    // the one of both neighbours that reads back, or the nearer one, at the same distance the even
    const bool down = lower <= 4 * s, up = 4 * s + 4 <= upper;
    const uint64_t middle = 4 * s + 2;
    const bool nearer_above = value > middle || (value == middle && s % 2 == 1);
    return (decimal){s + (down != up ? up : nearer_above), k};
}

decimal shortest_decimal(double value)
{
    assert(value > 0 && isfinite(value));
    const uint64_t bits = double_bits(value);

    // value = c 2^q; whole numbers are their own digits
    const uint64_t stored = bits & ((UINT64_C(1) << STORED_BITS) - 1);
    const int exponent = (int)(bits >> STORED_BITS);
    const uint64_t c = exponent != 0 ? stored | UINT64_C(1) << STORED_BITS : stored;
    const int q = (exponent != 0 ? exponent : 1) - EXPONENT_OFFSET;
    if (q <= 0 && q > -STORED_BITS - 1 && (c & ((UINT64_C(1) << -q) - 1)) == 0) {
        return without_zeros((decimal){c >> -q, 0});
    }

    // the ends of the interval that reads back as value, in quarters of 2^q: half way to its
    // neighbours, the one below being nearer at a power of two; ends belong to even numbers
    const bool closer_below = stored == 0 && exponent > 1, odd = c % 2 == 1;
    const int k = floor_log10_power(q, closer_below);
    const int shift = q + floor_log2_power(-k) + 1;
    const uint64_t *power = powers_of_ten[-k - POWERS_FROM];
    const uint64_t lower = round_to_odd(power, (4 * c - 2 + closer_below) << shift);
    const uint64_t middle = round_to_odd(power, (4 * c) << shift);
    const uint64_t upper = round_to_odd(power, (4 * c + 2) << shift);
    return without_zeros(nearest_within(lower + odd, middle, upper - odd, k));
}

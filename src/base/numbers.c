#include "src/base/numbers.h"

#include <assert.h>
#include <ctype.h>
#include <locale.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/plain_math.h"

// Gives the calling thread the "C" locale; returns the one to go back to. The C library
// keeps the "C" locale for good: it is neither allocated here nor freed.
static locale_t enter_c_locale(void)
{
    return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

int decimal_vprint(char *text, size_t size, const char *format, va_list list)
{
    locale_t before = enter_c_locale();
    int length = vsnprintf(text, size, format, list);
    uselocale(before);
    return length;
}

int decimal_print(char *text, size_t size, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int length = decimal_vprint(text, size, format, list);
    va_end(list);
    return length;
}

char *decimal_vtext(const char *format, va_list list)
{
    char *text;
    locale_t before = enter_c_locale();
    int length = vasprintf(&text, format, list);
    uselocale(before);
    if (length < 0) {
        return NULL;
    }
    return text;
}

double decimal_parse(const char *text, char **end)
{
    locale_t before = enter_c_locale();
    double value = strtod(text, end);
    uselocale(before);
    return value;
}

// --- the shortest decimal number -------------------------------------------------------

__extension__ typedef unsigned __int128 wide;

// The bits of 10^k, k = -308, -280, ... 308, from the highest one that is set.
enum { POWERS_FROM = -308, POWERS_TO = 335, POWERS_APART = 28 };
static const uint64_t powers_of_ten[][3] = {
    {0xe61acf033d1a45df, 0x6fb92487298e33bd, 0xadd7728c20b99bd1},
    {0xe858ad248f5c22c9, 0xd1b3400f8f9cff68, 0xf910f9f648232f14},
    {0xea9c227723ee8bcb, 0x465e15a979c1cadc, 0x0a0ce827eac11f2d},
    {0xece53cec4a314ebd, 0xa4f8bf5635246428, 0x4609ac5c7899ca36},
    {0xef340a98172aace4, 0x86fb897116c87c34, 0x9c39c1da4c49278d},
    {0xf18899b1bc3f8ca1, 0xdc44e6c3cb279ac1, 0xf80f36174730ca34},
    {0xf3e2f893dec3f126, 0x5a89dba3c3efccfa, 0xd8ecb58659be9c90},
    {0xf64335bcf065d37d, 0x4d4617b5ff4a16d5, 0xaa09501d5954a559},
    {0xf8a95fcf88747d94, 0x75a44c6397ce912a, 0x33cca6c06b07b74d},
    {0xfb158592be068d2e, 0xeed6e2f0f0d56712, 0xac2e4f162cfad40a},
    {0xfd87b5f28300ca0d, 0x8bca9d6e188853fc, 0x76dcb60081ce0fa5},
    {0x8000000000000000, 0x0000000000000000, 0x0000000000000000},
    {0x813f3978f8940984, 0x4000000000000000, 0x0000000000000000},
    {0x82818f1281ed449f, 0xbff8f10e7a8921a4, 0x2000000000000000},
    {0x83c7088e1aab65db, 0x792667c6da79e0fa, 0x0861d3ee22d1cc53},
    {0x850fadc09923329e, 0x03e2cf6bc604ddb0, 0x74a7ef0198791097},
    {0x865b86925b9bc5c2, 0x0b8a2392ba45a9b2, 0x5c6658d409fb8bf7},
    {0x87aa9aff79042286, 0x90fb44d2f05d0842, 0xfb118fc9c217a1d2},
    {0x88fcf317f22241e2, 0x441fece3bdf81f03, 0x12f274928400100d},
    {0x8a5296ffe33cc92f, 0x82bd6b70d99aaa6f, 0xbc10c5c5cda97c8d},
    {0x8bab8eefb6409c1a, 0x1ad089b6c2f7548e, 0x25c7b885ba466e37},
    {0x8d07e33455637eb2, 0xdb0b487b6423e1e8, 0x7ec63730f500b406},
    {0x8e679c2f5e44ff8f, 0x570f09eaa7ea7648, 0x5961db50c6d2b886},
};

// The same of 5^r, r = 0, 1, ... 27, which are exact.
static const uint64_t powers_of_five[POWERS_APART] = {
    0x8000000000000000, 0xa000000000000000, 0xc800000000000000, 0xfa00000000000000,
    0x9c40000000000000, 0xc350000000000000, 0xf424000000000000, 0x9896800000000000,
    0xbebc200000000000, 0xee6b280000000000, 0x9502f90000000000, 0xba43b74000000000,
    0xe8d4a51000000000, 0x9184e72a00000000, 0xb5e620f480000000, 0xe35fa931a0000000,
    0x8e1bc9bf04000000, 0xb1a2bc2ec5000000, 0xde0b6b3a76400000, 0x8ac7230489e80000,
    0xad78ebc5ac620000, 0xd8d726b7177a8000, 0x878678326eac9000, 0xa968163f0a57b400,
    0xd3c21bcecceda100, 0x84595161401484a0, 0xa56fa5b99019a5c8, 0xcecb8f27f4200f3a};

// 10^k / 2^(floor(log2(10^k)) - 127) for -292 <= k <= 324, rounded up. All were compared
// with exact ones.
static wide make_power_of_ten(int k)
{
    // 10^k is 5^r times a stored power, but for its exponent
    const uint64_t *ten = powers_of_ten[(k - POWERS_FROM) / POWERS_APART];
    const uint64_t five = powers_of_five[(k - POWERS_FROM) % POWERS_APART];
    const wide low = (wide)ten[2] * five;
    const wide middle = (wide)ten[1] * five + (uint64_t)(low >> 64);
    wide high = (wide)ten[0] * five + (uint64_t)(middle >> 64);
    uint64_t rest = (uint64_t)middle;

    // the highest bit is set, and what is left over rounds up
    if (high >> 127 == 0) {
        high = high << 1 | rest >> 63;
        rest <<= 1;
    }
    if ((rest | (uint64_t)low) != 0) {
        high++;
    }
    return high;
}

// The same as high and low half g, made once: threads that make one at a time make the
// same.
static void wide_power_of_ten(int k, uint64_t g[2])
{
    static _Atomic uint64_t made[POWERS_TO - POWERS_FROM + 1][2];
    _Atomic uint64_t *known = made[k - POWERS_FROM];
    g[0] = atomic_load_explicit(&known[0], memory_order_acquire);
    g[1] = atomic_load_explicit(&known[1], memory_order_relaxed);
    if (g[0] == 0) {
        const wide power = make_power_of_ten(k);
        g[0] = (uint64_t)(power >> 64);
        g[1] = (uint64_t)power;
        atomic_store_explicit(&known[1], g[1], memory_order_relaxed);
        atomic_store_explicit(&known[0], g[0], memory_order_release);
    }
}

// value = c 2^q: bits of c that are stored, and the exponent that the stored one is
// counted from.
enum { STORED_BITS = 52, EXPONENT_OFFSET = 1075 };

// floor(log2(10^e)), and floor(log10(2^q)) or, a quarter being gone below,
// floor(log10(3/4 2^q)): products with the logarithms in fixed point, exact over the
// range of doubles.
static int floor_log2_power(int e)
{
    return (e * 1741647) >> 19;
}

// Of 2^q, or of 3/4 of it.
static int floor_log10_power(int q, bool closer_below)
{
    int product = q * 1262611;
    if (closer_below) {
        product -= 524031;
    }
    return product >> 22;
}

// g c / 2^128 rounded to odd: its last bit says that something was left over. With that
// every comparison with a multiple of four of such numbers comes out right.
static uint64_t round_to_odd(const uint64_t g[2], uint64_t c)
{
    const wide low = (wide)g[1] * c;
    const wide high = (wide)g[0] * c + (uint64_t)(low >> 64);
    return (uint64_t)(high >> 64) | ((uint64_t)high > 1);
}

// value = digits * 10^exponent; digits does not end in a zero.
typedef struct decimal {
    uint64_t digits;
    int exponent;
} decimal;

// The same number with digits that do not end in a zero.
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

// The nearest multiple of 10^k, of 10^(k+1) if one of those reads back: value and the
// ends of its interval are given as quarters of 10^k, rounded to odd.
static decimal nearest_within(uint64_t lower, uint64_t value, uint64_t upper, int k)
{
    // a digit less
    const uint64_t s = value / 4, tens = s / 10;
    if (s >= 10) {
        const bool down = lower <= 40 * tens, up = 40 * tens + 40 <= upper;
        if (down && !up) {
            return (decimal){tens, k + 1};
        }
        if (up && !down) {
            return (decimal){tens + 1, k + 1};
        }
    }

    // the one of both neighbours that reads back, or the nearer one, at the same distance
    // the even
    const bool down = lower <= 4 * s, up = 4 * s + 4 <= upper;
    const uint64_t middle = 4 * s + 2;
    const bool nearer_above = value > middle || (value == middle && s % 2 == 1);
    if ((up && !down) || (up == down && nearer_above)) {
        return (decimal){s + 1, k};
    }
    return (decimal){s, k};
}

// The shortest decimal number that reads back as a finite value above zero, of those the
// nearest to it: the algorithm Schubfach of R. Giulietti, The Schubfach way to render
// doubles, 2020.
static decimal shortest_decimal(double value)
{
    assert(value > 0 && isfinite(value));
    const uint64_t bits = double_bits(value);

    // value = c 2^q; whole numbers are their own digits
    const uint64_t stored = bits & ((UINT64_C(1) << STORED_BITS) - 1);
    const int exponent = (int)(bits >> STORED_BITS);
    uint64_t c = stored;
    int q = 1 - EXPONENT_OFFSET;
    if (exponent != 0) { // a normal number, whose first bit is not stored
        c = stored | UINT64_C(1) << STORED_BITS;
        q = exponent - EXPONENT_OFFSET;
    }
    if (q <= 0 && q > -STORED_BITS - 1 && (c & ((UINT64_C(1) << -q) - 1)) == 0) {
        return without_zeros((decimal){c >> -q, 0});
    }

    // the ends of the interval that reads back as value, in quarters of 2^q: half way to
    // its neighbours, the one below being nearer at a power of two; ends belong to even
    // numbers
    const bool closer_below = stored == 0 && exponent > 1;
    const uint64_t odd = c % 2;
    const int k = floor_log10_power(q, closer_below);
    const int shift = q + floor_log2_power(-k) + 1;
    uint64_t power[2];
    wide_power_of_ten(-k, power);
    const uint64_t below = closer_below ? 1 : 2;
    const uint64_t lower = round_to_odd(power, (4 * c - below) << shift);
    const uint64_t middle = round_to_odd(power, (4 * c) << shift);
    const uint64_t upper = round_to_odd(power, (4 * c + 2) << shift);
    return without_zeros(nearest_within(lower + odd, middle, upper - odd, k));
}

// --- writing ---------------------------------------------------------------------------

// The decimal digits of a number above zero, two at a time from the last; returns how
// many.
static int write_whole(char *text, uint64_t number)
{
    static const char pairs[] =
        "00010203040506070809101112131415161718192021222324252627282930313233343536373839"
        "40414243444546474849505152535455565758596061626364656667686970717273747576777879"
        "8081828384858687888990919293949596979899";
    char digits[20], *first = digits + sizeof digits;
    for (; number >= 10; number /= 100) {
        first -= 2;
        memcpy(first, pairs + 2 * (number % 100), 2);
    }
    if (number > 0) {
        *--first = (char)('0' + number);
    }

    const int count = (int)(digits + sizeof digits - first);
    memcpy(text, first, (size_t)count);
    return count;
}

// Digits d1 d2 ... dn as 0.000d1d2, as d1d2.d3 or as d1d2000; `place` is how many of them
// stand between d1 and the point, negative for zeros behind it. Returns the end.
static char *write_positional(char *text, const char *digits, int count, int place)
{
    if (place < 0) {
        memcpy(text, "0.0000", 6);
        memcpy(text + 1 - place, digits, (size_t)count);
        return text + 1 - place + count;
    }

    const int whole = count <= place ? count : place + 1;
    memcpy(text, digits, (size_t)whole);
    memset(text + whole, '0', (size_t)(place + 1 - whole));
    text += place + 1;
    if (whole < count) {
        *text = '.';
        memcpy(text + 1, digits + whole, (size_t)(count - whole));
        text += 1 + count - whole;
    }
    return text;
}

// Digits d1 d2 ... dn as d1.d2...e+place. Returns the end.
static char *write_with_exponent(char *text, const char *digits, int count, int place)
{
    const unsigned size = (unsigned)abs(place);
    text = write_positional(text, digits, count, 0);
    *text++ = 'e';
    *text++ = place < 0 ? '-' : '+';
    if (size < 10) {
        *text++ = '0'; // two digits at least
    }
    return text + write_whole(text, size);
}

// Writes with the fewest digits that read back as the same number. Plainly where the
// power of ten of the first digit is at least -4 and below the number of digits or
// most_plain, whichever is larger; else with an exponent.
static void write_digits(char *text, double value, int most_plain)
{
    if (isnan(value)) {
        strcpy(text, "nan");
        return;
    }
    if (isinf(value)) {
        strcpy(text, value > 0 ? "inf" : "-inf");
        return;
    }

    if (signbit(value)) {
        *text++ = '-';
    }
    if (value == 0) {
        memcpy(text, "0", 2);
        return;
    }

    char digits[20];
    const decimal d = shortest_decimal(fabs(value));
    const int count = write_whole(digits, d.digits), place = count - 1 + d.exponent;
    const int longest = count > most_plain ? count : most_plain;

    char *end;
    if (place >= -4 && place < longest) {
        end = write_positional(text, digits, count, place);
    } else {
        end = write_with_exponent(text, digits, count, place);
    }
    *end = '\0';
}

void number_format(char *text, double value)
{
    if (value == 0) {
        value = 0; // the sign of a zero says nothing to a reader
    }
    write_digits(text, value, 15);
}

void number_format_short(char *text, double value)
{
    write_digits(text, value, 6);
}

// A decimal number and the blanks behind it, in any locale.
bool decimal_read(const char *text, double *value, const char **rest)
{
    // what strtod would take beyond a decimal number
    const char *digits = text;
    if (*digits == '+' || *digits == '-') {
        digits++;
    }
    bool begins = isdigit((unsigned char)digits[0]) ||
                  (digits[0] == '.' && isdigit((unsigned char)digits[1]));
    if (!begins || (digits[0] == '0' && tolower((unsigned char)digits[1]) == 'x')) {
        return false;
    }

    char *end;
    *value = decimal_parse(text, &end);
    while (is_blank(*end)) {
        end++;
    }
    *rest = end;
    return true;
}

// Ascending, NaN behind all numbers.
int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    if (x < y || (isnan(y) && !isnan(x))) {
        return -1;
    }
    if (x > y || (isnan(x) && !isnan(y))) {
        return 1;
    }
    return 0;
}

// Random numbers that are the same on every machine: the generator xoshiro256** of
// Blackman and Vigna (Scrambled linear pseudorandom number generators, ACM Trans. Math.
// Softw. 47, 2021), its state filled by splitmix64 (Steele, Lea and Flood, OOPSLA 2014)
// from a seed.
#pragma once

#include <stddef.h>
#include <stdint.h>

typedef struct random_generator {
    uint64_t state[4]; // never all zero
} random_generator;

// The next number of the splitmix64 sequence that starts at *state; advances *state.
uint64_t splitmix64_next(uint64_t *state);

// Starts a generator. Equal seeds give equal sequences; every seed is good.
void random_seed(random_generator *g, uint64_t seed);

// 64 random bits.
static inline uint64_t random_bits(random_generator *g)
{
    uint64_t *s = g->state;
    const uint64_t times5 = s[1] * 5, result = (times5 << 7 | times5 >> 57) * 9;

    // the linear step: x <- x M over the field of two elements
    uint64_t shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = s[3] << 45 | s[3] >> 19;
    return result;
}

// 64 random bits as a number evenly distributed over [0, 1), a multiple of 2^-53.
static inline double random_share(uint64_t bits)
{
    return (double)(bits >> 11) * 0x1p-53;
}
static inline double random_uniform(random_generator *g)
{
    return random_share(random_bits(g));
}

// A number of about the standard normal distribution: the sum of 12 even ones less 6.
static inline double random_about_normal(random_generator *g)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        sum += random_uniform(g);
    }
    return sum;
}

// A whole number evenly distributed over 0 ... bound - 1; bound > 0.
uint64_t random_below(random_generator *g, uint64_t bound);

// Fills order[0 ... count - 1] with the numbers 0 ... count - 1 in random order, every
// order equally likely (Fisher and Yates).
void random_permutation(random_generator *g, size_t *order, size_t count);

// --- by number, without those before ---------------------------------------------------

// Number i, from 0, of the splitmix64 sequence of a key.
uint64_t random_at(uint64_t key, uint64_t i);

// The place of number i < count <= 2^53 in the random order of 0 ... count - 1 that a key
// gives: a generalised Feistel network with cycle walking (Black and Rogaway, Ciphers
// with arbitrary finite domains, CT-RSA 2002).
uint64_t random_place(uint64_t key, uint64_t i, uint64_t count);

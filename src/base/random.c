#include "src/base/random.h"

#include <assert.h>
#include <math.h>

// The step of splitmix64's counter: odd, near 2^64 divided by the golden ratio.
#define GOLDEN UINT64_C(0x9e3779b97f4a7c15)

uint64_t splitmix64_next(uint64_t *state)
{
    // the counter, then a mixing of its bits
    *state += GOLDEN;
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

void random_seed(random_generator *g, uint64_t seed)
{
    for (int i = 0; i < 4; i++) {
        g->state[i] = splitmix64_next(&seed);
    }
}

// A number of 0 to bound - 1, each as likely.
uint64_t random_below(random_generator *g, uint64_t bound)
{
    assert(bound > 0);

    // the first 2^64 mod bound numbers would make small remainders more likely
    uint64_t uneven = (UINT64_MAX - bound + 1) % bound, bits;
    do {
        bits = random_bits(g);
    } while (bits < uneven);
    return bits % bound;
}

// The numbers 0 to count - 1 in a random order (Fisher and Yates, inside out).
void random_permutation(random_generator *g, size_t *order, size_t count)
{
    assert(order != NULL || count == 0);

    // each number goes to a random place, and the one that stood there to the end
    for (size_t i = 0; i < count; i++) {
        size_t j = (size_t)random_below(g, i + 1);
        order[i] = i;
        order[i] = order[j];
        order[j] = i;
    }
}

uint64_t random_at(uint64_t key, uint64_t i)
{
    uint64_t state = key + i * GOLDEN;
    return splitmix64_next(&state);
}

uint64_t random_place(uint64_t key, uint64_t i, uint64_t count)
{
    enum { ROUNDS = 12 };
    assert(i < count && count <= UINT64_C(1) << 53);

    // the numbers fill a rectangle row by row; the last row may have places to spare
    const uint64_t columns = (uint64_t)ceil(sqrt((double)count));
    const uint64_t rows = (count + columns - 1) / columns;

    // a round turns each row, or each column, by a random amount of its own; whoever
    // comes to a place to spare walks on
    do {
        uint64_t column = i % columns, row = i / columns;
        for (uint64_t k = 0; k < ROUNDS; k += 2) {
            column = (column + random_at(key, ROUNDS * row + k) % columns) % columns;
            row = (row + random_at(key, ROUNDS * column + k + 1) % rows) % rows;
        }
        i = columns * row + column;
    } while (i >= count);
    return i;
}

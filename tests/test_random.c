
#include "tests/check.h"

TEST(xoshiro_gives_its_published_sequence)
{
    static const uint64_t expected[] = {UINT64_C(11520), UINT64_C(0),
                                        UINT64_C(1509978240),
                                        UINT64_C(1215971899390074240)};
    random_generator g = {{1, 2, 3, 4}};
    for (int i = 0; i < 4; i++) {
        assert_true(random_bits(&g) == expected[i]);
    }
}

TEST(splitmix_gives_its_published_sequence)
{
    // of the seed 1234567, as other implementations list it
    static const uint64_t expected[] = {UINT64_C(6457827717110365317),
                                        UINT64_C(3203168211198807973),
                                        UINT64_C(9817491932198370423),
                                        UINT64_C(4593380528125082431)};
    uint64_t counter = 1234567;
    for (int i = 0; i < 4; i++) {
        assert_true(splitmix64_next(&counter) == expected[i]);
    }
}

TEST(equal_seeds_give_equal_sequences)
{
    random_generator a, b, c;
    random_seed(&a, 7);
    random_seed(&b, 7);
    random_seed(&c, 8);
    int same = 0;
    for (int i = 0; i < 100; i++) {
        uint64_t bits = random_bits(&a);
        assert_true(bits == random_bits(&b));
        same += bits == random_bits(&c);
    }
    assert_int_equal(same, 0);
}

// Which of the 2^64 numbers are drawn again: 2^64 mod bound of them, the smallest.
TEST(numbers_that_would_be_uneven_are_drawn_again)
{
    const struct {
        uint64_t bound, again; // 2^64 mod bound
    } cases[] = {{3, 1},
                 {10, 6},
                 {UINT64_C(1) << 32, 0},
                 {(UINT64_C(1) << 63) + 1, INT64_MAX}};
    for (EACH(c, cases)) {
        for (uint64_t bits = c->again - (c->again > 0); bits <= c->again; bits++) {
            // a state whose next number is `bits`: nine, the turn by 7 and five undone
            const uint64_t ninth = bits * UINT64_C(0x8e38e38e38e38e39);
            const uint64_t turned = ninth >> 7 | ninth << 57;
            random_generator g = {{1, turned * UINT64_C(0xcccccccccccccccd), 2, 3}},
                             next = g;
            assert_true(random_bits(&next) == bits);
            const uint64_t drawn = random_below(&g, c->bound);

            // taken, it is the only one
            const bool taken = memcmp(&g, &next, sizeof g) == 0;
            assert_int_equal(taken, bits >= c->again);
            assert_true(!taken || drawn == bits % c->bound);
        }
    }
}

TEST(uniform_numbers_fill_the_unit_interval_evenly)
{
    enum { DRAWN = 100000, BINS = 20 };
    int bins[BINS] = {0};
    double sum = 0, squares = 0;
    random_generator g = seeded(1);
    for (int i = 0; i < DRAWN; i++) {
        double u = random_uniform(&g);
        assert_true(u >= 0 && u < 1);
        bins[(int)(u * BINS)]++;
        sum += u;
        squares += u * u;
    }
    // five standard deviations of each
    check_close(sum / DRAWN, 0.5, 5 * 0.2887 / sqrt(DRAWN));
    check_close(squares / DRAWN, 1 / 3.0, 5 * 0.2981 / sqrt(DRAWN));
    for (int i = 0; i < BINS; i++) {
        check_close(bins[i], DRAWN / BINS, 5 * sqrt(DRAWN * 0.05 * 0.95));
    }
}

TEST(whole_numbers_are_equally_likely_up_to_the_bound)
{
    int counts[6] = {0};
    random_generator g = seeded(2);
    for (int i = 0; i < 60000; i++) {
        uint64_t n = random_below(&g, 6);
        assert_true(n < 6);
        counts[n]++;
    }
    for (int i = 0; i < 6; i++) {
        check_close(counts[i], 10000, 5 * sqrt(60000 * 5.0 / 36));
    }
    assert_true(random_below(&g, 1) == 0);
    // a bound above half of the range, where plain remainders would favour small numbers
    // two to one
    uint64_t bound = UINT64_C(3) << 62;
    int low = 0;
    for (int i = 0; i < 10000; i++) {
        low += random_below(&g, bound) < bound / 3;
    }
    check_close(low, 10000 / 3.0, 5 * sqrt(10000 * 2.0 / 9));
}

TEST(a_permutation_has_every_number_once)
{
    enum { COUNT = 1000 };
    size_t order[COUNT];
    unsigned char seen[COUNT] = {0};
    random_generator g = seeded(3);
    random_permutation(&g, order, COUNT);
    int unmoved = 0;
    for (size_t i = 0; i < COUNT; i++) {
        assert_true(order[i] < COUNT);
        assert_false(seen[order[i]]);
        seen[order[i]] = 1;
        unmoved += order[i] == i;
    }
    // one is expected
    assert_true(unmoved < 10);
}

TEST(all_permutations_are_equally_likely)
{
    int counts[3][3] = {{0}};
    random_generator g = seeded(4);
    for (int i = 0; i < 9000; i++) {
        size_t order[3];
        random_permutation(&g, order, 3);
        for (int k = 0; k < 3; k++) {
            counts[k][order[k]]++;
        }
    }
    for (int i = 0; i < 9; i++) {
        check_close(counts[i / 3][i % 3], 3000, 5 * sqrt(9000 * 2.0 / 9));
    }
}

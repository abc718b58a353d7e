
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

TEST(numbers_of_a_sequence_are_found_by_their_place)
{
    uint64_t counter = 1234567;
    for (uint64_t i = 0; i < 4; i++) {
        assert_true(random_at(1234567, i) == splitmix64_next(&counter));
    }
}

// Of as many as there may be, too: a place has one number, whichever were asked before.
TEST(an_order_by_number_has_every_place_once)
{
    enum { MOST = 400 };
    for (uint64_t count = 1; count <= MOST; count++) {
        bool taken[MOST] = {false};
        for (uint64_t i = 0; i < count; i++) {
            const uint64_t place = random_place(count, i, count);
            assert_true(place < count);
            assert_false(taken[place]);
            taken[place] = true;
        }
    }
    const uint64_t most = UINT64_C(1) << 53;
    for (uint64_t i = most - 1000; i < most; i++) {
        assert_true(random_place(7, i, most) < most);
    }
}

// Orders of three and of four numbers, whose frequencies a chi-square of 5 and of 23
// degrees of freedom judges: above 25.7 and 56.0 once in 1e4 times.
TEST(all_orders_by_number_are_equally_likely)
{
    enum { ORDERS = 24000 };
    for (uint64_t count = 3; count <= 4; count++) {
        int met[256] = {0};
        for (uint64_t key = 0; key < ORDERS; key++) {
            uint64_t order = 0;
            for (uint64_t i = 0; i < count; i++) {
                order = order << 2 | random_place(key, i, count);
            }
            met[order]++;
        }

        const double expected = count == 3 ? ORDERS / 6.0 : ORDERS / 24.0;
        double chi_square = 0;
        int different = 0;
        for (int i = 0; i < 256; i++) {
            different += met[i] > 0;
            if (met[i] > 0) {
                chi_square += (met[i] - expected) * (met[i] - expected) / expected;
            }
        }
        assert_int_equal(different, count == 3 ? 6 : 24);
        check_below(chi_square, count == 3 ? 25.7 : 56.0);
    }
}

// The place says nothing about the number, nor about the place of the next one: counts
// of pairs by tenths of both, of 81 degrees of freedom, above 138 once in 1e4 times.
TEST(places_of_a_large_order_are_independent)
{
    enum { COUNT = 100000 };
    int with_number[10][10] = {{0}}, with_next[10][10] = {{0}};
    uint64_t before = 0;
    for (uint64_t i = 0; i < COUNT; i++) {
        const uint64_t place = random_place(11, i, COUNT);
        with_number[i * 10 / COUNT][place * 10 / COUNT]++;
        with_next[before * 10 / COUNT][place * 10 / COUNT]++;
        before = place;
    }
    double of_number = 0, of_next = 0;
    const double expected = COUNT / 100.0;
    for (int i = 0; i < 100; i++) {
        const double a = with_number[i / 10][i % 10] - expected,
                     b = with_next[i / 10][i % 10] - expected;
        of_number += a * a / expected;
        of_next += b * b / expected;
    }
    check_below(of_number, 138);
    check_below(of_next, 138);
}

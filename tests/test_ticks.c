// Ticks: a published example, properties that must hold for any axis, and labels.
#include "tests/check.h"

#include "render/plot/ticks.h"

static void expect_ticks(const ticks *t, int count, const double *expected)
{
    assert_int_equal(t->count, count);
    for (int i = 0; i < count; i++) {
        check_close(t->value[i], expected[i], 0);
    }
}

static void expect_labels(const ticks *t, int count, const char *const *expected)
{
    char label[TICK_TEXT];
    assert_int_equal(t->count, count);
    for (int i = 0; i < count; i++) {
        tick_label(t, i, label);
        assert_string_equal(label, expected[i]);
    }
}

// 8, 10, 12, 14 are the ticks of extended(8.1, 14.1, 4) of the R package labeling; on an axis that
// ends at the outermost of them none is left out
TEST(published_example)
{
    ticks t;
    ticks_between(&t, 8, 14, 4);
    expect_ticks(&t, 4, (double[]){8, 10, 12, 14});
    check_close(t.step, 2, 0);
    ticks_between(&t, 14, 8, 4);
    expect_ticks(&t, 4, (double[]){8, 10, 12, 14});
}

TEST(round_ranges)
{
    ticks t;
    ticks_between(&t, 0, 1, 6);
    expect_ticks(&t, 6, (double[]){0, 0.2, 0.4, 0.6, 0.8, 1});
    ticks_between(&t, -100, 100, 5);
    expect_ticks(&t, 5, (double[]){-100, -50, 0, 50, 100});
}

// 0.04, 0.06 and never 0.045, 0.055: a reader looks for whole multiples of the step
TEST(ticks_are_multiples_of_their_step)
{
    for (double low = 0.031; low < 0.06; low += 0.0013) {
        for (int wanted = 2; wanted < 9; wanted++) {
            ticks t;
            ticks_between(&t, low, low + 0.0431, wanted);
            for (int i = 0; i < t.count && t.step > 0; i++) {
                double share = t.value[i] / t.step;
                check_close(share, round(share), 1e-9);
            }
        }
    }
}

// every tick is the double nearest to its decimal number, so that printing shows no noise
TEST(values_are_decimal)
{
    for (int power = -12; power <= 12; power++) {
        ticks t;
        double scale = pow(10, power);
        ticks_between(&t, -0.31 * scale, 0.94 * scale, 6);
        assert_true(t.count >= 3);
        for (int i = 0; i < t.count; i++) {
            char text[64];
            snprintf(text, sizeof text, "%.10g", t.value[i]);
            check_close(t.value[i], strtod(text, NULL), 0);
            assert_false(signbit(t.value[i]) && t.value[i] == 0);
        }
    }
}

// a cheap source of numbers that is the same everywhere
static double next_random(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

TEST(between_stays_inside_and_misses_none)
{
    unsigned long long seed = 7;
    for (int trial = 0; trial < 3000; trial++) {
        ticks t;
        double centre = (next_random(&seed) - 0.5) * pow(10, 6 * next_random(&seed) - 3);
        double width = pow(10, 8 * next_random(&seed) - 4);
        double low = centre - width * next_random(&seed), high = low + width;
        int wanted = 2 + (int)(8 * next_random(&seed));
        ticks_between(&t, low, high, wanted);
        assert_true(t.count >= 2);
        assert_true(t.count <= 2 * wanted + 1);
        assert_true(t.value[0] >= low - 1e-8 * width);
        assert_true(t.value[t.count - 1] <= high + 1e-8 * width);
        assert_true(t.value[0] - t.step < low + 1e-8 * width);
        assert_true(t.value[t.count - 1] + t.step > high - 1e-8 * width);
        for (int i = 1; i < t.count; i++) {
            check_close(t.value[i] - t.value[i - 1], t.step, 1e-9 * fmax(fabs(centre), width));
        }
    }
}

TEST(about_as_many_as_wanted)
{
    unsigned long long seed = 11;
    for (int wanted = 3; wanted <= 10; wanted++) {
        double total = 0;
        for (int trial = 0; trial < 300; trial++) {
            ticks t;
            double low = 100 * next_random(&seed) - 50;
            ticks_between(&t, low, low + 1 + 100 * next_random(&seed), wanted);
            total += t.count;
        }
        check_close(total / 300, wanted, 0.35 * wanted);
    }
}

TEST(labels_are_short_and_have_a_true_minus)
{
    ticks t;
    ticks_between(&t, -1.2, 1.2, 5);
    expect_labels(&t, 5, (const char *[]){"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"});
    ticks_between(&t, 8, 14, 4);
    expect_labels(&t, 4, (const char *[]){"8", "10", "12", "14"});
}

TEST(small_and_large_numbers_get_a_factor)
{
    ticks t;
    char factor[64];
    ticks_between(&t, 0, 4e-6, 5);
    tick_factor(&t, factor, sizeof factor);
    assert_string_equal(factor, "\u00d710<sup>\u22126</sup>");
    expect_labels(&t, 5, (const char *[]){"0", "1", "2", "3", "4"});
    ticks_between(&t, 0, 2e6, 3);
    tick_factor(&t, factor, sizeof factor);
    assert_string_equal(factor, "\u00d710<sup>6</sup>");
    ticks_between(&t, 0, 1, 5);
    tick_factor(&t, factor, sizeof factor);
    assert_string_equal(factor, "");
}

TEST(narrow_range_far_from_zero)
{
    ticks t;
    char first[TICK_TEXT], second[TICK_TEXT];
    ticks_between(&t, 0.293412, 0.293462, 4);
    assert_true(t.count >= 2);
    tick_label(&t, 0, first);
    tick_label(&t, 1, second);
    assert_string_not_equal(first, second);
    check_close(strtod(first, NULL), t.value[0], 1e-12);
}

TEST(hopeless_limits)
{
    ticks t;
    for (EACH_OF(double, c, (double)NAN, (double)INFINITY, -(double)INFINITY)) {
        ticks_between(&t, 0, *c, 5);
        assert_int_equal(t.count, 0);
        ticks_between(&t, *c, 0, 5);
        assert_int_equal(t.count, 0);
    }
    ticks_between(&t, 3, 3, 5);
    assert_true(t.count >= 2);
    ticks_between(&t, 0, 0, 5);
    assert_true(t.count >= 2);
    ticks_between(&t, -1e308, 1e308, 5);
    assert_int_equal(t.count, 0);
    ticks_between(&t, 0, 1, -5);
    assert_true(t.count >= 2);
}

TEST(minor_ticks_are_round)
{
    unsigned long long seed = 3;
    for (int trial = 0; trial < 300; trial++) {
        ticks t;
        ticks_between(&t, 0, pow(10, 4 * next_random(&seed)), 5);
        // a minor step has one digit, or is 25, or is no minor step at all
        double part = t.step / t.minor, digits = part / pow(10, floor(log10(part * (1 + 1e-12))));
        bool round_number = fabs(digits - round(digits)) < 1e-9 || fabs(digits - 2.5) < 1e-9;
        assert_true(round_number || t.minor == 1);
    }
}

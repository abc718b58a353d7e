// Numbers as text: short, exact, and nothing read that people would not write.
#include "src/base/numbers.h"

#include <stdlib.h>
#include <string.h>

#include "tests/check.h"

static void numbers_are_short_and_read_back(void **state)
{
    (void)state;
    const struct {
        double value;
        const char *text;
    } cases[] = {
        {0.1, "0.1"},  {12, "12"}, {-0.0, "0"}, {1e-5, "1e-05"}, {0.1 + 0.2, "0.30000000000000004"},
        {-2.5, "-2.5"}};
    char text[NUMBER_TEXT];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        number_format(text, cases[i].value);
        assert_string_equal(text, cases[i].text);
    }
    // numbers of every size survive being written and read
    unsigned long long bits = 0x9E3779B97F4A7C15ULL;
    for (int i = 0; i < 10000; i++) {
        double value;
        bits = bits * 6364136223846793005ULL + 1442695040888963407ULL;
        memcpy(&value, &bits, sizeof value);
        if (isfinite(value)) {
            number_format(text, value);
            assert_true(strtod(text, NULL) == value);
        }
    }
}

static void short_numbers_have_exponents_from_a_million(void **state)
{
    (void)state;
    const struct {
        double value;
        const char *text;
    } cases[] = {{1e6, "1e+06"}, {999999, "999999"}, {2147483647, "2147483647"},
                 {-0.0, "-0"},   {0.1, "0.1"},       {169468.0882, "169468.0882"}};
    char text[NUMBER_TEXT];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        number_format_short(text, cases[i].value);
        assert_string_equal(text, cases[i].text);
        assert_true(strtod(text, NULL) == cases[i].value);
    }
}

static void what_is_not_finite_has_a_word(void **state)
{
    (void)state;
    char text[NUMBER_TEXT];
    number_format(text, -(double)NAN);
    assert_string_equal(text, "nan");
    number_format_short(text, -(double)INFINITY);
    assert_string_equal(text, "-inf");
}

static void decimals_are_read_with_what_follows(void **state)
{
    (void)state;
    const struct {
        const char *text;
        double value;
        const char *rest;
    } cases[] = {{"0.4 s", 0.4, "s"}, {"-1e-3", -1e-3, ""}, {"+.5N", 0.5, "N"}, {"12 ", 12, ""}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double value;
        const char *rest;
        assert_true(decimal_read(cases[i].text, &value, &rest));
        check_close(value, cases[i].value, 0);
        assert_string_equal(rest, cases[i].rest);
    }
}

static void what_is_no_decimal_is_refused(void **state)
{
    (void)state;
    const char *const texts[] = {"", "x", "0x10", "inf", "nan", "-.", " 1", "+-1", "e5"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        double value;
        const char *rest;
        assert_false(decimal_read(texts[i], &value, &rest));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_short_and_read_back),
        cmocka_unit_test(short_numbers_have_exponents_from_a_million),
        cmocka_unit_test(what_is_not_finite_has_a_word),
        cmocka_unit_test(decimals_are_read_with_what_follows),
        cmocka_unit_test(what_is_no_decimal_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

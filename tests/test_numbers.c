// Numbers as text: short, exact, and read only in the usual notations.
#include "src/base/numbers.h"

#include "tests/check.h"

TEST(short_numbers_have_exponents_from_a_million)
{
    const struct {
        double value;
        const char *text;
    } cases[] = {{1e6, "1e+06"}, {999999, "999999"}, {2147483647, "2147483647"},
                 {-0.0, "-0"},   {0.1, "0.1"},       {169468.0882, "169468.0882"}};
    char text[NUMBER_TEXT];
    for (EACH(c, cases)) {
        number_format_short(text, c->value);
        assert_string_equal(text, c->text);
        assert_true(strtod(text, NULL) == c->value);
    }
}

TEST(what_is_not_finite_has_a_word)
{
    char text[NUMBER_TEXT];
    number_format(text, -(double)NAN);
    assert_string_equal(text, "nan");
    number_format_short(text, -(double)INFINITY);
    assert_string_equal(text, "-inf");
}

TEST(decimals_are_read_with_what_follows)
{
    const struct {
        const char *text;
        double value;
        const char *rest;
    } cases[] = {{"0.4 s", 0.4, "s"},
                 {"-1e-3", -1e-3, ""},
                 {"+.5N", 0.5, "N"},
                 {"12 ", 12, ""},
                 {"-1.5e2  N", -150, "N"}};
    for (EACH(c, cases)) {
        double value;
        const char *rest;
        assert_true(decimal_read(c->text, &value, &rest));
        check_close(value, c->value, 0);
        assert_string_equal(rest, c->rest);
    }
}

TEST(what_is_no_decimal_is_refused)
{
    for (EACH_TEXT(c, "", "x", "-", ".", "0x10", "inf", ".inf", "nan", "-.", " 1", "+-1",
                   "e5")) {
        double value;
        const char *rest;
        assert_false(decimal_read(*c, &value, &rest));
    }
}

// Numbers of all sizes, also powers of two, for which the next number below is nearer
// than that above.
static double some_number(random_generator *g, int i)
{
    double value;
    const uint64_t bits = random_bits(g) & INT64_MAX;
    memcpy(&value, &bits, sizeof value);
    return i % 3 == 0   ? random_uniform(g)
           : i % 3 == 1 ? ldexp(1, (int)(bits % 2098) - 1074)
                        : value;
}

// What is written reads back to the last bit, and no number of one digit less does; of
// those with as many digits it is the nearest.
TEST(digits_are_as_few_as_read_back)
{
    random_generator g = seeded(20261122);
    for (int i = 0; i < 200000; i++) {
        const double value = some_number(&g, i);
        if (!isfinite(value) || value == 0) {
            continue;
        }
        char text[NUMBER_TEXT], nearest[NUMBER_TEXT];
        number_format(text, value);
        assert_true(strtod(text, NULL) == value);

        int digits = 0;
        for (const char *c = text; *c != '\0' && *c != 'e'; c++) {
            digits += *c >= '0' && *c <= '9' && (digits > 0 || *c != '0');
        }
        if (digits > 1 && digits <= 17 && strchr(text, 'e') != NULL) {
            assert_true(strtod(formatted("%.*e", digits - 2, value), NULL) != value);
        }
        if (digits > 0 && digits <= 17 && strchr(text, 'e') != NULL) {
            snprintf(nearest, sizeof nearest, "%.*e", digits - 1, value);
            assert_true(strtod(nearest, NULL) != value || strcmp(nearest, text) == 0);
        }
    }
}

TEST(digits_of_known_numbers)
{
    const struct {
        double value;
        const char *text;
    } known[] = {
        {0.1, "0.1"},
        {12, "12"},
        {-0.0, "0"},
        {1e-5, "1e-05"},
        {-2.5, "-2.5"},
        {5e-324, "5e-324"},
        {2.2250738585072014e-308, "2.2250738585072014e-308"},
        {1.7976931348623157e308, "1.7976931348623157e+308"},
        {0x1p-44, "5.684341886080802e-14"}, // printf needs 17 digits
        {9007199254740993.0, "9007199254740992"},
        {1e15, "1e+15"},
        {123456789012345.0, "123456789012345"},
        {1e23, "1e+23"},
        {-0.0001, "-0.0001"},
        {0.00001234, "1.234e-05"},
        {100.5, "100.5"},
        {0.1 + 0.2, "0.30000000000000004"},
    };
    for (EACH(c, known)) {
        char text[NUMBER_TEXT];
        number_format(text, c->value);
        assert_string_equal(text, c->text);
    }
}

// Numbers of so many digits times a power of ten, written out by hand.
TEST(digits_and_points_stand_where_they_belong)
{
    random_generator g = seeded(12);
    for (int trial = 0; trial < 40000; trial++) {
        char digits[24], source[64], expected[64], text[NUMBER_TEXT];
        const int count = 1 + (int)random_below(&g, 15),
                  place = (int)random_below(&g, 44) - 22;
        digits[0] = (char)('1' + random_below(&g, 9));
        for (int i = 1; i < count; i++) {
            digits[i] = (char)('0' + random_below(&g, 10));
        }
        digits[count - 1] =
            count > 1 && digits[count - 1] == '0' ? '7' : digits[count - 1];
        digits[count] = '\0';
        snprintf(source, sizeof source, "%c.%se%d", digits[0], digits + 1, place);
        const double value = strtod(source, NULL) * (trial % 2 ? -1 : 1);

        // without an exponent from 1e-4 to as many digits as there are, or at least 15 or
        // 6
        for (int brief = 0; brief < 2; brief++) {
            const int least = brief ? 6 : 15, most = count > least ? count : least;
            char *to = expected;
            to += sprintf(to, "%s", trial % 2 ? "-" : "");
            if (place < -4 || place >= most) {
                sprintf(to, "%c%s%se%c%02d", digits[0], count > 1 ? "." : "", digits + 1,
                        place < 0 ? '-' : '+', abs(place));
            } else if (place < 0) {
                sprintf(to, "0.%.*s%s", -place - 1, "0000", digits);
            } else {
                for (int i = 0; i <= place || i < count; i++) {
                    to += sprintf(to, "%s%c", i == place + 1 ? "." : "",
                                  i < count ? digits[i] : '0');
                }
            }
            (brief ? number_format_short : number_format)(text, value);
            assert_string_equal(text, expected);
        }
    }
}

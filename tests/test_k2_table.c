// The table of stiffness by force: reading, interpolation and refusals.
#include "src/tables/k2_table.h"

#include "tests/check.h"

static k2_table table_of(const char *text)
{
    k2_table t;
    fault f = {.text = ""};
    fail_if(k2_table_read(&t, text, &f) != STATUS_OK, "refused: %s", f.text);
    return t;
}

TEST(between_entries_lie_straight_lines)
{
    const k2_table t = table_of("0.5:4.8 1:5 4:0.5");
    assert_int_equal(t.count, 3);
    check_close(k2_table_at(&t, 0.5), 4.8, 0);
    check_close(k2_table_at(&t, 0.75), 4.9, 1e-15);
    check_close(k2_table_at(&t, 1), 5, 0);
    check_close(k2_table_at(&t, 2.5), 2.75, 1e-15);
    check_close(k2_table_at(&t, 4), 0.5, 0);

    // an entry's own force gives its own stiffness, to the last bit
    const k2_table exact = table_of("0:4.9 1:0.1 2:3");
    check_close(k2_table_at(&exact, 0), 4.9, 0);
    check_close(k2_table_at(&exact, 1), 0.1, 0);
}

TEST(beyond_the_ends_stay_the_last_values)
{
    const k2_table t = table_of("0.5:4.8 4:0.5"), one = table_of("2:3");
    check_close(k2_table_at(&t, 0), 4.8, 0);
    check_close(k2_table_at(&t, 1e9), 0.5, 0);
    check_close(k2_table_at(&one, 0), 3, 0);
    check_close(k2_table_at(&one, 5), 3, 0);
}

TEST(it_is_written_as_it_was_read)
{
    char text[64], small[8];
    const k2_table t = table_of("  0.5:4.8   1:5 "), none = table_of("");
    assert_true(k2_table_write(&t, text, sizeof text));
    assert_string_equal(text, "0.5:4.8 1:5");
    assert_false(k2_table_write(&t, small, sizeof small));
    assert_int_equal(none.count, 0);
    assert_true(k2_table_write(&none, text, sizeof text));
    assert_string_equal(text, "");

    // with room for all of it and its end, and for less
    for (size_t size = 1; size <= sizeof "0.5:4.8 1:5"; size++) {
        assert_int_equal(k2_table_write(&t, text, size), size == sizeof "0.5:4.8 1:5");
    }
    assert_string_equal(text, "0.5:4.8 1:5");
}

TEST(what_is_no_table_is_refused)
{
    for (EACH_TEXT(c, "1", "1:", ":5", "1:0", "1:-2", "-1:5", "2:5 1:5", "1:5 1:6",
                   "1:5,2:6", "a:b", "1:nan", "1:5 0:6", "1:5 x", "inf:5")) {
        k2_table t;
        fault f = {.text = ""};
        fail_if(k2_table_read(&t, *c, &f) == STATUS_OK, "'%s' is taken for a table", *c);
        assert_string_equal(f.path, "control.k2_table");
    }

    // one entry too many
    char *text = formatted("%s", "");
    for (int i = 0; i <= K2_TABLE_MOST; i++) {
        text = formatted("%s%d:5 ", text, i + 1);
    }
    k2_table t;
    fault f = {.text = ""};
    assert_int_equal(k2_table_read(&t, text, &f), STATUS_BAD_SCENARIO);
    text[strlen(text) - strlen("33:5 ")] = '\0';
    assert_int_equal(k2_table_read(&t, text, &f), STATUS_OK);
}

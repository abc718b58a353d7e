// The table of recorded signals: one order for rows and table, so that a field gives its
// index.
#include "src/tables/signals.h"

#include "tests/check.h"

TEST(every_name_is_unique_and_found)
{
    for (int i = 0; i < signal_count; i++) {
        assert_int_equal(signal_find(signal_table[i].name), i);
        assert_int_equal(signal_index(signal_table[i].name), i);
    }
    assert_int_equal(signal_find("contact_force"), -1);
    assert_int_equal(signal_find(""), -1);
}

TEST(rows_and_table_have_one_order)
{
    double numbers[SIGNALS_AT_MOST];
    sample row;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        numbers[i] = 10 + i;
    }
    memcpy(&row, numbers, sizeof row);
    for (int i = 0; i < signal_count; i++) {
        check_close(signal_value(&row, i), 10 + i, 0);
    }
    check_close(signal_value(&row, SIGNAL_INDEX(force)), row.force, 0);
    assert_int_equal(SIGNAL_INDEX(force), signal_find("force"));
    assert_int_equal(SIGNAL_INDEX(gap_velocity), signal_find("gap_velocity"));
}

TEST(every_signal_is_described)
{
    for (int i = 0; i < signal_count; i++) {
        assert_true(signal_table[i].symbol[0] != '\0' &&
                    signal_table[i].ascii[0] != '\0');
        assert_true(signal_table[i].description[0] != '\0');
        for (const char *c = signal_table[i].ascii; *c != '\0'; c++) {
            assert_true((unsigned char)*c < 0x80);
        }
    }
}

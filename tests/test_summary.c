// The table of a run's results: its keys end in their units, and every number is found.
#include "src/tables/summary.h"

#include "tests/check.h"

TEST(every_key_is_unique_and_found)
{
    for (int i = 0; i < summary_count; i++) {
        assert_int_equal(summary_find(summary_table[i].key), i);
        assert_int_equal(summary_index(summary_table[i].key), i);
    }
    assert_int_equal(summary_find("peak_force"), -1);
    assert_int_equal(summary_find(""), -1);
    assert_string_equal(summary_suggest("peak_forse_N"), "peak_force_N");
    assert_null(summary_suggest("xyzzy"));
}

// "contact_impulse_Ns" is "contact_impulse" in "N s", "return_speed_m_s" one in "m/s".
TEST(keys_are_names_with_units)
{
    for (int i = 0; i < summary_count; i++) {
        const summary_info *info = &summary_table[i];
        char key[64], label[64], unit[16] = "";
        size_t length = 0;
        for (const char *c = info->unit; *c != '\0'; c++) {
            if (*c != ' ') {
                unit[length++] = *c == '/' ? '_' : *c;
            }
        }
        snprintf(key, sizeof key, "%s%s%s", info->name, unit[0] != '\0' ? "_" : "",
                 strcmp(unit, "%") == 0 ? "percent" : unit);
        assert_string_equal(info->key, key);
        snprintf(label, sizeof label, "%s", info->name);
        for (char *c = label; *c != '\0'; c++) {
            *c = *c == '_' ? ' ' : *c;
        }
        assert_string_equal(info->label, label);
        assert_true(info->description[0] != '\0');
    }
}

TEST(indices_lead_to_their_numbers)
{
    summary s;
    summary_init(&s);
    s.first_contact_s = 1;
    s.peak_force_N = 2;
    s.wall_time_s = 3;
    check_close(summary_value(&s, SUMMARY_INDEX(first_contact_s)), 1, 0);
    check_close(summary_value(&s, summary_index("peak_force_N")), 2, 0);
    check_close(summary_value(&s, SUMMARY_INDEX(wall_time_s)), 3, 0);
    assert_int_equal(SUMMARY_INDEX(wall_time_s), summary_count - 1);
}

// Every number has its own place, from the first to the last.
TEST(every_index_leads_to_another_number)
{
    summary s;
    summary_init(&s);
    double *first = &s.first_contact_s;
    assert_ptr_equal(first + summary_count - 1, &s.wall_time_s);
    for (int i = 0; i < summary_count; i++) {
        memcpy((char *)first + (size_t)i * sizeof(double), &(double){i + 0.5},
               sizeof(double));
    }
    for (int i = 0; i < summary_count; i++) {
        check_close(summary_value(&s, i), i + 0.5, 0);
    }

    // how it ended, in a word and as a fault
    fault f = {0};
    assert_string_equal(summary_status(&s), "ok");
    s.inaccurate = true;
    assert_string_equal(summary_status(&s), "inaccurate");
    s.status = STATUS_NOT_FINITE;
    s.path = "arm.k2";
    snprintf(s.message, sizeof s.message, "it broke");
    assert_string_equal(summary_status(&s), "failed");
    assert_int_equal(summary_fault(&s, &f), STATUS_NOT_FINITE);
    assert_string_equal(f.text, "it broke");
    assert_string_equal(f.path, "arm.k2");
}

TEST(nothing_is_known_at_first)
{
    summary s;
    memset(&s, 0x5a, sizeof s);
    summary_init(&s);
    assert_int_equal(s.status, STATUS_OK);
    assert_string_equal(s.message, "");
    assert_string_equal(s.method, "");
    for (int i = 0; i < summary_count; i++) {
        assert_true(isnan(summary_value(&s, i)));
    }
}

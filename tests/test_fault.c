// Faults: a code and places for programs, a sentence for people.
#include "src/base/fault.h"

#include "tests/check.h"

TEST(a_fault_names_its_parameter)
{
    fault f;
    assert_int_equal(fault_set_at(&f, STATUS_BAD_SCENARIO, "wall.angle", "%s is %d", "it",
                                  7),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(f.code, STATUS_BAD_SCENARIO);
    assert_string_equal(f.text, "it is 7");
    assert_string_equal(f.path, "wall.angle");
    assert_int_equal(f.line, 0);
    // the next one forgets it
    fault_set(&f, STATUS_SINGULAR, "no");
    assert_string_equal(f.path, "");
}

TEST(a_fault_names_its_place)
{
    fault f;
    fault_set_place(&f, STATUS_BAD_SCENARIO, 3, 14, "here");
    assert_int_equal(f.line, 3);
    assert_int_equal(f.column, 14);
    assert_string_equal(f.path, "");
    fault_set(&f, STATUS_OK, "again");
    assert_int_equal(f.line, 0);
}

TEST(nobody_has_to_listen)
{
    assert_int_equal(fault_set(NULL, STATUS_NO_MEMORY, "lost"), STATUS_NO_MEMORY);
    assert_int_equal(fault_set_at(NULL, STATUS_SINGULAR, "arm.k2", "lost"),
                     STATUS_SINGULAR);
    assert_int_equal(fault_set_place(NULL, STATUS_BAD_SCENARIO, 1, 2, "lost"),
                     STATUS_BAD_SCENARIO);
}

TEST(long_sentences_are_cut)
{
    fault f;
    fault_set(&f, STATUS_SINGULAR, "%2000d", 1);
    assert_int_equal(strlen(f.text), sizeof f.text - 1);
}

TEST(every_status_has_a_text_of_its_own)
{
    for (int i = STATUS_OK; i <= STATUS_NOT_ALLOWED; i++) {
        assert_true(strlen(status_text((status)i)) > 0);
        for (int k = STATUS_OK; k < i; k++) {
            assert_string_not_equal(status_text((status)i), status_text((status)k));
        }
    }
    assert_non_null(status_text((status)1000));
}

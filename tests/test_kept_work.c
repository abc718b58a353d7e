// What one did in the lab is kept: scenarios that are opened, pinned runs, leaving.
#include "tests/explorer_on_screen.h"

static double peak(const explorer *ex)
{
    return ex->state.session.run.summary.peak_force_N;
}

// Each way of opening another scenario keeps the changes and the pins; u brings them back, U leaves
// again.
static void test_opening_loses_nothing(void **state)
{
    (void)state;
    static const char *const ways[] = {"]", "[", "o/three<Enter>", ":open thesis/fig-3-4<Enter>",
                                       ":lesson hybrid-law<Enter>"};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        explorer ex;
        open_explorer(&ex, "corrected/first-impact");
        press(&ex, ":seek 0.1<Enter>:set motor.voltage 0.5<Enter>b:seek 0.3<Enter>");
        const double changed = peak(&ex);
        press(&ex, ways[i]);
        assert_string_not_equal(ex.state.session.base.name, "corrected/first-impact");
        assert_int_equal(ex.state.session.input_count, 0);
        assert_int_equal(ex.state.pinned.count, 1);
        const double other = peak(&ex);

        // the run that is compared with is still the pinned one
        assert_true(ex.state.session.has_other);
        check_close(ex.state.session.other.summary.peak_force_N, changed, 0);
        press(&ex, "u");
        assert_string_equal(ex.state.session.base.name, "corrected/first-impact");
        check_close(peak(&ex), changed, 0);
        check_close(ex.state.session.now, 0.3, 1e-12);
        press(&ex, "U");
        check_close(peak(&ex), other, 0);
        press(&ex, "uuU");
        check_close(peak(&ex), changed, 0);
        explorer_finish(&ex);
    }
}

// As many openings as are kept, and more, are undone one by one; a new one forgets what was undone.
static void test_openings_are_undone_one_by_one(void **state)
{
    (void)state;
    explorer ex;
    open_explorer(&ex, "corrected/first-impact");
    for (int i = 0; i < VISITS + 3; i++) {
        press(&ex, i % 2 ? ":open corrected/first-impact<Enter>" : ":open thesis/fig-3-4<Enter>");
    }
    for (int i = 0; i < VISITS - 1; i++) {
        const bool was_printed = strcmp(ex.state.session.base.name, "thesis/fig-3-4") == 0;
        press(&ex, "u");
        assert_int_equal(strcmp(ex.state.session.base.name, "thesis/fig-3-4") == 0, !was_printed);
    }
    press(&ex, "u");
    assert_shows(&ex, "nothing to undo");
    press(&ex, "UU:open corrected/three-links<Enter>U");
    assert_shows(&ex, "nothing to redo");
    explorer_finish(&ex);
}

// Two scenarios side by side: two keys, of at most six.
static void test_a_pinned_run_of_another_scenario_is_drawn_and_taken(void **state)
{
    (void)state;
    static const int sizes[][2] = {{80, 24}, {100, 30}, {200, 60}};
    explorer ex;
    open_explorer(&ex, "corrected/first-impact");
    const double first = peak(&ex);
    press(&ex, "b]");
    assert_int_equal(state_run_count(&ex.state), 2);
    for (size_t i = 0; i < 3; i++) {
        assert_shows_at(&ex, sizes[i][0], sizes[i][1], " first-impact");
    }
    const double second = peak(&ex);
    press(&ex, "R");
    assert_shows(&ex, "of corrected/first-impact");
    press(&ex, "<Enter>");
    assert_string_equal(ex.state.session.base.name, "corrected/first-impact");
    check_close(peak(&ex), first, 0);
    check_close(ex.state.session.other.summary.peak_force_N, second, 0);
    press(&ex, "u");
    check_close(peak(&ex), second, 0);
    explorer_finish(&ex);
}

// Pins of another scenario do not do a lesson's step.
static void test_a_lesson_wants_a_pin_of_its_own(void **state)
{
    (void)state;
    explorer ex;
    open_explorer(&ex, "corrected/first-impact");
    press(&ex, "b:lesson beta-and-gamma<Enter>y");
    assert_int_equal(ex.state.lesson.step, 0);
    press(&ex, "by");
    assert_int_equal(ex.state.lesson.step, 1);

    // and is where it was on return
    press(&ex, "]u");
    assert_int_equal(ex.state.lesson.step, 1);
    explorer_finish(&ex);
}

static void test_leaving_asks_for_everything_that_would_be_lost(void **state)
{
    (void)state;
    static const struct {
        const char *keys, *lost;
    } cases[] = {{"b", "1 pinned run would"},
                 {"b:set arm.k2 5<Enter>b", "1 change and 2 pinned runs would"},
                 {":set arm.k2 5<Enter>]", "1 change would"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        explorer ex;
        open_explorer(&ex, "corrected/first-impact");
        press(&ex, cases[i].keys);
        press(&ex, "q");
        assert_false(ex.state.quit);
        assert_shows(&ex, cases[i].lost);
        press(&ex, "q");
        assert_true(ex.state.quit);
        explorer_finish(&ex);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_opening_loses_nothing),
        cmocka_unit_test(test_openings_are_undone_one_by_one),
        cmocka_unit_test(test_a_pinned_run_of_another_scenario_is_drawn_and_taken),
        cmocka_unit_test(test_a_lesson_wants_a_pin_of_its_own),
        cmocka_unit_test(test_leaving_asks_for_everything_that_would_be_lost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

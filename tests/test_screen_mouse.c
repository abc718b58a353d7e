// The mouse in each part of the terminal lab's screen.
#include "tests/lab_on_screen.h"

#include "src/base/random.h"

static void point(lab *l, pointer_kind kind, int x, int y)
{
    lab_point(l, (pointer_event){.kind = kind, .x = x, .y = y});
    free(picture(l, 120, 40, GLYPHS_BRAILLE));
}

static void click(lab *l, int x, int y)
{
    point(l, POINTER_PRESS, x, y);
    point(l, POINTER_RELEASE, x, y);
}

// Where a part is on the screen.
static lab_spot spot_of(lab *l, lab_part part)
{
    free(picture(l, 120, 40, GLYPHS_BRAILLE));
    for (int i = l->spot_count; i-- > 0;) {
        if (l->spots[i].part == part) {
            return l->spots[i];
        }
    }
    fail_msg("part %d is not on the screen", part);
    return (lab_spot){0};
}

static void test_clicks_and_drags_in_curves_move_the_cursor(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    lab_spot c = spot_of(&l, PART_CURVES);
    click(&l, c.x + c.width / 2, c.y + 3);
    check_close(l.session.now, 0.5, 0.02);
    point(&l, POINTER_PRESS, c.x + c.width / 4, c.y + 3);
    check_close(l.session.now, 0.25, 0.02);
    // a drag goes on beyond the edges
    point(&l, POINTER_DRAG, c.x + 3 * c.width / 4, c.y - 5);
    check_close(l.session.now, 0.75, 0.02);
    point(&l, POINTER_DRAG, 119, 39);
    check_close(l.session.now, 1, 0.02);
    point(&l, POINTER_RELEASE, 119, 39);
    // a release without its press is a click, too
    point(&l, POINTER_RELEASE, c.x + c.width / 2, c.y + 3);
    check_close(l.session.now, 0.5, 0.02);
    lab_finish(&l);
}

static void test_the_wheel_zooms_where_it_points(void **state)
{
    (void)state;
    lab l;
    double from, to;
    open_lab(&l, "corrected/first-impact");
    press(&l, ":seek 0.3<Enter>");
    lab_spot c = spot_of(&l, PART_CURVES);
    int x = c.x + (int)(0.3 * c.width);
    for (int i = 0; i < 5; i++) {
        point(&l, POINTER_WHEEL_UP, x, c.y + 3);
    }
    lab_window(&l, &from, &to);
    check_close(to - from, pow(0.8, 5), 1e-9);
    check_close((0.3 - from) / (to - from), 0.3, 0.02);
    lab_point(&l, (pointer_event){.kind = POINTER_WHEEL_DOWN, .x = x, .y = c.y + 3, .shift = true});
    check_close(l.from, from + 0.1 * (to - from), 1e-9);
    for (int i = 0; i < 9; i++) {
        point(&l, POINTER_WHEEL_DOWN, x, c.y + 3);
    }
    lab_window(&l, &from, &to);
    check_close(to - from, 1, 0);
    lab_finish(&l);
}

static void test_the_time_axis_is_dragged(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    lab_spot a = spot_of(&l, PART_TIME_AXIS);
    click(&l, a.x + a.width / 2, a.y);
    check_close(l.session.now, 0.5, 0.02);
    press(&l, "z");
    a = spot_of(&l, PART_TIME_AXIS);
    double from, to, now = l.session.now;
    lab_window(&l, &from, &to);
    point(&l, POINTER_PRESS, a.x + 20, a.y + 1);
    point(&l, POINTER_DRAG, a.x + 10, a.y + 1);
    point(&l, POINTER_RELEASE, a.x + 10, a.y + 1);
    check_close(l.from, from + 10.0 / a.width * (to - from), 1e-9);
    check_close(l.session.now, now, 0);
    point(&l, POINTER_WHEEL_UP, a.x + 10, a.y + 1);
    check_below(l.from, from + 10.0 / a.width * (to - from));
    assert_true(l.adrift);
    lab_finish(&l);
}

static void test_an_axis_of_values_is_dragged_and_zoomed(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    lab_spot a = spot_of(&l, PART_LABELS);
    assert_int_equal(a.index, 3);
    double low = l.panes[3].drawn_low, high = l.panes[3].drawn_high;
    point(&l, POINTER_PRESS, a.x + 2, a.y + 1);
    assert_int_equal(lab_focused_pane(&l), 3);
    point(&l, POINTER_DRAG, a.x + 2, a.y + 2);
    point(&l, POINTER_RELEASE, a.x + 2, a.y + 2);
    // what is under the pointer goes down with it
    check_close(l.panes[3].low, low + (high - low) / a.height, 1e-9);
    point(&l, POINTER_WHEEL_UP, a.x + 2, a.y + 1);
    check_close(l.panes[3].high - l.panes[3].low, 0.8 * (high - low), 1e-9);
    lab_finish(&l);
}

static void test_events_and_scenarios_are_clicked(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    press(&l, "<End>");
    lab_spot log = spot_of(&l, PART_LOG);
    const event *third = &l.session.run.trace.events[log.index + 2];
    click(&l, log.x + 2, log.y + 2);
    check_close(l.session.now, third->time, 0);
    // below the last one there is nothing
    click(&l, log.x + 2, log.y + log.height - 1);
    press(&l, "o<Home>");
    lab_spot list = spot_of(&l, PART_LIST);
    const char *name = l.names[list.index + 1];
    click(&l, list.x + 3, list.y + 1);
    assert_int_equal(l.overlay, OVERLAY_OPEN);
    assert_string_equal(l.names[l.scroll], name);
    click(&l, list.x + 3, list.y + 1);
    assert_int_equal(l.overlay, OVERLAY_NONE);
    assert_string_equal(l.session.base.name, name);
    // a click beside the list closes it
    press(&l, "o");
    (void)spot_of(&l, PART_LIST);
    click(&l, 1, 5);
    assert_int_equal(l.overlay, OVERLAY_NONE);
    assert_string_equal(l.session.base.name, name);
    lab_finish(&l);
}

static void test_the_wheel_scrolls_pages_and_panels(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    press(&l, "?");
    lab_spot page = spot_of(&l, PART_HELP);
    point(&l, POINTER_WHEEL_DOWN, page.x + 5, page.y + 5);
    assert_int_equal(l.scroll, 3);
    for (int i = 0; i < 50; i++) {
        point(&l, POINTER_WHEEL_DOWN, page.x + 5, page.y + 5);
    }
    assert_shows(&l, "Shift-drag selects");
    for (int i = 0; i < 50; i++) {
        point(&l, POINTER_WHEEL_UP, page.x + 5, page.y + 5);
    }
    assert_int_equal(l.scroll, 0);
    press(&l, "<Esc><Tab>");
    lab_spot values = spot_of(&l, PART_VALUES);
    assert_hides(&l, "calculated_for");
    for (int i = 0; i < 20; i++) {
        point(&l, POINTER_WHEEL_DOWN, values.x + 5, values.y + 5);
    }
    assert_shows(&l, "calculated_for");
    // elsewhere it selects parameters as the arrows do, but not while something is typed
    press(&l, "<Tab>");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    int before = l.parameter;
    point(&l, POINTER_WHEEL_DOWN, values.x + 5, values.y + 5);
    assert_int_not_equal(l.parameter, before);
    press(&l, ":set ");
    point(&l, POINTER_WHEEL_UP, values.x + 5, values.y + 5);
    assert_string_equal(l.prompt, "set ");
    lab_finish(&l);
}

static void test_random_pointing_does_no_harm(void **state)
{
    (void)state;
    random_generator r;
    random_seed(&r, 11);
    lab l;
    open_lab(&l, "compare/hybrid");
    static const char *const pages[] = {"",           "?",       "<Esc>o", "<Esc>c",
                                        "<Esc><Tab>", "<Esc>:x", "<Esc>w"};
    for (int i = 0; i < 3000; i++) {
        pointer_event p = {(pointer_kind)random_below(&r, 5), (int)random_below(&r, 130) - 5,
                           (int)random_below(&r, 50) - 5, random_below(&r, 2) != 0,
                           random_below(&r, 2) != 0};
        lab_point(&l, p);
        if (i % 10 == 0) {
            press(&l, pages[random_below(&r, sizeof pages / sizeof pages[0])]);
            free(picture(&l, 1 + (int)random_below(&r, 140), 1 + (int)random_below(&r, 50),
                         GLYPHS_BRAILLE));
        }
        double from, to;
        lab_window(&l, &from, &to);
        assert_true(from >= 0 && from < to &&
                    to <= l.session.effective.parameters.run.duration * (1 + 1e-12));
    }
    lab_finish(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clicks_and_drags_in_curves_move_the_cursor),
        cmocka_unit_test(test_the_wheel_zooms_where_it_points),
        cmocka_unit_test(test_the_time_axis_is_dragged),
        cmocka_unit_test(test_an_axis_of_values_is_dragged_and_zoomed),
        cmocka_unit_test(test_events_and_scenarios_are_clicked),
        cmocka_unit_test(test_the_wheel_scrolls_pages_and_panels),
        cmocka_unit_test(test_random_pointing_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

// The mouse in each part of the explorer's screen.
#include "tests/explorer_on_screen.h"

static void click(explorer *ex, int x, int y)
{
    point(ex, POINTER_PRESS, x, y);
    point(ex, POINTER_RELEASE, x, y);
}

TEST(test_clicks_and_drags_in_curves_move_the_cursor)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    hit_area c = part_on_screen(&ex, PANEL_CURVES, PART_BODY);
    click(&ex, c.area.x + c.area.width / 2, c.area.y + 3);
    check_close(ex.model.session.now, 0.5, 0.02);
    point(&ex, POINTER_PRESS, c.area.x + c.area.width / 4, c.area.y + 3);
    check_close(ex.model.session.now, 0.25, 0.02);
    // a drag continues beyond the edges
    point(&ex, POINTER_DRAG, c.area.x + 3 * c.area.width / 4, c.area.y - 5);
    check_close(ex.model.session.now, 0.75, 0.02);
    point(&ex, POINTER_DRAG, 119, 39);
    check_close(ex.model.session.now, 1, 0.02);
    point(&ex, POINTER_RELEASE, 119, 39);
    // a release without its press is a click, too
    point(&ex, POINTER_RELEASE, c.area.x + c.area.width / 2, c.area.y + 3);
    check_close(ex.model.session.now, 0.5, 0.02);
}

TEST(test_the_wheel_zooms_where_it_points)
{
    double from, to;
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.3<Enter>");
    hit_area c = part_on_screen(&ex, PANEL_CURVES, PART_BODY);
    int x = c.area.x + (int)(0.3 * c.area.width);
    for (int i = 0; i < 5; i++) {
        point(&ex, POINTER_WHEEL_UP, x, c.area.y + 3);
    }
    view_window(&ex.model, &ex.view, &from, &to);
    check_close(to - from, pow(0.8, 5), 1e-9);
    check_close((0.3 - from) / (to - from), 0.3, 0.02);
    explorer_point(&ex, (pointer_event){.kind = POINTER_WHEEL_DOWN,
                                        .x = x,
                                        .y = c.area.y + 3,
                                        .shift = true});
    check_close(ex.view.window.from, from + 0.1 * (to - from), 1e-9);
    for (int i = 0; i < 9; i++) {
        point(&ex, POINTER_WHEEL_DOWN, x, c.area.y + 3);
    }
    view_window(&ex.model, &ex.view, &from, &to);
    check_close(to - from, 1, 0);

    // over a legend, too
    const hit_area l = part_on_screen(&ex, PANEL_CURVES, PART_LEGEND);
    point(&ex, POINTER_WHEEL_UP, l.area.x, l.area.y);
    view_window(&ex.model, &ex.view, &from, &to);
    check_close(from, 0.2 * (l.area.x - c.area.x + 0.5) / c.area.width, 1e-9);
}

TEST(test_the_time_axis_is_dragged)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    hit_area a = part_on_screen(&ex, PANEL_CURVES, PART_TIME_AXIS);
    click(&ex, a.area.x + a.area.width / 2, a.area.y);
    check_close(ex.model.session.now, 0.5, 0.02);
    press(&ex, "z");
    a = part_on_screen(&ex, PANEL_CURVES, PART_TIME_AXIS);
    double from, to, now = ex.model.session.now;
    view_window(&ex.model, &ex.view, &from, &to);
    point(&ex, POINTER_PRESS, a.area.x + 20, a.area.y + 1);
    point(&ex, POINTER_DRAG, a.area.x + 10, a.area.y + 1);
    point(&ex, POINTER_RELEASE, a.area.x + 10, a.area.y + 1);
    check_close(ex.view.window.from, from + 10.0 / a.area.width * (to - from), 1e-9);
    check_close(ex.model.session.now, now, 0);
    point(&ex, POINTER_WHEEL_UP, a.area.x + 10, a.area.y + 1);
    check_below(ex.view.window.from, from + 10.0 / a.area.width * (to - from));
    assert_true(ex.view.window.adrift);
}

TEST(test_an_axis_of_values_is_dragged_and_zoomed)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    hit_area a = part_on_screen(&ex, PANEL_CURVES, PART_LABELS);
    assert_int_equal(a.index, 3);
    double low = ex.layout.axes[3].low, high = ex.layout.axes[3].high;
    point(&ex, POINTER_PRESS, a.area.x + 2, a.area.y + 1);
    assert_int_equal(panes_focused(&ex.view.panes), 3);
    point(&ex, POINTER_DRAG, a.area.x + 2, a.area.y + 2);
    point(&ex, POINTER_RELEASE, a.area.x + 2, a.area.y + 2);
    // what is under the pointer goes down with it
    check_close(ex.view.panes.pane[3].fixed.low, low + (high - low) / a.area.height,
                1e-9);
    point(&ex, POINTER_WHEEL_UP, a.area.x + 2, a.area.y + 1);
    check_close(ex.view.panes.pane[3].fixed.high - ex.view.panes.pane[3].fixed.low,
                0.8 * (high - low), 1e-9);
}

TEST(test_runs_and_scenarios_are_clicked)
{
    // a pinned run is hidden by a click on its results, and shown by another
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:set motor.voltage 2<Enter>");
    const hit_area run = part_on_screen(&ex, PANEL_RESULTS, PART_LINES);
    click(&ex, run.area.x + 20, run.area.y);
    assert_true(ex.model.pinned.runs[0].hidden);
    click(&ex, run.area.x + 20, run.area.y);
    assert_false(ex.model.pinned.runs[0].hidden);

    // a click in the list of what can be opened opens it
    press(&ex, "ofig-3-4");
    hit_area list = part_on_screen(&ex, PANEL_PALETTE, PART_LINES);
    click(&ex, list.area.x + 3, list.area.y);
    assert_false(ex.input.prompt.open);
    assert_string_equal(ex.model.session.base.name, "thesis/fig-3-4");
}

// A click may come before the screen is drawn anew: what it was on may be gone.
TEST(test_a_click_on_what_is_gone_does_nothing)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:set motor.voltage 2<Enter>");
    const hit_area run = part_on_screen(&ex, PANEL_RESULTS, PART_LINES);
    press(&ex, "B");
    explorer_point(&ex, (pointer_event){POINTER_PRESS, run.area.x, run.area.y, 0, 0});
    explorer_point(&ex, (pointer_event){POINTER_RELEASE, run.area.x, run.area.y, 0, 0});
    assert_int_equal(ex.model.pinned.count, 0);
    press(&ex, ":sweep motor.voltage=1:2:3 arm.k2=4:6:2<Enter>");
    const hit_area map = part_on_screen(&ex, PANEL_SWEEP, PART_CELLS);
    for (EACH_TEXT(c, ":sweep arm.k2=4:6:2<Enter>", ":sweep off<Enter>")) {
        press(&ex, *c);
        explorer_point(&ex, (pointer_event){POINTER_PRESS, map.area.x, map.area.y, 0, 0});
        assert_int_equal(ex.model.sweep.selected, 0);
    }
}

TEST(test_the_wheel_scrolls_pages_and_panels)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "?");
    hit_area page = part_on_screen(&ex, PANEL_HELP, PART_BODY);
    point(&ex, POINTER_WHEEL_DOWN, page.area.x + 5, page.area.y + 5);
    assert_int_equal(ex.view.drawn.scroll[PANEL_HELP], 3);
    for (int i = 0; i < 50; i++) {
        point(&ex, POINTER_WHEEL_DOWN, page.area.x + 5, page.area.y + 5);
    }
    assert_shows(&ex, "Shift-drag selects");
    for (int i = 0; i < 50; i++) {
        point(&ex, POINTER_WHEEL_UP, page.area.x + 5, page.area.y + 5);
    }
    assert_int_equal(ex.view.drawn.scroll[PANEL_HELP], 0);
    press(&ex, "<Esc><Tab><Tab>");
    hit_area values = part_on_screen(&ex, PANEL_VALUES, PART_BODY);
    assert_shows(&ex, "!calculated_for");
    for (int i = 0; i < 20; i++) {
        point(&ex, POINTER_WHEEL_DOWN, values.area.x + 5, values.area.y + 5);
    }
    assert_shows(&ex, "calculated_for");
    // elsewhere it selects parameters as the arrows do, but not while something is typed
    press_draws(&ex, "<Tab><Tab>");
    int before = ex.view.parameters.parameter;
    point(&ex, POINTER_WHEEL_DOWN, values.area.x + 5, values.area.y + 5);
    assert_int_not_equal(ex.view.parameters.parameter, before);
    press(&ex, ":set ");
    point(&ex, POINTER_WHEEL_UP, values.area.x + 5, values.area.y + 5);
    assert_string_equal(ex.input.prompt.text, "set ");
}

TEST(test_random_pointing_does_no_harm)
{
    random_generator r = seeded(11);
    OPEN_EXPLORER(ex, "compare/hybrid");
    static const char *const pages[] = {"",           "?",       "<Esc>o", "<Esc>c",
                                        "<Esc><Tab>", "<Esc>:x", "<Esc>w"};
    for (int i = 0; i < 3000; i++) {
        pointer_event p = {(pointer_kind)random_below(&r, 5),
                           (int)random_below(&r, 130) - 5, (int)random_below(&r, 50) - 5,
                           random_below(&r, 2) != 0, random_below(&r, 2) != 0};
        explorer_point(&ex, p);
        if (i % 10 == 0) {
            press(&ex, pages[random_below(&r, sizeof pages / sizeof pages[0])]);
            free(picture(&ex, 1 + (int)random_below(&r, 140),
                         1 + (int)random_below(&r, 50), GLYPHS_BRAILLE));
        }
        double from, to;
        view_window(&ex.model, &ex.view, &from, &to);
        assert_true(from >= 0 && from < to &&
                    to <=
                        ex.model.session.effective.parameters.run.duration * (1 + 1e-12));
    }
}

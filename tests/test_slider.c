// Sliders of the explorer's parameters: what they span, and the mouse on them.
#include "tests/explorer_on_screen.h"

// The slider drawn last for a parameter, the wide one where it is selected.
static hit_area slider_of(explorer *ex, int parameter)
{
    free(picture(ex, 120, 40, GLYPHS_BRAILLE));
    hit_area widest = {.panel = PANEL_NONE};
    for (int i = 0; i < ex->layout.hit_count; i++) {
        const hit_area *s = &ex->layout.hits[i];
        if (s->part == PART_SLIDER && s->index == parameter &&
            s->area.width > widest.area.width) {
            widest = *s;
        }
    }
    assert_int_equal(widest.part, PART_SLIDER);
    return widest;
}

TEST(test_every_number_has_a_scale_that_suits_it)
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        bool number = info->type == PARAMETER_REAL || info->type == PARAMETER_INTEGER;
        double value = parameter_get(&p, i);
        slider_scale scale;
        if (number && !isfinite(value)) {
            continue; // follows from others where it is not given
        }
        assert_int_equal(slider_scale_of(i, value, &scale), number);
        if (!number) {
            continue;
        }
        check_below(scale.low, scale.high);
        assert_true(scale.low >= info->minimum && scale.high <= info->maximum);
        assert_true(scale.low <= value && value <= scale.high);
        for (int k = 0; k <= 20; k++) {
            double at = slider_value(&scale, i, k / 20.0, 21);
            DONE(parameter_set_number(&p, i, at, &f));
            check_close(slider_share(&scale, at), k / 20.0,
                        info->type == PARAMETER_INTEGER ? 0.5 : 0.051);
        }
        // far away from the default it is still on the scale
        assert_true(slider_scale_of(i, info->maximum, &scale));
        check_close(slider_share(&scale, info->maximum), 1, 0);
    }
}

TEST(test_ranges_over_decades_are_logarithmic)
{
    slider_scale k2, kp, damping;
    assert_true(slider_scale_of(PARAMETER_INDEX(arm.k2), 4.92, &k2));
    assert_true(slider_scale_of(PARAMETER_INDEX(control.kp), 10.15, &kp));
    assert_true(slider_scale_of(PARAMETER_INDEX(arm.damping_ratio), 0.1, &damping));
    assert_true(k2.logarithmic && k2.low == 0.01 && k2.high == 1000);
    assert_true(!kp.logarithmic && kp.low == -50 && kp.high == 50);
    assert_true(!damping.logarithmic && damping.low == 0 && damping.high == 1);
}

TEST(test_the_run_follows_a_drag)
{
    const int voltage = PARAMETER_INDEX(motor.voltage);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.2<Enter>");
    hit_area s = slider_of(&ex, voltage);
    unsigned computed = ex.model.session.version;
    point(&ex, POINTER_PRESS, s.area.x + s.area.width / 2, s.area.y);
    for (int i = 0; i < 10; i++) {
        point(&ex, POINTER_DRAG, s.area.x + s.area.width - 1 - i / 5, s.area.y + i);
    }
    // the run follows the mouse, that as opened stays beside it, and all of it is one
    // change
    assert_true(ex.model.session.version > computed);
    assert_true(ex.model.opened_run.shown);
    check_below(1, value_of(&ex, voltage));
    assert_int_equal(ex.model.session.input_count, 1);
    point(&ex, POINTER_DRAG, s.area.x + s.area.width + 50, s.area.y);
    assert_shows(&ex, "5 V");
    point(&ex, POINTER_RELEASE, s.area.x + s.area.width + 50, s.area.y);
    assert_int_equal(ex.model.session.input_count, 1);
    check_close(value_of(&ex, voltage), 5, 0);
    check_close(ex.model.session.inputs[0].time, 0.2, 0);
    // a click where the knob is changes nothing
    s = slider_of(&ex, voltage);
    point(&ex, POINTER_PRESS, s.area.x + s.area.width - 1, s.area.y);
    point(&ex, POINTER_RELEASE, s.area.x + s.area.width - 1, s.area.y);
    assert_int_equal(ex.model.session.input_count, 1);
    press(&ex, "u");
    check_close(value_of(&ex, voltage), 1, 0);
    assert_false(ex.model.opened_run.shown);
}

TEST(test_clicks_select_and_the_wheel_nudges)
{
    const int limit = PARAMETER_INDEX(motor.voltage_limit);
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<Tab>");
    hit_area s = slider_of(&ex, limit);
    // the line of it, not its slider
    point(&ex, POINTER_PRESS, s.area.x - 10, s.area.y);
    point(&ex, POINTER_RELEASE, s.area.x - 10, s.area.y);
    assert_int_equal(ex.view.parameters.parameter, limit);
    assert_int_equal(ex.model.session.input_count, 0);
    s = slider_of(&ex, limit);
    point(&ex, POINTER_WHEEL_UP, s.area.x + 1, s.area.y);
    check_close(value_of(&ex, limit), 11, 0);
    point(&ex, POINTER_WHEEL_DOWN, s.area.x + 1, s.area.y);
    check_close(value_of(&ex, limit), 10, 0);
}

// The wide slider, ends and all.
static void assert_slider(explorer *ex, int width, int height, glyph_set set,
                          const char *track)
{
    KEPT_TEXT(text) = picture(ex, width, height, set);
    fail_if(!strstr(text, " -5 ") || !strstr(text, track) || !strstr(text, " 5 "),
            "no slider on the screen of %d x %d:\n%s", width, height, text);
}

TEST(test_the_selected_number_has_a_slider_on_every_screen)
{
    static const int sizes[][2] = {{45, 16}, {60, 24}, {80, 24}, {120, 40}, {200, 60}};
    static const glyph_set sets[] = {GLYPHS_BRAILLE, GLYPHS_BLOCKS, GLYPHS_ASCII};
    static const char *const tracks[] = {"\u2500\u25cf\u2500", "\u2500\u25cf\u2500",
                                         "-o-"};
    OPEN_EXPLORER(ex, "corrected/first-impact");
    ex.view.side.in_front = true;
    for (int i = 0; i < 15; i++) {
        assert_slider(&ex, sizes[i / 3][0], sizes[i / 3][1], sets[i % 3], tracks[i % 3]);
    }
}

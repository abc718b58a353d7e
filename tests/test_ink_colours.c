// The colours of the explorer: readable on their backgrounds, distinguishable by
// everyone, and the same choice with fewer of them.
#include "tests/explorer_on_screen.h"

#include "tests/colour_vision.h"
#include "ui/terminal/ink_colours.h"

TEST(test_measures_agree_with_known_values)
{
    const rgb black = {0, 0, 0}, white = {255, 255, 255}, grey = {119, 119, 119};
    check_close(rgb_contrast(black, white), 21, 1e-9);
    check_close(rgb_contrast(white, white), 1, 1e-12);
    check_close(rgb_contrast(grey, white), 4.48, 0.005);
    check_close(rgb_distance(black, white), 1, 1e-6);
    assert_int_equal(colour_256(16).red, 0);
    assert_int_equal(colour_256(231).green, 255);
    assert_int_equal(colour_256(208).green, 135);
    assert_int_equal(colour_256(255).blue, 238);
}

static double least_contrast(colour_theme theme, rgb c)
{
    return fmin(rgb_contrast(c, theme_grounds(theme)[0]),
                rgb_contrast(c, theme_grounds(theme)[1]));
}

TEST(test_every_ink_can_be_read_on_its_ground)
{
    for (int theme = COLOURS_DARK; theme <= COLOURS_LIGHT; theme++) {
        for (int i = 0; i < INK_COUNT; i++) {
            rgb c;
            double least = i == INK_FRAME ? 3 : 4.5;
            if (!ink_rgb((colour_theme)theme, (ink)i, &c)) {
                assert_int_equal(ink_index((colour_theme)theme, (ink)i, DEPTH_256), -1);
                assert_int_equal(ink_index((colour_theme)theme, (ink)i, DEPTH_16), -1);
                continue;
            }
            fail_if(least_contrast((colour_theme)theme, c) < least,
                    "ink %d of theme %d: contrast %.2f", i, theme,
                    least_contrast((colour_theme)theme, c));
            int near = ink_index((colour_theme)theme, (ink)i, DEPTH_256),
                basic = ink_index((colour_theme)theme, (ink)i, DEPTH_16);
            assert_in_range(near, 16, 255);
            assert_true(least_contrast((colour_theme)theme, colour_256(near)) >= least);
            check_below(rgb_distance(colour_256(near), c), 0.09);
            assert_true(basic < 16);
            assert_true(basic < 0 ||
                        rgb_contrast(colour_256(basic),
                                     theme_grounds((colour_theme)theme)[0]) >= least);
        }
    }
}

static colour colour_of(rgb c)
{
    return (colour){c.red / 255.0, c.green / 255.0, c.blue / 255.0};
}

TEST(test_curves_are_told_apart_by_everybody)
{
    for (int theme = COLOURS_DARK; theme <= COLOURS_LIGHT; theme++) {
        for (int i = INK_SERIES_0; i < INK_COUNT; i++) {
            for (int j = INK_SERIES_0; j < i; j++) {
                rgb a, b;
                ink_rgb((colour_theme)theme, (ink)i, &a);
                ink_rgb((colour_theme)theme, (ink)j, &b);
                for (int sight = 0; sight < 3; sight++) {
                    double apart = distance_seen(colour_of(a), colour_of(b), sight);
                    fail_if(apart < 10,
                            "curves %d and %d of theme %d are %.1f apart in %s",
                            i - INK_SERIES_0, j - INK_SERIES_0, theme, apart,
                            sight_names[sight]);
                }
                // with fewer colours they are at least not the same; on light ground 16
                // have only seven that can be read, text's own among them
                assert_true(theme == COLOURS_LIGHT ||
                            ink_index((colour_theme)theme, (ink)i, DEPTH_16) !=
                                ink_index((colour_theme)theme, (ink)j, DEPTH_16));
                assert_int_not_equal(ink_index((colour_theme)theme, (ink)i, DEPTH_256),
                                     ink_index((colour_theme)theme, (ink)j, DEPTH_256));
            }
        }
    }
}

TEST(test_no_colour_in_mono)
{
    rgb c;
    for (int i = 0; i < INK_COUNT; i++) {
        assert_false(ink_rgb(COLOURS_MONO, (ink)i, &c));
        assert_int_equal(ink_index(COLOURS_MONO, (ink)i, DEPTH_256), -1);
        assert_int_equal(ink_index(COLOURS_MONO, (ink)i, DEPTH_16), -1);
    }
}

// Two signals with colours that a terminal of 16 colours shows as one.
static void find_alike(colour_theme theme, int pair[2])
{
    for (int a = 0; a < signal_count; a++) {
        for (int b = a + 1; b < signal_count; b++) {
            const int x = signal_table[a].colour, y = signal_table[b].colour;
            const ink one = (ink)(INK_SERIES_0 + x), other = (ink)(INK_SERIES_0 + y);
            if (x != y &&
                ink_index(theme, one, DEPTH_16) == ink_index(theme, other, DEPTH_16)) {
                pair[0] = a;
                pair[1] = b;
                return;
            }
        }
    }
    fail_msg("all signals differ by themselves");
}

// The curves of one pane, by the inks in the legends of a screen.
TEST(test_curves_of_a_pane_differ_with_few_colours)
{
    static const char *const scenarios[] = {"compare/hybrid", "corrected/first-impact"};
    for (int n = 0; n < 4; n++) {
        SCOPED(screen_finish) screen s = {0};
        OPEN_EXPLORER(ex, scenarios[n % 2]);
        const colour_theme theme = n < 2 ? COLOURS_LIGHT : COLOURS_DARK;
        ex.view.looks.theme = theme;
        ex.view.looks.depth = DEPTH_16;
        press(&ex, ":panes 12345678<Enter>");
        if (theme == COLOURS_LIGHT) {
            int pair[2] = {0};
            find_alike(theme, pair);
            assert_true(explorer_carry_out(&ex, formatted("trace %s %s",
                                                          signal_table[pair[0]].name,
                                                          signal_table[pair[1]].name)));
        }
        screen_resize(&s, 120, 80);
        explorer_draw(&ex, &s);

        // a legend has a piece of line and a blank before each name
        for (int y = ex.layout.plot.y; y < ex.layout.plot.y + ex.layout.plot.height;
             y++) {
            ink seen[PANE_SIGNALS];
            int count = 0;
            const cell *row = &s.cells[(long)y * s.width];
            for (int x = ex.layout.plot.x;
                 x + 2 < ex.layout.plot.x + ex.layout.plot.width; x++) {
                const uint32_t g = row[x].glyph;
                const bool line =
                    g == 0x2500 || g == 0x254c || g == 0x2508 || g == 0x2574;
                if (line && row[x + 1].glyph == ' ' && row[x].ink >= INK_SERIES_0 &&
                    count < PANE_SIGNALS) {
                    for (int k = 0; k < count; k++) {
                        assert_int_not_equal(ink_index(theme, seen[k], DEPTH_16),
                                             ink_index(theme, row[x].ink, DEPTH_16));
                    }
                    seen[count++] = row[x].ink;
                }
            }
        }
    }
}

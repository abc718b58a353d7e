// Contour lines over a grid, and the colour scale of maps.
#include "render/plot/drawing.h"

#include "render/page/palette.h"
#include "tests/check.h"

TEST(contours_lie_where_a_plane_has_the_level)
{
    contour_piece pieces[2];
    // z = 1 + 2 x + 4 y at the corners
    const double tilted[4] = {1, 3, 5, 7};
    assert_int_equal(contour_square(tilted, 0, pieces), 0);
    assert_int_equal(contour_square(tilted, 8, pieces), 0);
    for (double level = 1.5; level < 7; level += 1) {
        assert_int_equal(contour_square(tilted, level, pieces), 1);
        check_close(1 + 2 * pieces[0].x0 + 4 * pieces[0].y0, level, 1e-14);
        check_close(1 + 2 * pieces[0].x1 + 4 * pieces[0].y1, level, 1e-14);
    }
    const double hole[4] = {1, 3, (double)NAN, 7};
    assert_int_equal(contour_square(hole, 2, pieces), 0);
}

TEST(a_saddle_is_cut_by_its_middle)
{
    contour_piece pieces[2];
    // high at (0, 0) and (1, 1); the middle is at 5
    const double saddle[4] = {10, 0, 0, 10};
    for (double level = 4; level < 7; level += 2) {
        assert_int_equal(contour_square(saddle, level, pieces), 2);
        for (int i = 0; i < 2; i++) {
            // below the middle the low corners are cut off, where x - y is far from 0; above it the
            // high ones, where x + y is far from 1
            double x = (pieces[i].x0 + pieces[i].x1) / 2, y = (pieces[i].y0 + pieces[i].y1) / 2;
            check_close(level < 5 ? x + y : x - y, level < 5 ? 1 : 0, 1e-14);
        }
    }
}

TEST(the_colour_scale_grows_lighter_all_the_way)
{
    double before = -1;
    for (int i = 0; i <= 100; i++) {
        colour c = palette_shade(THEME_COLOUR, i / 100.0);
        double light =
            0.2126 * pow(c.red, 2.2) + 0.7152 * pow(c.green, 2.2) + 0.0722 * pow(c.blue, 2.2);
        check_below(before, light);
        before = light;
    }
}

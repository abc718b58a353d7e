// The lanes below the curves agree with the rows.
#include "tests/explorer_on_screen.h"

// The part of a kind that was drawn last, of width 0 if none was.
static area find_part(const explorer *ex, hit_part part)
{
    for (int i = 0; i < ex->layout.hit_count; i++) {
        if (ex->layout.hits[i].panel == PANEL_CURVES && ex->layout.hits[i].part == part) {
            return ex->layout.hits[i].area;
        }
    }
    return (area){0};
}

// Draws an explorer and returns its cells, to be finished.
static screen drawn(explorer *ex, int width, int height)
{
    screen s = {0};
    screen_resize(&s, width, height);
    explorer_draw(ex, &s);
    return s;
}

TEST(test_the_contact_lane_is_where_rows_touch)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>");
    SCOPED(screen_finish) screen s = drawn(&ex, 120, 50);
    const area lanes = find_part(&ex, PART_TIME_AXIS); // its line
    assert_true(lanes.width > 20 && lanes.height >= 1);

    // every column: filled if and only if a row in it is in contact
    const trace *t = &ex.model.session.run.trace;
    const double duration = ex.model.session.effective.parameters.run.duration;
    int filled = 0;
    for (int i = 0; i < lanes.width; i++) {
        const double from = duration * i / lanes.width,
                     to = duration * (i + 1) / lanes.width;
        bool touches = false;
        for (size_t r = trace_row_at(t, from); r <= trace_row_at(t, to); r++) {
            touches = touches || t->rows[r].contact != 0;
        }
        // marks and their labels lie over it
        const uint32_t glyph = s.cells[lanes.y * s.width + lanes.x + i].glyph;
        if (glyph == 0x2592 || glyph == 0x2500) {
            assert_int_equal(glyph == 0x2592, touches);
        }
        filled += glyph == 0x2592;
    }
    assert_true(filled > 5 && filled < lanes.width - 5);
}

TEST(test_modes_are_named_and_changes_told)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.2<Enter>:set control.force 2<Enter><End>");
    KEPT_TEXT(text) = picture(&ex, 200, 60, GLYPHS_BRAILLE);
    assert_non_null(strstr(text, "│approach───"));
    assert_non_null(strstr(text, "│impact──"));
    assert_non_null(strstr(text, "force 2●"));

    // nothing of the future is shown but that a change will come
    press(&ex, ":seek 0.1<Enter>:restart<Enter><Space>:wait 0.5<Enter>");
    KEPT_TEXT(early) = picture(&ex, 200, 60, GLYPHS_BRAILLE);
    assert_null(strstr(early, "│impact"));
    assert_non_null(strstr(early, "○force 2"));
}

// Where rows are few the axis has one, with the instants of its ends on its line.
TEST(test_a_low_screen_has_an_axis_of_one_row)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.1<Enter>");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    const area low = find_part(&ex, PART_TIME_AXIS);
    assert_int_equal(low.height, 1);
    assert_shows_at(&ex, 80, 24, "▒ contact 0──");
    assert_shows_at(&ex, 80, 24, "──1 s");
    free(picture(&ex, 120, 50, GLYPHS_BRAILLE));
    assert_int_equal(find_part(&ex, PART_TIME_AXIS).height, 2);
}

TEST(test_a_click_moves_the_cursor_or_the_window)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, "<End>");
    free(picture(&ex, 120, 50, GLYPHS_BRAILLE));
    const area lanes = find_part(&ex, PART_LANES);
    assert_int_equal(lanes.height, 1);
    explorer_point(&ex, (pointer_event){POINTER_PRESS, lanes.x + lanes.width / 2, lanes.y,
                                        false, false});
    check_close(ex.model.session.now, session_end(&ex.model.session) / 2, 0.03);
    explorer_point(&ex, (pointer_event){POINTER_RELEASE, lanes.x, lanes.y, false, false});
}

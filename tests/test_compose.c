// The explorer on small and narrow screens: no word is cut, and the most important parts
// stay.
#include "tests/explorer_on_screen.h"

static char *lines_of(const char *text, int width, bool *split)
{
    static char out[512];
    text_line lines[32];
    int count = text_wrap(text, width, lines, 32, split);
    out[0] = '\0';
    for (int i = 0; i < count; i++) {
        size_t used = strlen(out);
        snprintf(out + used, sizeof out - used, "%.*s|", lines[i].bytes, lines[i].start);
    }
    return out;
}

TEST(test_text_is_wrapped_at_blanks)
{
    bool split;
    assert_string_equal(lines_of("one two three", 7, &split), "one two|three|");
    assert_false(split);
    assert_string_equal(lines_of("one two three", 5, &split), "one|two|three|");
    assert_false(split);
    assert_string_equal(lines_of("one two three", 4, &split), "one|two|thre|e|");
    assert_true(split);
    assert_string_equal(lines_of("  \u03b8\u03b8\u03b8 \u25b6 x  ", 5, &split),
                        "\u03b8\u03b8\u03b8 \u25b6|x|");
    assert_false(split);
    assert_string_equal(lines_of("", 5, &split), "");
    assert_false(split);
    assert_string_equal(lines_of("ab", 1, &split), "a|b|");
}

static void check_small(explorer *ex, int width, int height, const char *wanted)
{
    KEPT_TEXT(text) = picture(ex, width, height, GLYPHS_BRAILLE);
    fail_if(strncmp(text, wanted, strlen(wanted)) != 0, "%d x %d shows\n%s", width,
            height, text);
}

TEST(test_a_screen_that_is_too_small_says_so_in_what_fits)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    check_small(&ex, 1, 1, "<\n");
    check_small(&ex, 4, 3, "<\n");
    check_small(&ex, 5, 1, "small\n");
    check_small(&ex, 5, 2, "5x2 <\n40x12\n");
    check_small(&ex, 12, 1, "12x1 < 40x12\n");
    check_small(&ex, 20, 5,
                "The lab needs 40 x\n12 characters, here\nare 20 x 5. q quits.\n");
    check_small(&ex, 200, 5,
                "The lab needs 40 x 12 characters, here are 200 x 5. q quits.\n");
    // no word is ever cut at the edge
    for (int width = 1; width < 60; width++) {
        for (int height = 1; height < 12; height++) {
            KEPT_TEXT(text) = picture(&ex, width, height, GLYPHS_ASCII);
            char *rest = text;
            for (char *word; (word = strtok_r(rest, " \n", &rest)) != NULL;) {
                bool known = strspn(word, "0123456789x.:") == strlen(word);
                for (EACH_TEXT(c, "The", "lab", "needs", "40", "x", "12", "characters,",
                               "here", "are", "q", "quits.", "the", "(q", "quits)", "<",
                               "small", "40x12")) {
                    known = known || strcmp(word, *c) == 0;
                }
                fail_if(!known, "'%s' at %d x %d", word, width, height);
            }
        }
    }
}

TEST(test_the_status_keeps_what_matters)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":seek 0.65<Enter>m");
    for (int width = 40; width < 200; width += 3) {
        assert_shows_at(&ex, width, 24, "paused");
        assert_shows_at(&ex, width, 24, "t 0.65000 s");
    }
    assert_shows_at(&ex, 60, 24, "hybrid: force");
    assert_shows_at(&ex, 80, 24, "in contact, hub sticks");
    assert_shows_at(&ex, 110, 24, "corrected");

    // the last row of that instant, of all that there are
    const trace *t = &ex.model.session.run.trace;
    size_t row = 0;
    while (row < t->row_count && t->rows[row].time < 0.65 + 1e-9) {
        row++;
    }
    assert_shows_at(&ex, 120, 24, formatted("row %zu/%zu", row, t->row_count));

    // the keys for help and quitting are always shown
    press(&ex, "<Esc>");
    for (int width = 40; width < 200; width += 3) {
        assert_shows_at(&ex, width, 24, "? help  q quit");
        assert_shows_at(&ex, width, 24, "Space run/pause");
    }
}

TEST(test_eighty_columns_show_what_a_first_visit_needs)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.35<Enter>");
    for (EACH_TEXT(c, "force 1.2", "gap 0", "voltage", "0\u2524", "1 s", "0.1\u2524",
                   "energy 1.48 N", "peak N", "impulse N s", "0.04426")) {
        assert_shows_at(&ex, 80, 24, *c);
    }
    press(&ex, "b");
    assert_shows_at(&ex, 80, 24, "drops it)");
    press(&ex, "c");
    assert_shows_at(&ex, 80, 24, "first pulse peak [N]");
    assert_shows_at(&ex, 40, 12, "now as opened      change");
    press(&ex, "<Esc>:set motor.voltage 0.5");
    assert_shows_at(&ex, 40, 12, ":set motor.voltage 0.5");
    // a long prompt shows its end
    press(&ex, "<C-u>set control.plugin /a/long/name/of/a/folder/and/then/a/file.so");
    assert_shows_at(&ex, 40, 12, "then/a/file.so");
}

TEST(test_a_narrow_screen_reaches_the_side)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    assert_shows_at(&ex, 60, 20, "\u25b81      N");
    press(&ex, "<Tab>");
    assert_shows_at(&ex, 60, 20, "knobs (/ all");
    press(&ex, "<Tab>");
    assert_shows_at(&ex, 60, 20, "parameters (Tab");
    press(&ex, "<Tab>");
    assert_shows_at(&ex, 60, 20, "hub_angle");
    press(&ex, "<Tab>");
    assert_shows_at(&ex, 60, 20, "statistics");
    press(&ex, "<Tab>");
    assert_shows_at(&ex, 60, 20, "\u25b81      N");
    // too many panes for the rows: the one in focus is there
    press(&ex, ":panes 123456789<Enter>ww");
    assert_shows_at(&ex, 60, 20, "\u25b83  rad/s");
}

TEST(test_poles_follow_the_values_at_the_cursor)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":poles<Enter>");
    assert_shows_at(&ex, 40, 12, "poles (Esc closes)");
    assert_shows_at(&ex, 80, 40, "pressing on the wall, hub held by friction");
    KEPT_TEXT(before) = picture(&ex, 80, 40, GLYPHS_ASCII);
    press(&ex, "<Esc>:seek 0<Enter>:set wall.kind none<Enter>:poles<Enter>");
    assert_shows_at(&ex, 80, 40, "there is no wall to press on");
    press(&ex, "<Esc>u:poles<Enter>");
    KEPT_TEXT(again) = picture(&ex, 80, 40, GLYPHS_ASCII);
    fail_if(strstr(again, "there is no wall") != NULL, "taken back, and still shown:\n%s",
            again);
    fail_if(strstr(before, "damping") == NULL, "no numbers:\n%s", before);
    press(&ex, "<Esc>:model<Enter>:poles<Enter>");
    assert_shows_at(&ex, 80, 40, "printed");
}

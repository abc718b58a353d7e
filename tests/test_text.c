// Texts of figures: letters, words and lines.
#include "tests/plot_fixture.h"

// comes first: fontconfig reads its configuration once
TEST(missing_font_is_reported)
{
    pid_t child = fork();
    if (child == 0) {
        const char *whole = formatted("%s/fonts.conf", test_folder);
        put_file(whole, "<fontconfig><dir>/nowhere</dir></fontconfig>");
        setenv("FONTCONFIG_FILE", whole, 1);
        fault f = {0};
        double x[] = {0, 1};
        figure_series series = {.x = x, .y = x, .count = 2, .label = "a<sub>1</sub>"};
        figure_panel panel = {.series = &series, .series_count = 1};
        figure fig = {.panels = &panel, .panel_count = 1};
        status code = figure_write(&fig, "no-font.png", &f);
        bool named = strstr(f.text, "fonts-dejavu-core") != NULL;
        bool nothing_written = access("no-font.png", F_OK) != 0;
        _exit(code == STATUS_CANNOT_READ && named && nothing_written ? 0 : 1);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFEXITED(result));
    assert_int_equal(WEXITSTATUS(result), 0);
}

TEST(indices_are_small_and_scale_with_the_letters)
{
    PangoContext *context = text_context_create();
    double plain = text_measure(context, &(text_block){"x111", 12}).width;
    double lowered = text_measure(context, &(text_block){"x<sub>111</sub>", 12}).width;
    double twice = text_measure(context, &(text_block){"x<sub>111</sub>", 24}).width;
    double narrow = text_measure(context, &(text_block){"x", 12}).width;
    check_close(lowered - narrow, 0.7 * (plain - narrow), 0.1);
    check_close(twice, 2 * lowered, 0.1);
    g_object_unref(context);
}

TEST(markup_that_is_none_is_shown_as_it_stands)
{
    PangoContext *context = text_context_create();
    PangoLayout *layout =
        text_layout_create(context, &(text_block){.markup = "a < b & c", .size = 8});
    assert_string_equal(pango_layout_get_text(layout), "a < b & c");
    g_object_unref(layout);
    layout = text_layout_create(context, &(text_block){.markup = "\xff\xfe", .size = 8});
    assert_true(g_utf8_validate(pango_layout_get_text(layout), -1, NULL));
    g_object_unref(layout);
    g_object_unref(context);
}

// Units as the SI brochure has them, quantities of three digits, apostrophes.
TEST(words_are_set_as_printers_set_them)
{
    static const struct {
        char kind;
        const char *plain, *set;
    } cases[] = {{'u', "rad/s2", "rad/s\u00b2"},
                 {'u', "kg m2", "kg\u00b7m\u00b2"},
                 {'u', "N m", "N\u00b7m"},
                 {'u', "N m/rad", "N\u00b7m/rad"},
                 {'u', "s-1", "s\u207b\u00b9"},
                 {'u', "", ""},
                 {'q', "5.4", "5.40\u2009N"},
                 {'q', "1.752", "1.75\u2009N"},
                 {'q', "123", "123\u2009N"},
                 {'q', "-0.5", "\u22120.500\u2009N"},
                 {'t', "Newmark's", "Newmark\u2019s"},
                 {'t', "Newmark&apos;s", "Newmark\u2019s"},
                 {'t', "Newmark&#39;s", "Newmark\u2019s"},
                 {'t', "named 'a'", "named 'a'"}};
    for (EACH(c, cases)) {
        g_autofree char *shown = c->kind == 'u'   ? text_unit(c->plain)
                                 : c->kind == 'q' ? text_quantity(atof(c->plain), 3, "N")
                                                  : text_translate(c->plain, 8);
        assert_string_equal(shown, c->set);
    }
}

// However narrow the page, no line begins with what belongs to the end of the one before.
TEST(numbers_keep_their_units)
{
    const char *caption =
        "At 1 V and 10 ms, <i>β</i> = 0.4, <i>h</i> = 10\u2009ms, a peak of "
        "5.40\u2009N after 12.5 ms, <i>k</i><sub>1</sub> = 0.4 at "
        "4.92\u2009N·m/rad, 3\u2009V·s/rad. impactlab 0.1.0.";
    PangoContext *context = text_context_create();
    for (double width = 60; width < 300; width += 7) {
        PangoLayout *layout = text_layout_create(context, &(text_block){.markup = caption,
                                                                        .size = 8,
                                                                        .width = width});
        const char *text = pango_layout_get_text(layout);
        for (int i = 1; i < pango_layout_get_line_count(layout); i++) {
            const char *line = text + pango_layout_line_get_start_index(
                                          pango_layout_get_line_readonly(layout, i));
            for (EACH_TEXT(c, "V", "ms", "= ", "=\u00a0", "rad", "0.4", "N", "0.1.0",
                           "10 ms,")) {
                fail_if(strncmp(line, *c, strlen(*c)) == 0,
                        "at %g points a line begins with '%.12s'", width, line);
            }
        }
        g_object_unref(layout);
    }
    g_object_unref(context);
}

// Symbols of parameters in figures.
TEST(symbols_are_italic_and_indices_upright)
{
    g_autofree char *stiffness = text_symbol("k_2"), *voltage = text_symbol("v");
    assert_string_equal(stiffness, "<i>k</i><sub>2</sub>");
    assert_string_equal(voltage, "<i>v</i>");
}

// A title of two lines ends with more than a word, and lines are as far apart with an
// exponent in one of them as without.
TEST(lines_are_even)
{
    PangoContext *context = text_context_create();
    double widths[2];
    text_block title = {.markup = "Optical encoder under a constant 1 V",
                        .size = 9,
                        .width = 166,
                        .balanced = true};
    PangoLayout *layout = text_layout_create(context, &title);
    assert_int_equal(pango_layout_get_line_count(layout), 2);
    for (int i = 0; i < 2; i++) {
        PangoRectangle logical;
        pango_layout_line_get_extents(pango_layout_get_line_readonly(layout, i), NULL,
                                      &logical);
        widths[i] = logical.width;
    }
    check_close(widths[1] / widths[0], 1, 0.35);
    g_object_unref(layout);

    double plain = text_measure(context, &(text_block){"one\ntwo\nthree", 8}).height;
    double raised =
        text_measure(context, &(text_block){"one\n10<sup>−5</sup>\nthree", 8}).height;
    check_close(raised, plain, 0.01);
    g_object_unref(context);
}

ALL_BETWEEN(enter_folder, leave_plot_folder)

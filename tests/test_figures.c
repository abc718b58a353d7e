// The catalogue of figures and tables, judged by what is drawn: texts and where they are,
// numbers next to them, bytes of files.
#include "tests/plot_fixture.h"

#include "render/figures/figures.h"

// But those that take long: test_figure_legibility looks at them, and at all in a column
// of 85 mm.
TEST(every_figure_is_tidy)
{
    for (int i = 0; i < thesis_figure_count(); i++) {
        static figure_report r;
        const thesis_figure *which = thesis_figure_at(i);
        assert_ptr_equal(thesis_figure_find(which->id), which);
        if (!which->slow) {
            SCOPED(artwork_finish)
            artwork drawn = open_figure(which->id, (figure_options){0});
            expect_tidy_page(&drawn, &r);
            assert_true(r.text_count >= 3);
        }
    }
}

static void expect_texts(const char *id, const char *const *texts)
{
    static figure_report r;
    SCOPED(artwork_finish) artwork drawn = open_figure(id, (figure_options){0});
    record_page(&drawn, &r);
    for (; *texts != NULL; texts++) {
        bool found = false;
        for (int i = 0; i < r.text_count; i++) {
            found = found || strstr(r.texts[i].text, *texts) != NULL;
        }
        fail_if(!found, "%s: '%s' is not drawn", id, *texts);
    }
}

TEST(figures_say_what_they_show)
{
    expect_texts("2.1",
                 (const char *[]){"Fig. 2.1", "40\u2009kΩ", "FSR", "(V)", "(N)", NULL});
    expect_texts("4.3", (const char *[]){"0.0443", "T = 70.0\u2009ms",
                                         "fmax = 1.34\u2009N", NULL});
    expect_texts("4.2",
                 (const char *[]){"impulse 0.0443\u2009N·s", "0.743\u2009m/s", NULL});
    expect_texts("5.5", (const char *[]){"impact mode", "force mode", "(V)", NULL});
    expect_texts("T2.1", (const char *[]){"2.443\u2009V·s/rad", "33.6\u2009Ω", NULL});
    expect_texts("T4.3", (const char *[]){"2.04", "7.43", "4.92\u2009N·m/rad", NULL});
}

// One legend speaks for both panels of 4.4 and 4.5: both have its colours.
TEST(the_predictors_figures_have_the_legends_colours)
{
    for (EACH_TEXT(c, "4.4", "4.5")) {
        SCOPED(artwork_finish) artwork drawn = open_figure(*c, (figure_options){0});
        for (int p = 0; p < 2; p++) {
            for (int i = 0; i < 2; i++) {
                assert_int_equal(drawn.plotted->panels[p].series[i].colour,
                                 drawn.plotted->panels[0].series[i].colour);
            }
        }
    }
}

// The number in the column `column` of the line that begins with `start`; fails if there
// is none.
static double number_in_csv(const char *csv, const char *start, int column)
{
    const char *line = strstr(csv, start);
    fail_if(line == NULL, "no line begins with '%s'", start);
    for (int i = 0; i < column; i++) {
        line = strchr(line, ',');
        assert_non_null(line);
        line++;
    }
    return *line == ',' || *line == '\n' ? (double)NAN : atof(line);
}

// The figure without options.
static status draw_plain(const char *id, const char *into, const char *formats, fault *f)
{
    return figure_draw(id, &(figure_options){0}, into, formats, NULL, f);
}

static char *csv_of(const char *id)
{
    fault f = {0};
    const thesis_figure *which = thesis_figure_find(id);
    fail_if(draw_plain(id, "csv", "svg", &f) != STATUS_OK, "%s: %s", id, f.text);
    return file_text(formatted("csv/%s.csv", which->file));
}

TEST(recorded_signals_stand_beside_their_picture)
{
    KEPT_TEXT(csv) = csv_of("3.4");
    assert_non_null(strstr(csv, ",force,"));
    assert_non_null(strstr(csv, ",force corrected,"));
    assert_non_null(strstr(csv, "mark,contact,"));
    free(csv);
    csv = csv_of("5.4");
    assert_non_null(strstr(csv, ",calculated_force,"));
    assert_null(strstr(csv, "corrected"));
    assert_non_null(strstr(csv, "mark,force mode,"));
}

static status overlaid(const char *csv, const char *id, fault *f)
{
    put_file("measured.csv", csv);
    const figure_options o = {.overlay = "measured.csv"};
    return figure_draw(id, &o, "overlaid", "svg", NULL, f);
}

TEST(reference_data_lie_over_signals)
{
    const char *good =
        "time[s],force [N],remark\n0.35,1.5,first\r\n0.4,,missing\n\n0.45,0.25,\n";
    DONE(overlaid(good, "3.4", &f));
    assert_true(file_has("overlaid/fig-3-4.csv", ",force measured.csv,0.35,1.5\n"));
    assert_true(file_has("overlaid/fig-3-4.csv", ",force measured.csv,0.45,0.25\n"));
    // panels that the data do not speak of stay as they are
    DONE(overlaid(good, "3.2", &f));
    assert_false(file_has("overlaid/fig-3-2.csv", "measured.csv"));
    REFUSED(STATUS_BAD_ARGUMENT, "measured.csv:2:2: 'x1'",
            overlaid("time[s],force[N]\n0.3,x1\n", "3.4", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "no column 'time'",
            overlaid("force[N]\n1\n", "3.4", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "", overlaid("", "3.4", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "", overlaid(good, "4.1", &f));
    const figure_options missing = {.overlay = "/nowhere/data.csv"};
    REFUSED(STATUS_CANNOT_READ, "/nowhere/data.csv",
            figure_draw("3.4", &missing, test_folder, "svg", NULL, &f));
}

// The error of one cell of the map; NaN where the run was stopped.
static double map_error(const char *csv, const char *step, double beta, double gamma)
{
    double nearest = HUGE_VAL, error = (double)NAN;
    const char *start = formatted("h = %s\u2009ms,map,", step);
    for (const char *line = strstr(csv, start); line != NULL;
         line = strstr(line + 1, start)) {
        double b = number_in_csv(line, start, 2), g = number_in_csv(line, start, 3);
        double distance = hypot(b - beta, g - gamma);
        if (distance < nearest) {
            nearest = distance;
            error = number_in_csv(line, start, 4);
        }
    }
    check_below(nearest, 0.02);
    return error;
}

TEST(the_map_tells_good_pairs_from_bad)
{
    KEPT_TEXT(csv) = csv_of("beta-gamma");
    // the thesis's pair at its step, and the same at a fifth of the step
    double at_1_ms = map_error(csv, "1", 0.4, 0.5);
    check_below(at_1_ms, 0.1);
    check_below(map_error(csv, "0.2", 0.4, 0.5), at_1_ms);
    // first order beside gamma = 1/2
    check_below(2 * at_1_ms, map_error(csv, "1", 0.4, 0.9));
    // below a quarter contact is unstable for any gamma: stopped, or far from the force
    double low = map_error(csv, "0.2", 0.1, 0.5), high = map_error(csv, "0.2", 0.1, 0.9);
    assert_true(isnan(low) || low > 10);
    assert_true(isnan(high) || high > 10);
}

TEST(table_cells_are_right)
{
    KEPT_TEXT(csv) = csv_of("T4.1");
    const char *group = "Peak force by the energy principle (N),thesis";
    check_close(number_in_csv(csv, group, 2), 23.93, 0);
    check_close(number_in_csv(csv, group, 5), 82.92, 0);
    group = "Peak force by the energy principle (N),printed model";
    check_close(number_in_csv(csv, group, 2), 23.93, 0.5);
    free(csv);
    // what the stability table allows to the arm's 986 Hz mode (impactlab modes)
    csv = csv_of("T3.1");
    const char *row = strstr(csv, "linear acceleration");
    assert_non_null(row);
    assert_non_null(strstr(row, "0.559\u2009ms"));
}

// ---- files

TEST(a_second_run_writes_the_same_bytes)
{
    static const char *const ids[] = {"2.3", "4.2", "4.6", "5.7", "T4.2"};
    static const char *const folders[] = {"once", "twice"};
    for (int pass = 0; pass < 2; pass++) {
        // in another order, so that nothing drawn before shows
        for (int i = 0; i < 5; i++) {
            const char *id = ids[pass == 0 ? i : 4 - i];
            DONE(draw_plain(id, folders[pass], "png,pdf,svg", &f));
        }
    }
    for (int i = 0; i < 5; i++) {
        for (EACH_TEXT(c, "png", "pdf", "svg", "csv")) {
            const char *file = thesis_figure_find(ids[i])->file;
            expect_same_bytes(formatted("once/%s.%s", file, *c),
                              formatted("twice/%s.%s", file, *c));
        }
    }
}

TEST(themes_change_the_page)
{
    for (EACH_TEXT(c, "3.4", "4.1", "T2.1")) {
        for (figure_theme theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
            SCOPED(artwork_finish)
            artwork drawn = open_figure(*c, (figure_options){.look.theme = theme});
            PIXELS(surface) = page_pixels(&drawn, 1, NULL);
            unsigned char corner = cairo_image_surface_get_data(surface)[4];
            assert_true(theme == THEME_DARK ? corner < 60 : corner > 250);
        }
    }
}

TEST(figures_are_asked_for_by_id)
{
    assert_null(thesis_figure_find("3.99"));
    assert_ptr_equal(thesis_figure_find("t4.1"), thesis_figure_find("T4.1"));
    assert_ptr_equal(thesis_figure_find("fig-3-4"), thesis_figure_find("3.4"));
    REFUSED(STATUS_BAD_ARGUMENT, "3.99", draw_plain("3.99", test_folder, "png", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "gif", draw_plain("3.4", test_folder, "png,gif", &f));
    REFUSED(STATUS_CANNOT_WRITE, "", draw_plain("3.4", "a/b/c", "png", &f));
}

// ---- the report

TEST(the_report_stands_alone)
{
    DONE(report_write("report", &(report_request){0}, NULL, &f));
    KEPT_TEXT(html) = file_text("report/report.html");
    for (const char *at = strstr(html, "src="); at != NULL; at = strstr(at + 1, "src=")) {
        assert_int_equal(strncmp(at, "src=\"data:image/png;base64,", 27), 0);
    }
    assert_true(strlen(html) < 3000000);
    assert_non_null(strstr(html, "aria-label=\"Fig. 3.4"));
    assert_null(strstr(html, "href=\"http"));
    assert_null(strstr(html, "@import"));
    for (int i = 0; i < thesis_figure_count(); i++) {
        const char *again =
            formatted("<code>impactlab figures %s</code>", thesis_figure_at(i)->id);
        fail_if(strstr(html, again) == NULL, "%s is not in the report",
                thesis_figure_at(i)->id);
    }
    assert_non_null(strstr(html, "82.92"));
    assert_non_null(strstr(html, "motor.torque_constant"));
    // glyphs of different figures have names of their own
    const char *first = strstr(html, " id=\"i0-");
    assert_non_null(first);
    assert_non_null(strstr(html, " id=\"i1-"));
    for (EACH_TEXT(c, "%PDF-", "/Outlines", "/Annots")) {
        assert_true(file_has("report/report.pdf", *c));
    }
    assert_false(file_has("report/report.pdf", "/Type3"));
}

TEST(a_live_report_holds_the_page_and_what_it_opens)
{
    char first_impact[] = "corrected/first-impact";
    char *const names[] = {first_impact};
    report_request what = {names, 1, "no-page.html"};
    REFUSED(STATUS_CANNOT_READ, "ninja -C build web",
            report_write("live", &what, NULL, &f));

    // "<p>the page</p>" in base64
    put_file("page.html", "<p>the page</p>");
    what.page = "page.html";
    DONE(report_write("live", &what, NULL, &f));
    KEPT_TEXT(html) = file_text("live/report.html");
    assert_non_null(strstr(html, "id=\"lab\">PHA+dGhlIHBhZ2U8L3A+<"));
    assert_non_null(
        strstr(html, "data-live=\"scenario=corrected/first-impact&amp;text="));
    assert_non_null(strstr(html, "<svg"));
}

TEST(a_report_without_a_folder_is_complained_about)
{
    REFUSED(STATUS_CANNOT_WRITE, "/proc/nowhere",
            report_write("/proc/nowhere", &(report_request){0}, NULL, &f));
}

// --- what follows the thesis: captions, axes and numbers, by equations that the drawing
// does not use

static void expect_in_caption(const char *id, const char *part)
{
    SCOPED(artwork_finish) artwork drawn = open_figure(id, (figure_options){0});
    g_autofree char *caption = text_plain(drawn.caption);
    fail_if(strstr(caption, part) == NULL, "%s: '%s' is not in '%s'", id, part, caption);
}

// The number in the second column of the line that begins with a quantity.
static double value_in(const char *csv, const char *quantity)
{
    return number_behind(csv, formatted("\n%s,", quantity));
}

TEST(captions_name_the_constants_of_the_printed_model)
{
    expect_in_caption("3.2", "k1 = 90");
    expect_in_caption("3.10", "1.67·10");
    expect_in_caption("2.2", "k1 = 90");
    expect_in_caption("4.1", "90");
}

TEST(captions_say_whose_shading_it_is)
{
    expect_in_caption("3.4", "of the first run (printed)");
    for (int i = 1; i <= 7; i++) {
        expect_in_caption(formatted("5.%d", i), "Shaded: impact mode");
    }
}

// Simulation and bench stand over the same seconds.
TEST(chapters_2_and_3_have_one_time_axis)
{
    for (EACH_TEXT(c, "2.4", "2.5", "2.6", "3.2")) {
        static figure_report r;
        SCOPED(artwork_finish) artwork drawn = open_figure(*c, (figure_options){0});
        record_page(&drawn, &r);

        // the last tick stands at the panel's right end
        bool found = false;
        for (int k = 0; k < r.text_count; k++) {
            figure_rect p = r.texts[k].place;
            found = found ||
                    (strcmp(r.texts[k].text, "1.0") == 0 &&
                     fabs(p.x + p.width / 2 - r.panels[0].x - r.panels[0].width) < 0.6);
        }
        fail_if(!found, "%s: its time axis does not end at 1.0 s", *c);
    }
}

TEST(the_printed_peak_is_a_point)
{
    KEPT_TEXT(csv) = csv_of("3.4");
    const char *row = strstr(csv, ",Table 4.3,");
    assert_non_null(row);
    assert_non_null(strstr(row, ",1.84"));
    expect_in_caption("3.10", "5.22");
}

// The cut body: the hinge's torque about the centre is the moment of its impulse, a
// relation of (4.3) and (4.4) that the drawing does not use; and the wall stops the point
// of collision.
TEST(the_cut_body_is_in_balance)
{
    KEPT_TEXT(csv) = csv_of("4.2");
    double half = 0.25, torque = value_in(csv, "hinge torque impulse Y");
    check_relative(torque, -half * value_in(csv, "hinge impulse X"), 1e-9);
    check_relative(value_in(csv, "jump of the point of collision's velocity"),
                   -value_in(csv, "approach speed"), 1e-6);
}

// Both states of 3.1 lie on the constraint (3.9).
TEST(the_last_link_goes_through_the_contact_point)
{
    KEPT_TEXT(csv) = csv_of("3.1");
    check_close(value_in(csv, "constraint (3.9)"), 0, 1e-9);
    check_relative(value_in(csv, "b") / value_in(csv, "a"), tan(0.1), 1e-12);
}

TEST(the_algorithm_has_the_thesis_numbers)
{
    KEPT_TEXT(csv) = csv_of("T3.2");
    const char *at = csv;
    for (EACH_TEXT(c, "1", "2", "2.1", "2.2", "3", "3.1", "3.2", "4")) {
        at = strstr(at, formatted("\n%s,", *c));
        assert_non_null(at);
        at++;
    }
}

// What the thesis prints stands where it prints it, what is computed beside it, and the
// residual is their difference.
TEST(printed_values_have_residuals)
{
    KEPT_TEXT(csv) = csv_of("forces");
    double printed = number_behind(csv, "force k2 x 100[N],max_force_energy printed,1,");
    double computed = number_behind(csv, "force k2 x 100[N],max_force_energy,1,");
    check_close(printed, 23.93, 0);
    check_close(computed, 23.93, 0.5);
    check_relative(number_behind(csv, "residual k2 x 100[%],max_force_energy printed,1,"),
                   100 * (computed / printed - 1), 1e-9);
    check_close(number_behind(csv, "force k2 x 1[N],max_force_simulation printed,10,"),
                7.43, 0);
    free(csv);
    csv = csv_of("delays");
    check_close(number_behind(csv, "delay k2 x 1[ms],delay_dynamics printed,10,"), 109,
                1e-9);
}

// Section 3.1.3: with one run of the algorithm no pair gives a usable force, with two the
// thesis's does.
TEST(the_printed_arm_needs_its_second_run)
{
    static const char *const starts[] = {"\"two runs, h = 1\u2009ms\",map,",
                                         "\"one run, 1\u2009ms\",map,",
                                         "\"one run, 0.2\u2009ms\",map,"};
    KEPT_TEXT(csv) = csv_of("beta-gamma-printed");
    double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, thesis = HUGE_VAL;
    int cells = 0;
    for (int panel = 0; panel < 3; panel++) {
        for (const char *line = strstr(csv, starts[panel]); line != NULL;
             line = strstr(line + 1, starts[panel])) {
            char *end;
            double beta = strtod(line + strlen(starts[panel]), &end);
            double gamma = strtod(end + 1, &end);
            double force = end[1] == '\n' ? HUGE_VAL : strtod(end + 1, NULL);
            least[panel] = fmin(least[panel], force);
            cells++;
            if (panel == 0 && fabs(beta - 0.4) < 0.02 && fabs(gamma - 0.5) < 0.03) {
                thesis = force;
            }
        }
    }
    assert_int_equal(cells, 900);
    check_close(thesis, 1, 0.1);
    check_below(5, least[1]);
    check_below(2 * least[1], least[2]);
}

ALL_BETWEEN(enter_folder, leave_plot_folder)

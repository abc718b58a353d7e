// Figures that follow the thesis: differences stated in their captions, their axes, and the numbers
// of their diagrams against equations that the drawing does not use.
#include "tests/check.h"

#include <cairo.h>

#include "render/figures/figures.h"
#include "render/page/text.h"

static artwork open_figure(const char *id)
{
    fault f = {0};
    artwork drawn;
    const figure_options as_it_comes = {0};
    const thesis_figure *which = thesis_figure_find(id);
    assert_non_null(which);
    fail_if(figure_open(which, &as_it_comes, &drawn, &f) != STATUS_OK, "%s: %s", id, f.text);
    return drawn;
}

static char *caption_of(const char *id)
{
    SCOPED(artwork_finish) artwork drawn = open_figure(id);
    char *plain = text_plain(drawn.caption);
    return plain;
}

static void expect_in_caption(const char *id, const char *part)
{
    char *caption = caption_of(id);
    fail_if(strstr(caption, part) == NULL, "%s: '%s' is not in '%s'", id, part, caption);
    g_free(caption);
}

// The CSV of a figure.
static char *csv_of(const char *id)
{
    fault f = {0};
    char path[] = "/tmp/impactlab-fidelity-XXXXXX", *text = NULL;
    int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    artwork drawn = open_figure(id);
    fail_if(drawn.write_csv(drawn.what, path, &f) != STATUS_OK, "%s: %s", id, f.text);
    artwork_finish(&drawn);
    assert_true(g_file_get_contents(path, &text, NULL, NULL));
    unlink(path);
    return text;
}

// The number in the second column of the line that begins with a quantity.
static double value_in(const char *csv, const char *quantity)
{
    char start[80];
    snprintf(start, sizeof start, "\n%s,", quantity);
    const char *line = strstr(csv, start);
    fail_if(line == NULL, "no line begins with '%s'", quantity);
    return atof(line + strlen(start));
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
        char id[4] = {'5', '.', (char)('0' + i), '\0'};
        expect_in_caption(id, "Shaded: impact mode");
    }
}

// Simulation and bench stand over the same seconds.
TEST(chapters_2_and_3_have_one_time_axis)
{
    static const char *const ids[] = {"2.4", "2.5", "2.6", "3.2"};
    for (size_t i = 0; i < G_N_ELEMENTS(ids); i++) {
        static figure_report r;
        artwork drawn = open_figure(ids[i]);
        cairo_surface_t *surface = cairo_recording_surface_create(CAIRO_CONTENT_COLOR, NULL);
        cairo_t *cr = cairo_create(surface);
        DONE(drawn.paint(cr, drawn.what, &r, &f));
        cairo_destroy(cr);
        cairo_surface_destroy(surface);
        artwork_finish(&drawn);

        // the last tick stands at the panel's right end
        bool found = false;
        for (int k = 0; k < r.text_count; k++) {
            figure_rect p = r.texts[k].place;
            found = found || (strcmp(r.texts[k].text, "1.0") == 0 &&
                              fabs(p.x + p.width / 2 - r.panels[0].x - r.panels[0].width) < 0.6);
        }
        fail_if(!found, "%s: its time axis does not end at 1.0 s", ids[i]);
    }
}

TEST(the_printed_peak_is_a_point)
{
    char *csv = csv_of("3.4");
    const char *row = strstr(csv, ",Table 4.3,");
    assert_non_null(row);
    assert_non_null(strstr(row, ",1.84"));
    g_free(csv);
    expect_in_caption("3.10", "5.22");
}

// The cut body: the hinge's torque about the centre is the moment of its impulse, a relation of
// (4.3) and (4.4) that the drawing does not use; and the wall stops the point of collision.
TEST(the_cut_body_is_in_balance)
{
    char *csv = csv_of("4.2");
    double half = 0.25, torque = value_in(csv, "hinge torque impulse Y");
    check_relative(torque, -half * value_in(csv, "hinge impulse X"), 1e-9);
    check_relative(value_in(csv, "jump of the point of collision's velocity"),
                   -value_in(csv, "approach speed"), 1e-6);
    g_free(csv);
}

// Both states of 3.1 lie on the constraint (3.9).
TEST(the_last_link_goes_through_the_contact_point)
{
    char *csv = csv_of("3.1");
    check_close(value_in(csv, "constraint (3.9)"), 0, 1e-9);
    check_relative(value_in(csv, "b") / value_in(csv, "a"), tan(0.1), 1e-12);
    g_free(csv);
}

TEST(the_algorithm_has_the_thesis_numbers)
{
    static const char *const numbers[] = {"1", "2", "2.1", "2.2", "3", "3.1", "3.2", "4"};
    char *csv = csv_of("T3.2");
    const char *at = csv;
    for (size_t i = 0; i < G_N_ELEMENTS(numbers); i++) {
        char start[8];
        snprintf(start, sizeof start, "\n%s,", numbers[i]);
        at = strstr(at, start);
        assert_non_null(at);
        at++;
    }
    g_free(csv);
}

// The number in the fourth column of the line that begins with the others.
static double point_in(const char *csv, const char *start)
{
    const char *line = strstr(csv, start);
    fail_if(line == NULL, "no line begins with '%s'", start);
    return atof(line + strlen(start));
}

// What the thesis prints stands where it prints it, what is computed beside it, and the residual is
// their difference.
TEST(printed_values_have_residuals)
{
    char *csv = csv_of("forces");
    double printed = point_in(csv, "force k2 x 100[N],max_force_energy printed,1,");
    double computed = point_in(csv, "force k2 x 100[N],max_force_energy,1,");
    check_close(printed, 23.93, 0);
    check_close(computed, 23.93, 0.5);
    check_relative(point_in(csv, "residual k2 x 100[%],max_force_energy printed,1,"),
                   100 * (computed / printed - 1), 1e-9);
    check_close(point_in(csv, "force k2 x 1[N],max_force_simulation printed,10,"), 7.43, 0);
    g_free(csv);
    csv = csv_of("delays");
    check_close(point_in(csv, "delay k2 x 1[ms],delay_dynamics printed,10,"), 109, 1e-9);
    g_free(csv);
}

// Section 3.1.3: with one run of the algorithm no pair gives a usable force, with two the thesis's
// does.
TEST(the_printed_arm_needs_its_second_run)
{
    static const char *const starts[] = {"\"two runs, h = 1\u2009ms\",map,",
                                         "\"one run, 1\u2009ms\",map,",
                                         "\"one run, 0.2\u2009ms\",map,"};
    char *csv = csv_of("beta-gamma-printed");
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
    g_free(csv);
}

int main(void)
{
    int failed = run_cases(NULL, NULL);
    text_release();
    return failed != 0;
}

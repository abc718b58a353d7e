// Pictures for publications: sizes of letters, the files of a bare picture, LaTeX.
#include "tests/plot_fixture.h"

#include "render/figures/figures.h"
#include "render/figures/artwork.h"
#include "render/figures/recipe.h"
#include "render/figures/run_figure.h"

TEST(bare_pages_have_no_title_and_no_caption)
{
    static figure_report r;
    for (EACH_TEXT(c, "2.2", "3.4", "4.3", "T3.1")) {
        figure_options dressed = {.look.width = 120}, bare = {.look = {.width = 120, .bare = true}};
        SCOPED(artwork_finish)
        artwork a = open_figure(*c, dressed), b = open_figure(*c, bare);
        check_below(b.height, a.height - 12);
        record_page(&b, &r);
        char *start = g_strndup(b.title, 12);
        for (int t = 0; t < r.text_count; t++) {
            assert_null(strstr(r.texts[t].text, start));
        }
        g_free(start);
    }
}

// A figure of one curve, written as the options ask.
static void publish(const figure_options *o, const char *path)
{
    static const double x[] = {0, 1, 2}, y[] = {1, 3, 2};
    const figure_series series = {.name = "run", .x = x, .y = y, .count = 3};
    const figure_panel panel = {.y = {.name = "force", .label = "Force <i>f</i>", .unit = "N"},
                                .series = &series,
                                .series_count = 1};
    const figure fig = {.title = "A title & more",
                        .caption = "With <i>β</i> = 0.4, 5 % off, <i>θ</i><sub>1</sub>",
                        .x = {.name = "time", .label = "Time", .unit = "s"},
                        .panels = &panel,
                        .panel_count = 1};
    DONE(figure_publish(&fig, o, path, true, &f));
}

TEST(a_bare_picture_has_its_caption_beside_it)
{
    size_t length;
    publish(&(figure_options){.look.bare = true}, "bare.svg");
    char *text = read_file("bare.txt", &length);
    assert_string_equal(text, "A title & more\n\nWith β = 0.4, 5 % off, θ1\n");
    free(text);
    publish(&(figure_options){0}, "dressed.svg");
    assert_int_not_equal(access("dressed.txt", F_OK), 0);
}

TEST(latex_sets_the_figure)
{
    size_t length;
    char *tex = g_strdup("paper.tex");
    publish(&(figure_options){.look.width = 85, .latex = tex}, "force.pdf");
    char *text = read_file(tex, &length);
    assert_non_null(strstr(text, "\\begin{figure}\n"));
    assert_non_null(strstr(text, "width=85mm,alt={A title \\& more. 1 panel over Time in s: Force "
                                 "f in N.}]{force.pdf}"));
    assert_non_null(strstr(text, "\\caption{A title \\& more. With \\textit{$\\beta$} = 0.4, 5 \\% "
                                 "off, \\textit{$\\theta$}\\textsubscript{1}}"));
    assert_non_null(strstr(text, "\\label{fig:force}"));
    // every brace that opens closes
    int depth = 0;
    for (const char *c = text; *c != '\0'; c++) {
        bool escaped = c > text && c[-1] == '\\';
        depth += escaped ? 0 : *c == '{' ? 1 : *c == '}' ? -1 : 0;
        assert_true(depth >= 0);
    }
    assert_int_equal(depth, 0);
    free(text);
    g_free(tex);
}

TEST(files_know_the_command_and_tell_what_they_show)
{
    size_t length;
    const figure_options o = {.command = "impactlab run x --set arm.k2=3"};
    publish(&o, "m.svg");
    char *svg = read_file("m.svg", &length);
    assert_non_null(strstr(svg, "<dc:source>impactlab run x --set arm.k2=3</dc:source>"));
    assert_non_null(strstr(svg, "<desc>A title &amp; more. 1 panel over Time in s"));
    free(svg);
    publish(&o, "m.png");
    SCOPED(free_kept) char *png = read_file("m.png", &length);
    assert_non_null(memmem(png, length, "impactlab run x --set arm.k2=3", 30));
}

TEST(a_transparent_picture_has_no_ground)
{
    publish(&(figure_options){.look.transparent = true}, "clear.png");
    cairo_surface_t *surface = cairo_image_surface_create_from_png("clear.png");
    assert_int_equal(cairo_image_surface_get_format(surface), CAIRO_FORMAT_ARGB32);
    assert_int_equal(cairo_image_surface_get_data(surface)[3], 0);
    cairo_surface_destroy(surface);
}

TEST(serif_pictures_have_serif_letters)
{
    size_t length;
    publish(&(figure_options){.look.font = "DejaVu Serif"}, "serif.pdf");
    char *pdf = read_file("serif.pdf", &length);
    assert_non_null(memmem(pdf, length, "DejaVuSerif", 11));
    assert_null(memmem(pdf, length, "DejaVuSans", 10));
    free(pdf);
    REFUSED(STATUS_BAD_ARGUMENT, "No Such Font", text_check_family("No Such Font", &f));
}

// ---- measured data over runs

TEST(measured_data_have_a_panel_of_residuals)
{
    static figure_report r;
    SCOPED(synthetic_finish) synthetic s;
    run_figure drawn;
    synthetic_init(&s, run_panels, RUN_PANELS);
    put_file("bench.csv", "time[s],cell[N]\n0.30,0\n0.325,2\n0.345,1.6\n");
    char *spec = g_strconcat("bench.csv", ":cell@0.02", NULL);
    const trace_run run = {&s.scenario, &s.result, "run"};
    const figure_options o = {.overlay = spec, .signals = "force,hub_angle+last_angle"};
    DONE(run_figure_init(&drawn, "t", NULL, 0, &run, 1, &o, &f));
    const figure *fig = &drawn.traces.plot.figure;
    record(fig, &r);
    expect_text(&r, "bench.csv: cell");
    expect_text(&r, "Residual (N)");
    // three panels: force with points, angles, residuals at the shifted times
    assert_int_equal(fig->panel_count, 3);
    const figure_series *residual = &fig->panels[2].series[0];
    assert_int_equal(residual->count, 3);
    check_close(residual->x[1], 0.345, 1e-12);
    check_close(residual->y[1], 2 - force_at(0.345), 1e-6);
    check_close(residual->y[2], 1.6 - force_at(0.365), 1e-6);
    run_figure_finish(&drawn);

    // what does not fit is said
    const figure_options unknown = {.signals = "forse"}, mixed = {.signals = "force+hub_angle"};
    REFUSED(STATUS_BAD_ARGUMENT, "did you mean 'force'",
            run_figure_init(&drawn, "t", NULL, 0, &run, 1, &unknown, &f));
    REFUSED(STATUS_BAD_ARGUMENT, "", run_figure_init(&drawn, "t", NULL, 0, &run, 1, &mixed, &f));
    g_free(spec);
}

// ---- recipes

static GString *heard;

static void listen(void *context, const char *sentence)
{
    (void)context;
    g_string_append_printf(heard, "%s\n", sentence);
}

static status open_recipe(const char *name, artwork *drawn, fault *f)
{
    const figure_options o = {0};
    heard = heard != NULL ? g_string_truncate(heard, 0) : g_string_new(NULL);
    return recipe_open(name, &o, listen, NULL, drawn, f);
}

// Every recipe that ships is drawn and tidy at a column's width.
TEST(shipped_recipes_are_drawn)
{
    static figure_report r;
    char *recipes = g_build_filename(getenv("IMPACTLAB_SCENARIOS"), "recipes", NULL);
    GDir *entries = g_dir_open(recipes, 0, NULL);
    assert_non_null(entries);
    const char *name;
    int drawn_recipes = 0;
    while ((name = g_dir_read_name(entries)) != NULL) {
        if (!g_str_has_suffix(name, ".yaml")) {
            continue;
        }
        drawn_recipes++;
        fault f = {0};
        artwork drawn;
        const figure_options o = {.look.width = 85};
        char *path = g_build_filename(recipes, name, NULL);
        heard = heard != NULL ? g_string_truncate(heard, 0) : g_string_new(NULL);
        fail_if(recipe_open(path, &o, listen, NULL, &drawn, &f) != STATUS_OK, "%s: %s%s", path,
                heard->str, f.text);
        expect_tidy_page(&drawn, &r);
        artwork_finish(&drawn);
        g_free(path);
    }
    assert_true(drawn_recipes >= 20);
    g_dir_close(entries);
    g_free(recipes);
}

// Small multiples are what the same runs give one by one.
TEST(multiples_are_runs_at_their_values)
{
    artwork drawn;
    size_t length;
    static figure_report r;
    put_file("many.yaml", "runs: [{name: arm, scenario: corrected/first-impact}]\n"
                          "multiples: {vary: motor.voltage, values: [1 V, 2 V]}\n"
                          "panels: [{signals: [force]}, {signals: [hub_angle]}]\n");
    DONE(open_recipe("many.yaml", &drawn, &f));
    record_page(&drawn, &r);
    assert_int_equal(r.panel_count, 4);
    DONE(artwork_write_csv(&drawn, "many.csv", &f));
    artwork_finish(&drawn);

    put_file("one.yaml", "runs: [{name: arm 2 V, scenario: corrected/first-impact, set: "
                         "{motor.voltage: 2}}]\npanels: [{signals: [force]}]\n");
    DONE(open_recipe("one.yaml", &drawn, &f));
    DONE(artwork_write_csv(&drawn, "one.csv", &f));
    artwork_finish(&drawn);

    // the same rows, for any other contents of the file
    SCOPED(free_kept) char *many = read_file("many.csv", &length);
    SCOPED(free_kept) char *one = read_file("one.csv", &length);
    const char *row = ",arm 2 V force,0.3,";
    const char *a = strstr(many, row), *b = strstr(one, row);
    assert_non_null(a);
    assert_non_null(b);
    check_close(atof(a + strlen(row)), atof(b + strlen(row)), 0);
    assert_true(atof(a + strlen(row)) > 1);
}

// A recipe of figure 3.4 shows the numbers that figure 3.4 does, and their difference.
TEST(a_recipe_shows_what_its_runs_give)
{
    artwork drawn;
    size_t length;
    char *path = g_strdup_printf("%s/recipes/fig-3-4.yaml", getenv("IMPACTLAB_SCENARIOS"));
    DONE(open_recipe(path, &drawn, &f));
    DONE(artwork_write_csv(&drawn, "recipe.csv", &f));
    artwork_finish(&drawn);
    g_free(path);
    DONE(figure_draw("3.4", &(figure_options){0}, "thesis", "svg", NULL, &f));
    SCOPED(free_kept) char *recipe = read_file("recipe.csv", &length);
    SCOPED(free_kept) char *thesis = read_file("thesis/fig-3-4.csv", &length);
    const char *const rows[][2] = {{"printed force,0.4,", ",force,0.4,"},
                                   {"corrected force,0.4,", ",force corrected,0.4,"}};
    double values[2];
    for (int i = 0; i < 2; i++) {
        const char *a = strstr(recipe, rows[i][0]), *b = strstr(thesis, rows[i][1]);
        assert_non_null(a);
        assert_non_null(b);
        values[i] = atof(a + strlen(rows[i][0]));
        check_close(values[i], atof(b + strlen(rows[i][1])), 0);
    }
    const char *difference = strstr(recipe, ",difference,0.4,");
    assert_non_null(difference);
    check_close(atof(difference + strlen(",difference,0.4,")), values[1] - values[0], 1e-12);
}

TEST(faults_of_recipes_have_their_places)
{
    static const struct {
        const char *text, *said;
    } cases[] = {
        {"panels: [{signals: [force]}]\n", ":1:1: there are no runs"},
        {"runs:\n  - scenario: thesis/fig-3-4\n", ":1:1: there are no panels"},
        {"runs: [{scenario: a}]\npanels: [{signals: [forse]}]\n",
         ":2:21: there is no signal 'forse', did you mean 'force'?"},
        {"runs: [{scenario: a, set: {arm.modle: x}}]\n",
         ":1:28: there is no parameter 'arm.modle', did you mean 'arm.model'?"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force], form: [a]}]\n",
         ":2:29: unknown key 'form' in a panel, did you mean 'from'?"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force], from: [b]}]\n",
         ":2:36: no run, data or table is named 'b'"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force, hub_angle]}]\n",
         ":2:28: 'hub_angle' has another unit than 'force'"},
        {"runs: [{scenario: a}, {scenario: a}]\n", ":1:23: the name 'a' is there twice"},
        {"runs: [{scenario: a}]\nx: {range: [1]}\n", ":2:12: range is a list, expected two"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force], notes: [{at: [0, 1]}]}]\n",
         ":2:37: a note needs 'text'"},
        {"runs: 3\n", ":1:7: runs is a single value, expected a list"},
        {"runs: [\n", ":2:1: "},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\nmultiples: {vary: motor.volts}\n",
         ":3:19: there is no parameter 'motor.volts', did you mean 'motor.voltage'?"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\nmultiples: {values: [1]}\n",
         ":3:12: multiples needs 'vary'"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\n"
         "multiples: {vary: arm.k2, values: [1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]}\n",
         ":3:75: there are more than 16 values"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        fault f = {0};
        artwork drawn;
        put_file("bad.yaml", cases[i].text);
        assert_int_equal(open_recipe("bad.yaml", &drawn, &f), STATUS_BAD_SCENARIO);
        char *expected = g_strconcat("bad.yaml", cases[i].said, NULL);
        fail_if(strstr(heard->str, expected) == NULL, "expected '%s', heard '%s'", expected,
                heard->str);
        g_free(expected);
    }

    // what is found out only when a run is opened has a place, too
    fault f = {0};
    artwork drawn;
    put_file("bad.yaml", "runs:\n  - scenario: no/such\npanels: [{signals: [force]}]\n");
    assert_true(open_recipe("bad.yaml", &drawn, &f) != STATUS_OK);
    assert_non_null(strstr(f.text, "bad.yaml:2:5: "));
}

ALL_BETWEEN(enter_folder, leave_plot_folder)

// Figures as files, for publications too: bytes, fonts, data, captions beside them,
// LaTeX, recipes.
#include "tests/plot_fixture.h"

#include "render/figures/figures.h"
#include "render/figures/artwork.h"

// ---- files

TEST(bare_pages_have_no_title_and_no_caption)
{
    static figure_report r;
    for (EACH_TEXT(c, "2.2", "3.4", "4.3", "T3.1")) {
        figure_options dressed = {.look.width = 120},
                       bare = {.look = {.width = 120, .bare = true}};
        SCOPED(artwork_finish)
        artwork a = open_figure(*c, dressed), b = open_figure(*c, bare);
        check_below(b.height, a.height - 12);
        record_page(&b, &r);
        for (int t = 0; t < r.text_count; t++) {
            assert_null(strstr(r.texts[t].text, formatted("%.12s", b.title)));
        }
    }
}

// A figure of one curve, written as the options ask.
static void publish(const figure_options *o, const char *path)
{
    static const double x[] = {0, 1, 2}, y[] = {1, 3, 2};
    const figure_series series = {.name = "run", .x = x, .y = y, .count = 3};
    const figure_panel panel = {.y = {.name = "force",
                                      .label = "Force <i>f</i>",
                                      .unit = "N"},
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
    publish(&(figure_options){.look.bare = true}, "bare.svg");
    assert_holds("bare.txt", "A title & more\n\nWith β = 0.4, 5 % off, θ1\n");
    publish(&(figure_options){0}, "dressed.svg");
    assert_int_not_equal(access("dressed.txt", F_OK), 0);
}

TEST(latex_sets_the_figure)
{
    publish(&(figure_options){.look.width = 85, .latex = "paper.tex"}, "force.pdf");
    KEPT_TEXT(text) = file_text("paper.tex");
    assert_non_null(strstr(text, "\\begin{figure}\n"));
    assert_non_null(
        strstr(text, "width=85mm,alt={A title \\& more. 1 panel over Time in s: Force "
                     "f in N.}]{force.pdf}"));
    assert_non_null(
        strstr(text, "\\caption{A title \\& more. With \\textit{$\\beta$} = 0.4, 5 \\% "
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
}

// \includegraphics reads PDF and PNG, no SVG.
TEST(latex_gets_a_picture_that_it_can_read)
{
    publish(&(figure_options){.look.width = 85, .latex = "drawn.tex"}, "drawn.svg");
    assert_true(file_has("drawn.tex", "{drawn.pdf}"));
    assert_true(file_has("drawn.pdf", "%PDF-"));
    publish(&(figure_options){.latex = "image.tex"}, "image.png");
    assert_true(file_has("image.tex", "{image.png}"));
    assert_int_not_equal(access("image.pdf", F_OK), 0);
}

TEST(files_know_the_command_and_tell_what_they_show)
{
    const figure_options o = {.command = "impactlab run x --set arm.k2=3"};
    publish(&o, "m.svg");
    assert_true(
        file_has("m.svg", "<dc:source>impactlab run x --set arm.k2=3</dc:source>"));
    assert_true(file_has("m.svg", "<desc>A title &amp; more. 1 panel over Time in s"));
    publish(&o, "m.png");
    assert_true(file_has("m.png", "impactlab run x --set arm.k2=3"));
}

TEST(a_transparent_picture_has_no_ground)
{
    publish(&(figure_options){.look.transparent = true}, "clear.png");
    PIXELS(surface) = cairo_image_surface_create_from_png("clear.png");
    assert_int_equal(cairo_image_surface_get_format(surface), CAIRO_FORMAT_ARGB32);
    assert_int_equal(cairo_image_surface_get_data(surface)[3], 0);
}

TEST(serif_pictures_have_serif_letters)
{
    publish(&(figure_options){.look.font = "DejaVu Serif"}, "serif.pdf");
    assert_true(file_has("serif.pdf", "DejaVuSerif"));
    assert_false(file_has("serif.pdf", "DejaVuSans"));
    REFUSED(STATUS_BAD_ARGUMENT, "No Such Font", text_check_family("No Such Font", &f));
}

// All bytes of a PDF with its packed streams unpacked behind them.
static GString *unpack_pdf(const char *path)
{
    size_t length;
    KEPT_TEXT(bytes) = file_bytes(path, &length);
    GString *all = g_string_new_len(bytes, (gssize)length);
    for (size_t at = 0; at + 7 < length; at++) {
        if (memcmp(bytes + at, "stream\n", 7) != 0) {
            continue;
        }
        static unsigned char out[1 << 20];
        z_stream z = {.next_in = (Bytef *)bytes + at + 7,
                      .avail_in = (uInt)(length - at - 7),
                      .next_out = out,
                      .avail_out = sizeof out};
        if (inflateInit(&z) == Z_OK) {
            inflate(&z, Z_FINISH);
            g_string_append_len(all, (const char *)out, (gssize)z.total_out);
            inflateEnd(&z);
        }
    }
    return all;
}

static bool contains(const GString *bytes, const char *wanted)
{
    return memmem(bytes->str, bytes->len, wanted, strlen(wanted)) != NULL;
}

TEST(pdf_embeds_fonts_and_has_no_type_3)
{
    SYNTHETIC(s, run_panels, RUN_PANELS);
    write_figure(&s.plot->figure, "fonts.pdf");
    GString *pdf = unpack_pdf("fonts.pdf");
    assert_true(contains(pdf, "/FontFile2"));
    assert_true(contains(pdf, "DejaVuSans"));
    assert_false(contains(pdf, "/Type3"));
    assert_true(contains(pdf, "Synthetic run & <more>"));
    assert_true(contains(pdf, "arm.model=printed"));
    // cairo 1.16 leaves out the D:
    assert_true(contains(pdf, "(20000101") || contains(pdf, "(D:20000101"));
    // curves are lines, not pictures
    assert_false(contains(pdf, "/Subtype /Image"));
    g_string_free(pdf, TRUE);
}

TEST(png_knows_its_resolution_and_origin)
{
    SYNTHETIC(s, run_panels, 2);
    s.plot->figure.width = 127;
    s.plot->figure.height = 101.6;
    s.plot->figure.dpi = 300;
    write_figure(&s.plot->figure, "notes.png");
    FILE *file = fopen("notes.png", "rb");
    assert_non_null(file);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_read_info(png, info);
    assert_int_equal(png_get_image_width(png, info), 1500);
    assert_int_equal(png_get_image_height(png, info), 1200);
    assert_int_equal(png_get_pixels_per_meter(png, info), 11811);
    png_textp notes;
    int count = 0, found = 0;
    png_get_text(png, info, &notes, &count);
    for (int i = 0; i < count; i++) {
        found += strcmp(notes[i].key, "Title") == 0 &&
                 strcmp(notes[i].text, "Synthetic run & <more>") == 0;
        found += strcmp(notes[i].key, "Software") == 0 &&
                 strncmp(notes[i].text, "impactlab ", 10) == 0;
        found += strcmp(notes[i].key, "Parameters") == 0 &&
                 strstr(notes[i].text, "motor.voltage=1") != NULL;
    }
    assert_int_equal(found, 3);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
}

TEST(svg_ids_are_unique_and_all_references_resolve)
{
    SYNTHETIC(s, run_panels, RUN_PANELS);
    write_figure(&s.plot->figure, "ids.svg");
    KEPT_TEXT(svg) = file_text("ids.svg");
    assert_non_null(strstr(svg, "<metadata>"));
    assert_non_null(strstr(svg, "<title>Synthetic run &amp; &lt;more&gt;</title>"));
    GHashTable *ids = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (char *c = strstr(svg, " id=\""); c != NULL; c = strstr(c, " id=\"")) {
        c += 5;
        assert_true(g_hash_table_add(ids, g_strndup(c, strcspn(c, "\""))));
    }
    int references = 0;
    for (EACH_TEXT(each, "href=\"#", "url(#")) {
        for (char *c = strstr(svg, *each); c != NULL; c = strstr(c, *each)) {
            c += strlen(*each);
            const int length = (int)strcspn(c, "\")");
            assert_true(g_hash_table_contains(ids, formatted("%.*s", length, c)));
            references++;
        }
    }
    assert_true(references > 100);
    g_hash_table_destroy(ids);
}

// An id holds for the whole page that a picture stands in.
TEST(svgs_of_different_pictures_share_no_id)
{
    publish(&(figure_options){0}, "one.svg");
    publish(&(figure_options){.look.theme = THEME_DARK}, "two.svg");
    publish(&(figure_options){0}, "one-again.svg");
    KEPT_TEXT(one) = file_text("one.svg");
    KEPT_TEXT(two) = file_text("two.svg");
    KEPT_TEXT(again) = file_text("one-again.svg");
    assert_string_equal(one, again);

    // no id of the one is a word of the other
    int ids = 0;
    for (char *c = strstr(one, " id=\""); c != NULL; c = strstr(c, " id=\"")) {
        c += 5;
        const char *id = formatted("%.*s", (int)strcspn(c, "\""), c);
        fail_if(strstr(two, id) != NULL, "both pictures have '%s'", id);
        ids++;
    }
    assert_true(ids > 10);
}

// The CSV of a figure is headed by the axes' names and units, those of different
// quantities by each.
TEST(csv_holds_what_is_drawn)
{
    double x[] = {0, 0.1, 0.2}, y[] = {1, (double)NAN, -2.5};
    figure_series series = {.name = "force, \"raw\"", .x = x, .y = y, .count = 3};
    figure_impulse impulse = {0.1, 0.04};
    figure_panel panels[] = {{.y = {.name = "force", .unit = "N"},
                              .series = &series,
                              .series_count = 1,
                              .impulses = &impulse,
                              .impulse_unit = "N s"},
                             {.y = {.name = "angle", .unit = "rad"}}};
    figure_mark mark = {0.1, "<i>contact</i>"};
    figure fig = {.x = {.name = "time", .unit = "s"}, .panels = panels, .panel_count = 1};
    write_csv(&fig, "data.csv");
    assert_holds("data.csv", "panel,series,time[s],force[N]\n"
                             "force[N],\"force, \"\"raw\"\"\",0,1\n"
                             "force[N],\"force, \"\"raw\"\"\",0.1,\n"
                             "force[N],\"force, \"\"raw\"\"\",0.2,-2.5\n");
    series.count = panels[0].impulse_count = fig.mark_count = 1;
    fig.marks = &mark;
    fig.panel_count = 2;
    fig.x = (figure_axis){0};
    write_csv(&fig, "data.csv");
    assert_holds("data.csv", "panel,series,x,value\n"
                             "force[N],\"force, \"\"raw\"\"\",0,1\n"
                             "force[N],impulse[N s],0.1,0.04\n"
                             "mark,contact,0.1,\n");
}

TEST(faults_are_sentences)
{
    SYNTHETIC(s, run_panels, RUN_PANELS);
    figure *fig = &s.plot->figure;
    REFUSED(STATUS_BAD_ARGUMENT, ".svg", figure_write(fig, "x.gif", &f));
    REFUSED(STATUS_BAD_ARGUMENT, "", figure_write(fig, "png", &f));
    REFUSED(STATUS_CANNOT_WRITE, "nowhere/x.png", figure_write(fig, "nowhere/x.png", &f));
    fig->dpi = 1e6;
    REFUSED(STATUS_BAD_ARGUMENT, "", figure_write(fig, "x.png", &f));
    fig->dpi = 0;
    fig->width = 20;
    REFUSED(STATUS_BAD_ARGUMENT, "larger page", figure_write(fig, "x.png", &f));
    fig->panel_count = 0;
    REFUSED(STATUS_BAD_ARGUMENT, "", figure_write(fig, "x.pdf", &f));
    // nothing was left behind
    assert_int_not_equal(access("x.png", F_OK), 0);
    assert_int_not_equal(access("x.pdf", F_OK), 0);
}

TEST(a_full_disk_is_noticed)
{
    SYNTHETIC(s, run_panels, RUN_PANELS);
    for (EACH_TEXT(c, "full.png", "full.pdf", "full.svg")) {
        fault f = {0};
        assert_int_equal(symlink("/dev/full", *c), 0);
        assert_int_equal(figure_write(&s.plot->figure, *c, &f), STATUS_CANNOT_WRITE);
        assert_true(strlen(f.text) > 10);
    }
}

// ---- measured data over runs

TEST(measured_data_have_a_panel_of_residuals)
{
    static figure_report r;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    put_file("bench.csv", "time[s],cell[N]\n0.30,0\n0.325,2\n0.345,1.6\n");
    const trace_run run = {&s.scenario, &s.result, "run"};
    const figure_options o = {.overlay = "bench.csv:cell@0.02",
                              .signals = "force,hub_angle+last_angle"};
    owned_figure *drawn = NULL;
    DONE((drawn = run_figure_create("t", NULL, 0, &run, 1, &o, &f)) == NULL ? f.code
                                                                            : STATUS_OK);
    const figure *fig = &drawn->figure;
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
    owned_figure_destroy(drawn);

    // what does not fit is said
    for (EACH_TEXT(signals, "forse", "", "force,", ",force", "force+",
                   "force+hub_angle")) {
        const figure_options bad = {.signals = *signals};
        REFUSED(STATUS_BAD_ARGUMENT,
                strcmp(*signals, "force+hub_angle") == 0 ? "" : "did you mean",
                run_figure_create("t", NULL, 0, &run, 1, &bad, &f) == NULL ? f.code
                                                                           : STATUS_OK);
    }
}

// ---- recipes

static GString *heard;

static void listen(void *context, const char *sentence)
{
    (void)context;
    g_string_append_printf(heard, "%s\n", sentence);
}

static status open_recipe(const char *name, double width, artwork *drawn, fault *f)
{
    const figure_options o = {.look.width = width};
    heard = heard != NULL ? g_string_truncate(heard, 0) : g_string_new(NULL);
    return recipe_open(name, &o, listen, NULL, drawn, f);
}

// Every recipe that ships is drawn and tidy at a column's width.
TEST(shipped_recipes_are_drawn)
{
    static figure_report r;
    const char *recipes = formatted("%s/recipes", getenv("IMPACTLAB_SCENARIOS"));
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
        SCOPED(artwork_finish) artwork drawn = {0};
        fail_if(open_recipe(formatted("%s/%s", recipes, name), 85, &drawn, &f) !=
                    STATUS_OK,
                "%s: %s%s", name, heard->str, f.text);
        expect_tidy_page(&drawn, &r);
    }
    assert_true(drawn_recipes >= 20);
    g_dir_close(entries);
}

// The data of a recipe, to be freed; how many panels it has.
static char *data_of_recipe(const char *name, int *panels)
{
    static figure_report r;
    SCOPED(artwork_finish) artwork drawn = {0};
    DONE(open_recipe(name, 0, &drawn, &f));
    record_page(&drawn, &r);
    *panels = r.panel_count;
    DONE(artwork_write_csv(&drawn, "recipe.csv", &f));
    return file_text("recipe.csv");
}

// The look of a run in a panel, by the label that tells it: its rank.
static int rank_of_run(const artwork *a, const char *label)
{
    const figure_panel *panel = &a->plotted->panels[0];
    for (int i = 0; i < panel->series_count; i++) {
        if (g_strcmp0(panel->series[i].label, label) == 0) {
            return panel->series[i].run;
        }
    }
    fail_if(true, "no series is labelled '%s'", label);
    return 0;
}

// The printed and the corrected model look alike in figures and in recipes.
TEST(models_keep_their_look_in_recipes)
{
    for (EACH_TEXT(id, "3-2", "3-3", "3-4", "3-8")) {
        g_autofree char *number = g_strdelimit(g_strdup(*id), "-", '.');
        SCOPED(artwork_finish) artwork thesis = open_figure(number, (figure_options){0});
        SCOPED(artwork_finish) artwork recipe = {0};
        DONE(open_recipe(formatted("%s/recipes/fig-%s.yaml",
                                   getenv("IMPACTLAB_SCENARIOS"), *id),
                         0, &recipe, &f));
        for (EACH_TEXT(model, "printed", "corrected")) {
            assert_int_not_equal(rank_of_run(&thesis, *model), 0);
            assert_int_equal(rank_of_run(&thesis, *model), rank_of_run(&recipe, *model));
        }
    }
}

// Small multiples are what the same runs give one by one.
TEST(multiples_are_runs_at_their_values)
{
    int panels;
    put_file("many.yaml", "runs: [{name: arm, scenario: corrected/first-impact}]\n"
                          "multiples: {vary: motor.voltage, values: [1 V, 2 V]}\n"
                          "panels: [{signals: [force]}, {signals: [hub_angle]}]\n");
    KEPT_TEXT(many) = data_of_recipe("many.yaml", &panels);
    assert_int_equal(panels, 4);
    put_file("one.yaml", "runs: [{name: arm 2 V, scenario: corrected/first-impact, set: "
                         "{motor.voltage: 2}}]\npanels: [{signals: [force]}]\n");
    KEPT_TEXT(one) = data_of_recipe("one.yaml", &panels);

    // the same rows, for any other contents of the file
    const double force = number_behind(many, ",arm 2 V force,0.3,");
    check_close(force, number_behind(one, ",arm 2 V force,0.3,"), 0);
    assert_true(force > 1);
}

// A recipe of figure 3.4 shows the numbers that figure 3.4 does, and their difference.
TEST(a_recipe_shows_what_its_runs_give)
{
    int panels;
    KEPT_TEXT(recipe) = data_of_recipe(formatted("%s/recipes/fig-3-4.yaml",
                                                 getenv("IMPACTLAB_SCENARIOS")),
                                       &panels);
    DONE(figure_draw("3.4", &(figure_options){0}, "thesis", "svg", NULL, &f));
    KEPT_TEXT(thesis) = file_text("thesis/fig-3-4.csv");
    const double printed = number_behind(recipe, "printed force,0.4,");
    const double corrected = number_behind(recipe, "corrected force,0.4,");
    check_close(printed, number_behind(thesis, ",force,0.4,"), 0);
    check_close(corrected, number_behind(thesis, ",force corrected,0.4,"), 0);
    check_close(number_behind(recipe, ",difference,0.4,"), corrected - printed, 1e-12);
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
        {"runs: [{scenario: a}]\nx: {range: [1]}\n",
         ":2:12: range is a list, expected two"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force], notes: [{at: [0, 1]}]}]\n",
         ":2:37: a note needs 'text'"},
        {"runs: 3\n", ":1:7: runs is a single value, expected a list"},
        {"runs: [\n", ":2:1: "},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\nmultiples: {vary: "
         "motor.volts}\n",
         ":3:19: there is no parameter 'motor.volts', did you mean 'motor.voltage'?"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\nmultiples: {values: "
         "[1]}\n",
         ":3:12: multiples needs 'vary'"},
        {"runs: [{scenario: a}]\npanels: [{signals: [force]}]\n"
         "multiples: {vary: arm.k2, values: "
         "[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]}\n",
         ":3:75: there are more than 16 values"},
        {"runs: [{scenario: a}]\ntables: [{file: b, x: c, y: d}]\n"
         "panels: [{signals: [force], difference: [a, b]}]\n",
         ":3:45: 'b' is a table, expected a run or data"},
        {"runs: [{scenario: a}]\ntables: [{file: b, x: c, y: d}]\n"
         "panels: [{from: [b], difference: [a, a]}]\n",
         ":3:10: a panel of runs or data needs 'signals'"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        fault f = {0};
        artwork drawn;
        put_file("bad.yaml", cases[i].text);
        assert_int_equal(open_recipe("bad.yaml", 0, &drawn, &f), STATUS_BAD_SCENARIO);
        const char *expected = formatted("bad.yaml%s", cases[i].said);
        fail_if(strstr(heard->str, expected) == NULL, "expected '%s', heard '%s'",
                expected, heard->str);
    }

    // what is found out only when a run is opened has a place, too
    artwork drawn;
    put_file("bad.yaml", "runs:\n  - scenario: no/such\npanels: [{signals: [force]}]\n");
    REFUSED(STATUS_BAD_ARGUMENT,
            "bad.yaml:2:5: ", open_recipe("bad.yaml", 0, &drawn, &f));
}

ALL_BETWEEN(enter_folder, leave_plot_folder)

// Figures as files: bytes, fonts, identifiers, data, faults.
#include "tests/plot_fixture.h"

// ---- files

TEST(same_bytes_also_for_later_figures)
{
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    for (int n = 1; n <= 20; n++) {
        for (EACH_TEXT(c, "png", "pdf", "svg")) {
            char name[64];
            snprintf(name, sizeof name, "same-%d.%s", n, *c);
            write_figure(&s.figure.plot.figure, name);
            if (n == 2 || n == 20) {
                char first[64];
                snprintf(first, sizeof first, "same-1.%s", *c);
                expect_same_bytes(first, name);
            }
        }
    }
}

// All bytes of a PDF with its packed streams unpacked behind them.
static GString *unpack_pdf(const char *path)
{
    size_t length;
    SCOPED(free_kept) char *bytes = read_file(path, &length);
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
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    write_figure(&s.figure.plot.figure, "fonts.pdf");
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
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, 2);
    s.figure.plot.figure.width = 127;
    s.figure.plot.figure.height = 101.6;
    s.figure.plot.figure.dpi = 300;
    write_figure(&s.figure.plot.figure, "notes.png");
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
        found +=
            strcmp(notes[i].key, "Software") == 0 && strncmp(notes[i].text, "impactlab ", 10) == 0;
        found += strcmp(notes[i].key, "Parameters") == 0 &&
                 strstr(notes[i].text, "motor.voltage=1") != NULL;
    }
    assert_int_equal(found, 3);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
}

TEST(svg_ids_are_unique_and_all_references_resolve)
{
    SCOPED(synthetic_finish) synthetic s;
    size_t length;
    synthetic_init(&s, run_panels, RUN_PANELS);
    write_figure(&s.figure.plot.figure, "ids.svg");
    SCOPED(free_kept) char *svg = read_file("ids.svg", &length);
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
            char *id = g_strndup(c, strcspn(c, "\")"));
            assert_true(g_hash_table_contains(ids, id));
            g_free(id);
            references++;
        }
    }
    assert_true(references > 100);
    g_hash_table_destroy(ids);
}

TEST(csv_holds_what_is_drawn)
{
    double x[] = {0, 0.1, 0.2}, y[] = {1, (double)NAN, -2.5};
    figure_series series = {.name = "force, \"raw\"", .x = x, .y = y, .count = 3};
    figure_impulse impulse = {0.1, 0.04};
    figure_panel panel = {.y = {.name = "force", .unit = "N"},
                          .series = &series,
                          .series_count = 1,
                          .impulses = &impulse,
                          .impulse_count = 1,
                          .impulse_unit = "N s"};
    figure_mark mark = {0.1, "<i>contact</i>"};
    figure fig = {.panels = &panel, .panel_count = 1, .marks = &mark, .mark_count = 1};
    size_t length;
    DONE(figure_write_csv(&fig, "data.csv", &f));
    SCOPED(free_kept) char *csv = read_file("data.csv", &length);
    assert_string_equal(csv, "panel,series,x,value\n"
                             "force[N],\"force, \"\"raw\"\"\",0,1\n"
                             "force[N],\"force, \"\"raw\"\"\",0.1,\n"
                             "force[N],\"force, \"\"raw\"\"\",0.2,-2.5\n"
                             "force[N],impulse[N s],0.1,0.04\n"
                             "mark,contact,0.1,\n");
}

TEST(faults_are_sentences)
{
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    figure *fig = &s.figure.plot.figure;
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
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    for (EACH_TEXT(c, "full.png", "full.pdf", "full.svg")) {
        fault f = {0};
        assert_int_equal(symlink("/dev/full", *c), 0);
        assert_int_equal(figure_write(&s.figure.plot.figure, *c, &f), STATUS_CANNOT_WRITE);
        assert_true(strlen(f.text) > 10);
    }
}

ALL_BETWEEN(enter_folder, leave_plot_folder)

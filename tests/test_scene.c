// Pictures of the arm in space, and films of it.
//
// The golden pictures in tests/golden show no text, so that they depend on no font. A change of the
// drawing that is meant is taken over by running this test with IMPACTLAB_WRITE_GOLDENS=1 and
// looking at the new pictures before they are committed.
#include "tests/check.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/scene/film.h"
#include "render/scene/film_file.h"
#include "render/scene/scene.h"
#include "render/page/text.h"

enum { WIDTH = 320, HEIGHT = 180 };

typedef struct recorded {
    scenario scenario;
    run_result result;
} recorded;

static char folder[] = "/tmp/test-scene-XXXXXX";

static void complain(void *context, const char *sentence)
{
    (void)context;
    fail_msg("%s", sentence);
}

static recorded record(const char *name)
{
    recorded r;
    assert_int_equal(scenario_open(&r.scenario, name, complain, NULL), STATUS_OK);
    assert_int_equal(run_scenario(&r.scenario, true, &r.result), STATUS_OK);
    return r;
}

static void forget(recorded *r)
{
    run_finish(&r->result);
    scenario_finish(&r->scenario);
}

static const char *in_folder(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

// True if a renderer can be had here.
static bool is_there(scene_renderer which)
{
    scene_painter *painter;
    if (scene_painter_create(&painter, which, 16, 16, SAMPLES_QUICK, NULL) != STATUS_OK) {
        return false;
    }
    scene_painter_destroy(painter);
    return true;
}

static cairo_surface_t *picture(const recorded *r, scene_options options, const double *times,
                                int count)
{
    scene *sc;
    fault f = {0};
    options.width = options.width ? options.width : WIDTH;
    options.height = options.height ? options.height : HEIGHT;
    if (scene_create(&sc, &r->scenario, &r->result, &options, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, options.width, options.height);
    assert_int_equal(scene_paint(sc, times, count, surface, &f), STATUS_OK);
    scene_destroy(sc);
    cairo_surface_flush(surface);
    return surface;
}

static unsigned pixel_at(cairo_surface_t *s, int x, int y)
{
    const unsigned char *data = cairo_image_surface_get_data(s);
    unsigned pixel;
    memcpy(&pixel, data + (ptrdiff_t)y * cairo_image_surface_get_stride(s) + 4 * x, sizeof pixel);
    return pixel & 0xFFFFFF;
}

static int channel_of(unsigned pixel, int index)
{
    return (int)(pixel >> (16 - 8 * index) & 255);
}

// Pixels as blue as the beam, or as red as the arrow.
static int count_beam(unsigned pixel)
{
    return channel_of(pixel, 2) > channel_of(pixel, 0) + 90;
}

static int count_arrow(unsigned pixel)
{
    return channel_of(pixel, 0) > channel_of(pixel, 2) + 140 &&
           channel_of(pixel, 0) > channel_of(pixel, 1) + 70;
}

static int count_pixels(cairo_surface_t *s, int (*counts)(unsigned))
{
    int count = 0;
    for (int y = 0; y < cairo_image_surface_get_height(s); y++) {
        for (int x = 0; x < cairo_image_surface_get_width(s); x++) {
            count += counts(pixel_at(s, x, y));
        }
    }
    return count;
}

// Pixels that differ by more than `tolerance` levels in some channel.
static int count_different(cairo_surface_t *a, cairo_surface_t *b, int tolerance)
{
    int count = 0;
    assert_int_equal(cairo_image_surface_get_width(a), cairo_image_surface_get_width(b));
    assert_int_equal(cairo_image_surface_get_height(a), cairo_image_surface_get_height(b));
    for (int y = 0; y < cairo_image_surface_get_height(a); y++) {
        for (int x = 0; x < cairo_image_surface_get_width(a); x++) {
            unsigned p = pixel_at(a, x, y), q = pixel_at(b, x, y);
            bool differs = false;
            for (int i = 0; i < 3; i++) {
                differs = differs || abs(channel_of(p, i) - channel_of(q, i)) > tolerance;
            }
            count += differs;
        }
    }
    return count;
}

// --- geometry -------------------------------------------------------------------------------

static double distance(vector a, vector b)
{
    vector d = vector_sum(a, -1, b);
    return sqrt(vector_dot(d, d));
}

// The curve starts and ends where the arm does, along its outer links, and touches every inner link
// at its middle.
static void test_curve(void **state)
{
    (void)state;
    for (int links = 1; links <= 40; links += links < 3 ? 1 : 37) {
        vector joints[64] = {0}, curve[256];
        assert_in_range(scene_curve_length(links), 2, 256);
        for (int k = 0; k < links; k++) {
            double angle = 0.3 + 0.5 * sin(k);
            joints[k + 1] = vector_add(joints[k], (vector){cos(angle), sin(angle), 0});
        }
        int count = scene_curve(joints, links, curve);
        assert_int_equal(count, scene_curve_length(links));
        check_close(distance(curve[0], joints[0]), 0, 1e-15);
        check_close(distance(curve[count - 1], joints[links]), 0, 1e-15);
        vector start = vector_unit(vector_sum(curve[1], -1, curve[0]));
        vector end = vector_unit(vector_sum(curve[count - 1], -1, curve[count - 2]));
        // the first piece of a parabola leans by about half its own turn
        double slack = links == 1 ? 1e-7 : 1.5 / (count / (double)links);
        check_close(vector_dot(start, vector_sum(joints[1], -1, joints[0])), 1, slack * slack);
        check_close(vector_dot(end, vector_sum(joints[links], -1, joints[links - 1])), 1,
                    slack * slack);
        for (int k = 1; k + 1 < links; k++) {
            vector middle = vector_scaled(vector_add(joints[k], joints[k + 1]), 0.5);
            double nearest = 1;
            for (int i = 0; i < count; i++) {
                nearest = fmin(nearest, distance(curve[i], middle));
            }
            check_close(nearest, 0, 1e-12);
        }
    }
}

// At a row the joints are the row's; between rows the tip is between.
static void test_joints(void **state)
{
    (void)state;
    recorded r = record("corrected/five-links");
    const trace *t = &r.result.trace;
    const parameters *p = &r.scenario.parameters;
    vector joints[6];
    size_t row = t->row_count / 2;
    while (t->rows[row].time == t->rows[row + 1].time) {
        row++;
    }
    scene_joints(t, p, t->rows[row].time, joints);
    const double *angles = t->angles + (row + 1) * (size_t)t->angle_count - 5; // behind the hub's
    for (int k = 0; k < 5; k++) {
        check_close(atan2(joints[k + 1].y - joints[k].y, joints[k + 1].x - joints[k].x), angles[k],
                    1e-12);
        check_close(distance(joints[k + 1], joints[k]), p->arm.length / 5, 1e-12);
    }
    sample half = scene_joints(t, p, (t->rows[row].time + t->rows[row + 1].time) / 2, joints);
    check_close(half.last_angle, (t->rows[row].last_angle + t->rows[row + 1].last_angle) / 2, 1e-9);
    // beyond the ends the arm stays where it is
    check_close(scene_joints(t, p, 1e9, joints).last_angle, t->rows[t->row_count - 1].last_angle,
                1e-15);
    forget(&r);
}

static void test_instants(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    const summary *m = &r.result.summary;
    double times[6];
    scene_instants(&r.result, times, 6);
    check_close(times[0], 0, 1e-15);
    for (int i = 1; i < 6; i++) {
        check_below(times[i - 1], times[i]);
    }
    check_close(times[5], m->first_contact_s + m->first_pulse_time_to_peak_s, 1e-12);
    forget(&r);
}

// Whatever is to be seen lies within the window, and fills it in one direction.
static void test_camera(void **state)
{
    (void)state;
    const vector points[] = {{0, 0, 0.1}, {1, 0.2, -0.1}, {0.9, -0.4, 0}, {0.2, 0.3, 0.05}};
    const camera_window window = {0.1, 0.05, 0.9, 0.8};
    const camera_view kinds[] = {{CAMERA_THREE_QUARTER, 0, 0},
                                 {CAMERA_TOP, 0, 0},
                                 {CAMERA_SIDE, 0, 0},
                                 {CAMERA_FREE, 120, 25}};
    for (size_t k = 0; k < 4; k++) {
        camera c = camera_fit(kinds[k], 0.1, points, 4, 640, 360, window);
        double left = 1, right = 0, top = 1, bottom = 0;
        for (size_t i = 0; i < 4; i++) {
            vector at = camera_project(&c, points[i]);
            left = fmin(left, at.x / 640);
            right = fmax(right, at.x / 640);
            top = fmin(top, at.y / 360);
            bottom = fmax(bottom, at.y / 360);
            check_below(c.nearest, at.z);
            check_below(at.z, c.farthest);
            // the ray through the place leads back to the point
            vector ray = camera_ray(&c, at.x, at.y);
            check_close(distance(vector_sum(c.eye, at.z, ray), points[i]), 0, 1e-9);
        }
        check_below(window.left - 0.01, left);
        check_below(right, window.right + 0.01);
        check_below(window.top - 0.01, top);
        check_below(bottom, window.bottom + 0.01);
        assert_true(right - left > 0.75 || bottom - top > 0.7);
    }
    // in a plan the heading points to the right
    camera plan = camera_fit((camera_view){.kind = CAMERA_TOP}, 0.7, points, 4, 640, 360, window);
    vector hub = camera_project(&plan, (vector){0}),
           ahead = camera_project(&plan, (vector){cos(0.7), sin(0.7), 0});
    check_close(hub.y, ahead.y, 1);
    check_below(hub.x, ahead.x);
}

// --- pictures -------------------------------------------------------------------------------

// The beam is there, the arrow only while the wall pushes.
static void test_content(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    const scene_options cairo = {.renderer = RENDER_CAIRO, .plain = true};
    double before = 0.1, peak = 0.3634, pair[] = {0, 0.3634};
    cairo_surface_t *free_arm = picture(&r, cairo, &before, 1);
    cairo_surface_t *pushed = picture(&r, cairo, &peak, 1);
    cairo_surface_t *both = picture(&r, cairo, pair, 2);
    assert_in_range(count_pixels(free_arm, count_beam), 500, 8000);
    assert_in_range(count_pixels(pushed, count_beam), 500, 8000);
    assert_int_equal(count_pixels(free_arm, count_arrow), 0);
    assert_in_range(count_pixels(pushed, count_arrow), 40, 4000);
    // the ghost of the earlier arm hides nothing of the later one
    check_close(count_pixels(both, count_beam), count_pixels(pushed, count_beam), 60);
    check_below(200, count_different(both, pushed, 20));
    cairo_surface_destroy(free_arm);
    cairo_surface_destroy(pushed);
    cairo_surface_destroy(both);
    forget(&r);
}

// Presets, and two angles of one's own.
static void test_camera_words(void **state)
{
    (void)state;
    camera_view view;
    assert_true(camera_read("tip", &view));
    assert_int_equal(view.kind, CAMERA_TIP);
    assert_true(camera_read("-60,40.5", &view));
    assert_int_equal(view.kind, CAMERA_FREE);
    check_close(view.azimuth, -60, 0);
    check_close(view.elevation, 40.5, 0);
    static const char *const wrong[] = {"", "front", "10", "10,", "10,0", "400,40", "1,2,3"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_false(camera_read(wrong[i], &view));
    }
}

// Bending is drawn larger, while hub and tip stay where they are: the beam covers other pixels, the
// arrow at its tip the same.
static void test_exaggerated(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    const double peak = 0.3634;
    scene_options o = {.renderer = RENDER_CAIRO, .plain = true, .camera = {.kind = CAMERA_TOP}};
    cairo_surface_t *as_it_is = picture(&r, o, &peak, 1);
    o.exaggerate = 1;
    cairo_surface_t *once = picture(&r, o, &peak, 1);
    o.exaggerate = 5;
    cairo_surface_t *larger = picture(&r, o, &peak, 1);
    assert_int_equal(count_different(as_it_is, once, 0), 0);
    check_below(300, count_different(as_it_is, larger, 20));
    check_close(count_pixels(larger, count_arrow), count_pixels(as_it_is, count_arrow), 12);
    cairo_surface_destroy(as_it_is);
    cairo_surface_destroy(once);
    cairo_surface_destroy(larger);
    forget(&r);
}

// Four samples a pixel's edge are the same picture as two but for edges, without steps between.
static void test_samples(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    const double peak = 0.3634;
    scene_options o = {.renderer = RENDER_CAIRO, .plain = true, .samples = SAMPLES_QUICK};
    cairo_surface_t *quick = picture(&r, o, &peak, 1);
    o.samples = SAMPLES_FINE;
    cairo_surface_t *fine = picture(&r, o, &peak, 1);
    check_below(count_different(quick, fine, 40), WIDTH * HEIGHT / 200);
    check_below(0, count_different(quick, fine, 4));
    cairo_surface_destroy(quick);
    cairo_surface_destroy(fine);
    forget(&r);
}

static const struct {
    const char *file, *scenario;
    camera_kind camera;
    double times[3];
    int count;
} goldens[] = {
    {"scene-point.png", "corrected/first-impact", CAMERA_THREE_QUARTER, {0.0, 0.2, 0.3634}, 3},
    {"scene-plane.png", "corrected/plane-wall", CAMERA_TOP, {0.1, 0.36}, 2},
    {"scene-side.png", "corrected/twenty-links", CAMERA_SIDE, {0.2}, 1},
};

static void compare_golden(size_t index, scene_renderer renderer, const char *name)
{
    char path[512];
    recorded r = record(goldens[index].scenario);
    const scene_options options = {
        .camera = {.kind = goldens[index].camera}, .renderer = renderer, .plain = true};
    cairo_surface_t *drawn = picture(&r, options, goldens[index].times, goldens[index].count);
    snprintf(path, sizeof path, "%s/%s", getenv("IMPACTLAB_GOLDENS"), goldens[index].file);
    if (getenv("IMPACTLAB_WRITE_GOLDENS") != NULL && renderer == RENDER_CAIRO) {
        assert_int_equal(cairo_surface_write_to_png(drawn, path), CAIRO_STATUS_SUCCESS);
    }
    cairo_surface_t *golden = cairo_image_surface_create_from_png(path);
    assert_int_equal(cairo_surface_status(golden), CAIRO_STATUS_SUCCESS);
    int different = count_different(drawn, golden, 12);
    if (different > WIDTH * HEIGHT / 500) {
        cairo_surface_write_to_png(drawn, in_folder(goldens[index].file));
        fail_msg("%s by %s: %d of %d pixels differ by more than 12 levels, the picture is %s",
                 goldens[index].file, name, different, WIDTH * HEIGHT,
                 in_folder(goldens[index].file));
    }
    cairo_surface_destroy(golden);
    cairo_surface_destroy(drawn);
    forget(&r);
}

static void test_golden_cairo(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof goldens / sizeof goldens[0]; i++) {
        compare_golden(i, RENDER_CAIRO, "cairo");
    }
}

static void test_golden_gl(void **state)
{
    (void)state;
    bool any = false;
    for (scene_renderer which = RENDER_OSMESA; which <= RENDER_EGL; which++) {
        for (size_t i = 0; i < sizeof goldens / sizeof goldens[0] && is_there(which); i++) {
            compare_golden(i, which, which == RENDER_EGL ? "EGL" : "OSMesa");
            any = true;
        }
    }
    if (!any) {
        skip();
    }
}

static void check_contains(const char *path, const char *text)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    static char bytes[1 << 20];
    size_t length = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    if (memmem(bytes, length, text, strlen(text)) == NULL) {
        fail_msg("'%s' is not in %s", text, path);
    }
}

// The file says what drew it, and a second one has the same bytes.
static void test_file(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    const scene_options options = {.renderer = RENDER_CAIRO, .width = WIDTH, .height = HEIGHT};
    double time = 0.3;
    fault f = {0};
    char command[600], first[256];
    snprintf(first, sizeof first, "%s", in_folder("first.png"));
    assert_int_equal(scene_write(&r.scenario, &r.result, &options, &time, 1, first, &f), STATUS_OK);
    check_contains(first, "Renderer");
    check_contains(first, "cairo ");
    check_contains(first, "scenario=corrected/first-impact");
    check_contains(first, "motor.voltage=1");
    assert_int_equal(
        scene_write(&r.scenario, &r.result, &options, &time, 1, in_folder("second.png"), &f),
        STATUS_OK);
    snprintf(command, sizeof command, "cmp %s %s", first, in_folder("second.png"));
    assert_int_equal(system(command), 0);
    forget(&r);
}

static void test_refused(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    scene_options options = {.renderer = RENDER_CAIRO, .width = WIDTH, .height = HEIGHT};
    double late = 7, good = 0.1;
    fault f = {0};
    assert_int_equal(
        scene_write(&r.scenario, &r.result, &options, &late, 1, in_folder("x.png"), &f),
        STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "7 s"));
    assert_int_equal(
        scene_write(&r.scenario, &r.result, &options, &good, 1, in_folder("x.jpg"), &f),
        STATUS_BAD_ARGUMENT);
    assert_int_equal(scene_write(&r.scenario, &r.result, &options, &good, 1, "/nowhere/x.png", &f),
                     STATUS_CANNOT_WRITE);
    options.width = 3;
    assert_int_equal(
        scene_write(&r.scenario, &r.result, &options, &good, 1, in_folder("x.png"), &f),
        STATUS_BAD_ARGUMENT);
    assert_int_not_equal(access(in_folder("x.png"), F_OK), 0);
    forget(&r);
}

// --- films ----------------------------------------------------------------------------------

// The film runs through the whole run, forwards, and slower round the impact by what was asked for.
static void test_clock(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_clock c = film_clock_of(&r.result, 10, 8);
    double speed, last = -1, outside, inside = 0, run = 0;
    film_clock_time(&c, 0.5, &outside);
    for (int i = 0; i <= 1000; i++) {
        double time = film_clock_time(&c, i / 100.0, &speed);
        check_below(last, time);
        last = time;
        run += i < 1000 ? speed / 100 : 0;
        if (fabs(time - r.result.summary.first_contact_s) < 0.005) {
            inside = speed;
        }
    }
    check_close(last, 1, 1e-9);
    check_close(film_clock_time(&c, 0, &speed), 0, 1e-9);
    check_relative(outside / inside, 8.0, 1e-6);
    // the speeds told add up to the run
    check_relative(run, 1.0, 0.01);
    forget(&r);
    r = record("corrected/free-vibration");
    c = film_clock_of(&r.result, 5, 8);
    film_clock_time(&c, 2, &speed);
    check_relative(speed, r.scenario.parameters.run.duration / 5, 1e-6);
    forget(&r);
}

static film_options small_film(void)
{
    return (film_options){.view.renderer = RENDER_CAIRO,
                          .width = 320,
                          .height = 240,
                          .frames_per_second = 10,
                          .seconds = 0.5};
}

static int count_files(const char *path)
{
    int count = 0;
    DIR *opened = opendir(path);
    assert_non_null(opened);
    for (struct dirent *entry; (entry = readdir(opened)) != NULL;) {
        count += entry->d_name[0] != '.';
    }
    closedir(opened);
    return count;
}

static void test_frames(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    char path[256];
    snprintf(path, sizeof path, "%s", in_folder("frames"));
    if (film_write(&r.scenario, &r.result, &options, path, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    assert_int_equal(count_files(path), 5);
    cairo_surface_t *frame =
        cairo_image_surface_create_from_png(in_folder("frames/frame-00003.png"));
    assert_int_equal(cairo_image_surface_get_width(frame), 320);
    assert_int_equal(cairo_image_surface_get_height(frame), 240);
    check_below(100, count_pixels(frame, count_beam));
    cairo_surface_destroy(frame);
    // frames of two films do not mix
    assert_int_equal(film_write(&r.scenario, &r.result, &options, path, &f), STATUS_CANNOT_WRITE);
    assert_non_null(strstr(f.text, "not empty"));
    forget(&r);
}

static void test_film(void **state)
{
    (void)state;
    recorded r = record("corrected/plane-wall");
    film_options options = small_film();
    fault f = {0};
    if (film_file_check(in_folder("film.mp4"), &f) != STATUS_OK) {
        assert_non_null(strstr(f.text, "install the package ffmpeg"));
        forget(&r);
        skip();
    }
    const char *const names[] = {"film.mp4", "film.webm", "film.gif"};
    const char *const marks[] = {"ftypisom", "webm", "GIF89a"};
    for (int i = 0; i < 3; i++) {
        if (film_write(&r.scenario, &r.result, &options, in_folder(names[i]), &f) != STATUS_OK) {
            fail_msg("%s", f.text);
        }
        check_contains(in_folder(names[i]), marks[i]);
    }
    forget(&r);
}

// Puts a program of the given text in the place of ffmpeg. Returns the old PATH, to be restored.
static char *with_encoder(const char *text)
{
    char path[256], *old = strdup(getenv("PATH"));
    FILE *stream = fopen(in_folder("ffmpeg"), "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
    assert_int_equal(chmod(in_folder("ffmpeg"), 0755), 0);
    snprintf(path, sizeof path, "%s:/bin:/usr/bin", folder);
    setenv("PATH", path, 1);
    return old;
}

static void restore_encoder(char *old)
{
    setenv("PATH", old, 1);
    free(old);
    unlink(in_folder("ffmpeg"));
}

// An encoder that gives up is quoted, and nothing of the film is left.
static void test_encoder_fails(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    char *old = with_encoder("#!/bin/sh\necho 'no such codec' >&2\nexit 1\n");
    int before = count_files(folder);
    assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("bad.mp4"), &f),
                     STATUS_CANNOT_WRITE);
    assert_non_null(strstr(f.text, "no such codec"));
    assert_int_equal(count_files(folder), before);
    restore_encoder(old);
    old = with_encoder("#!/bin/sh\n");
    setenv("PATH", "/nowhere", 1);
    assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("bad.mp4"), &f),
                     STATUS_CANNOT_WRITE);
    assert_non_null(strstr(f.text, "install the package ffmpeg"));
    restore_encoder(old);
    forget(&r);
}

// A GIF has the size and the frames that were asked for: nothing scales or drops them.
static void test_gif_as_asked(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    char *old = with_encoder("#!/bin/sh\ncat >/dev/null\nfor last; do :; done\n"
                             "printf 'GIF89a %s;' \"$*\" >\"${last#file:}\"\n");
    if (film_write(&r.scenario, &r.result, &options, in_folder("asked.gif"), &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    restore_encoder(old);
    char words[4096] = "";
    FILE *stream = fopen(in_folder("asked.gif"), "r");
    assert_non_null(stream);
    assert_non_null(fgets(words, sizeof words, stream));
    fclose(stream);
    assert_non_null(strstr(words, "-s 320x240 -r 10 "));
    assert_null(strstr(words, "scale="));
    assert_null(strstr(words, "fps="));
    forget(&r);
}

static volatile sig_atomic_t stopped;

static void stop_soon(void *context, int done, int total)
{
    (void)context;
    (void)total;
    stopped = done >= 2;
}

static void test_interrupted(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    stopped = 0;
    options.progress = stop_soon;
    options.stop = &stopped;
    char *old = with_encoder("#!/bin/sh\ncat >/dev/null\n");
    int before = count_files(folder);
    assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("half.mp4"), &f),
                     STATUS_STOPPED);
    assert_non_null(strstr(f.text, "interrupted after 2 of 5"));
    assert_int_equal(count_files(folder), before);
    restore_encoder(old);
    forget(&r);
}

// A complaint is a failure whatever the encoder's status is, as with a full disk; and what it
// leaves without a complaint must be a film.
static void test_encoder_complains(void **state)
{
    (void)state;
    static const struct {
        const char *script, *said;
    } cases[] = {
        {"#!/bin/sh\ncat >/dev/null\nfor last; do :; done\nprintf 'xxxxftyp' >\"${last#file:}\"\n"
         "echo 'av_interleaved_write_frame(): No space left on device' >&2\n",
         "No space left"},
        {"#!/bin/sh\ncat >/dev/null\n", "no such film"},
        {"#!/bin/sh\ncat >/dev/null\nfor last; do :; done\necho nonsense >\"${last#file:}\"\n",
         "no such film"},
    };
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};

    // a film that was there before stays
    FILE *kept = fopen(in_folder("kept.mp4"), "w");
    assert_non_null(kept);
    fputs("old", kept);
    fclose(kept);
    for (int i = 0; i < 3; i++) {
        char *old = with_encoder(cases[i].script), text[8] = "";
        assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("kept.mp4"), &f),
                         STATUS_CANNOT_WRITE);
        restore_encoder(old);
        assert_non_null(strstr(f.text, cases[i].said));
        kept = fopen(in_folder("kept.mp4"), "r");
        assert_non_null(kept);
        assert_non_null(fgets(text, sizeof text, kept));
        fclose(kept);
        assert_string_equal(text, "old");
    }
    unlink(in_folder("kept.mp4"));
    forget(&r);
}

static void stop_now(int number)
{
    (void)number;
    stopped = 1;
}

// An encoder that hangs, before the first frame or after the last, is left at the first signal.
static void test_encoder_hangs(void **state)
{
    (void)state;
    static const char *const scripts[] = {"#!/bin/sh\ntrap '' TERM\nexec sleep 1000\n",
                                          "#!/bin/sh\ncat >/dev/null\nexec sleep 1000\n"};
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    options.stop = &stopped;
    struct sigaction act = {.sa_handler = stop_now};
    sigaction(SIGALRM, &act, NULL);
    for (int i = 0; i < 2; i++) {
        char *old = with_encoder(scripts[i]);
        int before = count_files(folder);
        stopped = 0;
        alarm(1);
        assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("half.mp4"), &f),
                         STATUS_STOPPED);
        assert_int_equal(count_files(folder), before);
        restore_encoder(old);
    }
    forget(&r);
}

static void test_film_refused(void **state)
{
    (void)state;
    recorded r = record("corrected/first-impact");
    film_options options = small_film();
    fault f = {0};
    assert_int_equal(film_file_check(in_folder("film.avi"), &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, ".webm"));
    options.width = 321;
    assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("odd.mp4"), &f),
                     STATUS_BAD_ARGUMENT);
    options = small_film();
    options.seconds = -1;
    assert_int_equal(film_write(&r.scenario, &r.result, &options, in_folder("odd.mp4"), &f),
                     STATUS_BAD_ARGUMENT);
    forget(&r);
}

static int set_up(void **state)
{
    (void)state;
    return mkdtemp(folder) == NULL;
}

static int tear_down(void **state)
{
    char command[128];
    (void)state;
    text_release();
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) != 0;
}

int main(void)
{
    // one software renderer, whatever the machine has
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curve),
        cmocka_unit_test(test_joints),
        cmocka_unit_test(test_instants),
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_camera_words),
        cmocka_unit_test(test_exaggerated),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_content),
        cmocka_unit_test(test_golden_cairo),
        cmocka_unit_test(test_golden_gl),
        cmocka_unit_test(test_file),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_clock),
        cmocka_unit_test(test_frames),
        cmocka_unit_test(test_film),
        cmocka_unit_test(test_encoder_fails),
        cmocka_unit_test(test_encoder_complains),
        cmocka_unit_test(test_encoder_hangs),
        cmocka_unit_test(test_interrupted),
        cmocka_unit_test(test_gif_as_asked),
        cmocka_unit_test(test_film_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down) != 0;
}

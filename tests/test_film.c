// Films of runs: their clock, their frames, and failures of the encoder.
#include "tests/scene_fixture.h"

#include "render/scene/film.h"

static status film_of(const recorded *r, const film_options *options, const char *path,
                      fault *f)
{
    const film_run run = {&r->scenario, &r->result, r->scenario.name};
    return film_write(&run, 1, options, path, f);
}

static film_clock clock_of(const recorded *r, double seconds, double slow)
{
    const run_result *result = &r->result;
    return film_clock_of(&result, 1, seconds, slow);
}

// The film runs through the whole run, forwards, and slower round the impact by what was
// asked for.
TEST(test_clock)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    SCOPED(forget) recorded untouched = record("corrected/free-vibration");
    film_clock c = clock_of(&r, 10, 8);
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
    // the displayed speeds add up to the run
    check_relative(run, 1.0, 0.01);
    c = clock_of(&untouched, 5, 8);
    film_clock_time(&c, 2, &speed);
    check_relative(speed, untouched.scenario.parameters.run.duration / 5, 1e-6);
}

static const film_options small_film = {.view = {.renderer = RENDER_CAIRO,
                                                 .samples = SAMPLES_QUICK},
                                        .width = 320,
                                        .height = 240,
                                        .frames_per_second = 10,
                                        .seconds = 0.5};

// A run that goes when its block is left, and what a small film is made by.
#define FILMED(r, options, name)                                                         \
    SCOPED(forget) recorded r = record(name);                                            \
    film_options options = small_film

// Every impact is slowed down, not the first alone, and the speed told is the clock's
// own.
TEST(test_clock_of_bounces)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    film_clock c = clock_of(&r, 10, 8);
    double speed, fastest = 0;
    int slowed = 0;
    assert_true(c.impact_count >= 2);
    for (int i = 0; i <= 2000; i++) {
        film_clock_time(&c, i / 200.0, &speed);
        fastest = fmax(fastest, speed);
    }
    for (int k = 0; k < c.impact_count; k++) {
        bool seen = false;
        for (int i = 0; i <= 2000; i++) {
            double time = film_clock_time(&c, i / 200.0, &speed);
            seen =
                seen || (fabs(time - c.impacts[k]) < 0.005 && speed < 1.01 * fastest / 8);
        }
        slowed += seen;
    }
    assert_int_equal(slowed, c.impact_count);
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

TEST(test_frames)
{
    FILMED(r, options, "corrected/first-impact");
    DONE(film_of(&r, &options, "frames", &f));
    assert_int_equal(count_files("frames"), 5);
    PIXELS(frame) = cairo_image_surface_create_from_png("frames/frame-00003.png");
    assert_int_equal(cairo_image_surface_get_width(frame), 320);
    assert_int_equal(cairo_image_surface_get_height(frame), 240);
    check_below(100, count_pixels(frame, count_beam));
    // frames of two films do not mix
    REFUSED(STATUS_CANNOT_WRITE, "not empty", film_of(&r, &options, "frames", &f));
}

static void expect_same_frames(const char *one, const char *two, int count)
{
    for (int i = 1; i <= count; i++) {
        assert_int_equal(system(formatted("cmp %s/frame-%05d.png %s/frame-%05d.png", one,
                                          i, two, i)),
                         0);
    }
}

// One film after the other, by OpenGL where it is: the one leaves none of its pictures to
// the other.
TEST(test_films_by_gl)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    static const char *const names[] = {"gl-1", "gl-2", "gl-3"};
    for (int i = 0; i < 3; i++) {
        film_options options = small_film;
        options.view.renderer = RENDER_AUTO;
        DONE(film_of(&r, &options, names[i], &f));
        expect_same_frames(names[0], names[i], 5);
    }
}

// As dark as an arrow among arms of several colours.
static int count_dark(unsigned pixel)
{
    return channel_of(pixel, 0) < 60 && channel_of(pixel, 1) < 60 &&
           channel_of(pixel, 2) < 60;
}

// Each run has a view of its own, with an arm in the colour of its curve: the first blue,
// the second as red as a lone arrow.
TEST(test_split_screen)
{
    SCOPED(forget)
    recorded a = record("corrected/first-impact"), b = record("corrected/plane-wall");
    const film_run runs[2] = {{&a.scenario, &a.result, "one"},
                              {&b.scenario, &b.result, "two"}};
    film_options options = small_film;
    DONE(film_write(runs, 2, &options, "split", &f));
    PIXELS(frame) = cairo_image_surface_create_from_png("split/frame-00003.png");
    assert_int_equal(cairo_image_surface_get_width(frame), 320);
    check_below(60, count_pixels_in(frame, 0, 160, 160, count_beam));
    check_below(60, count_pixels_in(frame, 160, 320, 160, count_arrow));
    assert_int_equal(count_pixels_in(frame, 160, 320, 160, count_beam), 0);
}

// Runs side by side have one scale of force: where each presses with its share of its own
// peak, the arrow of four times the force is several times as large.
TEST(test_one_scale_of_force)
{
    SCOPED(forget) recorded a = record("corrected/first-impact");
    SCOPED(forget)
    recorded b = {.scenario = shipped_with("corrected/first-impact", "motor.voltage=4")};
    DONE(run_scenario(&b.scenario, true, &b.result));
    const film_run runs[2] = {{&a.scenario, &a.result, "one"},
                              {&b.scenario, &b.result, "two"}};
    film_options options = small_film;
    options.width = 640;
    options.height = 480;
    options.view.plain = true;
    DONE(film_write(runs, 2, &options, "scale", &f));
    PIXELS(frame) = cairo_image_surface_create_from_png("scale/frame-00005.png");
    const int one = count_pixels_in(frame, 160, 318, 320, count_dark);
    const int four = count_pixels_in(frame, 482, 640, 320, count_dark);
    check_below(0, one);
    check_below(2.5 * one, four);
}

TEST(test_film)
{
    fault f = {0};
    if (film_file_check("film.mp4", &f) != STATUS_OK) {
        assert_non_null(strstr(f.text, "install the package ffmpeg"));
        skip();
    }
    FILMED(r, options, "corrected/plane-wall");
    const char *const names[] = {"film.mp4", "film.webm", "film.gif", "film.webp"};
    const char *const marks[] = {"ftypisom", "webm", "GIF89a", "WEBPVP8X"};
    for (int i = 0; i < 4; i++) {
        fail_if(film_of(&r, &options, names[i], &f) != STATUS_OK, "%s", f.text);
        check_contains(names[i], marks[i]);
    }
}

// Puts a program of the given text in the place of ffmpeg. Returns the old PATH.
static char *with_encoder(const char *text)
{
    char *old = strdup(getenv("PATH"));
    put_file("ffmpeg", text);
    assert_int_equal(chmod("ffmpeg", 0755), 0);
    setenv("PATH", formatted("%s:/bin:/usr/bin", test_folder), 1);
    return old;
}

static void restore_encoder(char **old)
{
    setenv("PATH", *old, 1);
    free(*old);
    unlink("ffmpeg");
}

// The same until the block is left.
#define ENCODER(text)                                                                    \
    SCOPED(restore_encoder) char *old_path = with_encoder(text);                         \
    (void)old_path

// An encoder that gives up is quoted, and nothing of the film is left.
TEST(test_encoder_fails)
{
    FILMED(r, options, "corrected/first-impact");
    ENCODER("#!/bin/sh\necho 'no such codec' >&2\nexit 1\n");
    int before = count_files(test_folder);
    REFUSED(STATUS_CANNOT_WRITE, "no such codec", film_of(&r, &options, "bad.mp4", &f));
    assert_int_equal(count_files(test_folder), before);
    setenv("PATH", "/nowhere", 1);
    REFUSED(STATUS_CANNOT_WRITE, "install the package ffmpeg",
            film_of(&r, &options, "bad.mp4", &f));
}

// A GIF has the size and the frames that were asked for: nothing scales or drops them.
TEST(test_gif_as_asked)
{
    FILMED(r, options, "corrected/first-impact");
    ENCODER("#!/bin/sh\ncat >/dev/null\nfor last; do :; done\n"
            "printf 'GIF89a %s;' \"$*\" >\"${last#file:}\"\n");
    DONE(film_of(&r, &options, "asked.gif", &f));
    check_contains("asked.gif", "-s 320x240 -r 10 ");
    assert_false(file_has("asked.gif", "scale="));
    assert_false(file_has("asked.gif", "fps="));
}

static volatile sig_atomic_t stopped;

static void stop_soon(void *context, int done, int total)
{
    (void)context;
    (void)total;
    stopped = done >= 2;
}

TEST(test_interrupted)
{
    FILMED(r, options, "corrected/first-impact");
    stopped = 0;
    options.progress = stop_soon;
    options.stop = &stopped;
    ENCODER("#!/bin/sh\ncat >/dev/null\n");
    int before = count_files(test_folder);
    REFUSED(STATUS_STOPPED, "stopped: 2 of 5 frames",
            film_of(&r, &options, "half.mp4", &f));
    assert_int_equal(count_files(test_folder), before);
}

// An error message is a failure for any status of the encoder, as with a full disk; and
// without one it must take all frames and leave something.
TEST(test_encoder_complains)
{
    static const struct {
        const char *script, *said;
    } cases[] = {
        {"#!/bin/sh\ncat >/dev/null\nfor last; do :; done\nprintf 'xxxxftyp' "
         ">\"${last#file:}\"\n"
         "echo 'av_interleaved_write_frame(): No space left on device' >&2\n",
         "No space left"},
        {"#!/bin/sh\ncat >/dev/null\n", "left no film"},
        {"#!/bin/sh\nfor last; do :; done\necho early >\"${last#file:}\"\n",
         "before the last frame"},
    };
    FILMED(r, options, "corrected/first-impact");

    // a film that was there before stays
    put_file("kept.mp4", "old");
    for (int i = 0; i < 3; i++) {
        ENCODER(cases[i].script);
        REFUSED(STATUS_CANNOT_WRITE, cases[i].said,
                film_of(&r, &options, "kept.mp4", &f));
        assert_holds("kept.mp4", "old");
    }
    unlink("kept.mp4");
}

static void stop_now(int number)
{
    (void)number;
    stopped = 1;
}

// An encoder that hangs, before the first frame or after the last, is left at the first
// signal.
TEST(test_encoder_hangs)
{
    FILMED(r, options, "corrected/first-impact");
    options.stop = &stopped;
    struct sigaction act = {.sa_handler = stop_now};
    sigaction(SIGALRM, &act, NULL);
    for (EACH_TEXT(c, "#!/bin/sh\ntrap '' TERM\nexec sleep 1000\n",
                   "#!/bin/sh\ncat >/dev/null\nexec sleep 1000\n")) {
        ENCODER(*c);
        int before = count_files(test_folder);
        stopped = 0;
        alarm(1);
        REFUSED(STATUS_STOPPED, "", film_of(&r, &options, "half.mp4", &f));
        assert_int_equal(count_files(test_folder), before);
    }
}

TEST(test_film_refused)
{
    FILMED(r, options, "corrected/first-impact");
    REFUSED(STATUS_BAD_ARGUMENT, ".webm", film_file_check("film.avi", &f));
    options.width = 321;
    REFUSED(STATUS_BAD_ARGUMENT, "", film_of(&r, &options, "odd.mp4", &f));
}

ALL_BETWEEN(enter_folder, tear_down)

// Pictures of the arm in space, and films of it.
//
// The golden pictures in tests/golden show no text, so that they depend on no font. A
// change of the drawing that is meant is taken over by running this test with
// IMPACTLAB_WRITE_GOLDENS=1 and looking at the new pictures before they are committed.
#include "tests/scene_fixture.h"

// --- geometry --------------------------------------------------------------------------

static double distance(vector a, vector b)
{
    vector d = vector_sum(a, -1, b);
    return sqrt(vector_dot(d, d));
}

enum { MOST_CURVE_LINKS = 40, MOST_CURVE_POINTS = 256 };

// The joints of a bent arm whose links are 1 m long.
static void bend_arm(int links, vector *joints)
{
    joints[0] = (vector){0};
    for (int k = 0; k < links; k++) {
        double angle = 0.3 + 0.5 * sin(k);
        joints[k + 1] = vector_add(joints[k], (vector){cos(angle), sin(angle), 0});
    }
}

// The cosine of the angle between a piece of the curve and a link of 1 m.
static double cosine_to_link(vector piece, vector link)
{
    return vector_dot(vector_unit(piece), link);
}

// The first and the last piece of the curve lie along the outer links. A piece is a chord
// of a parabola: the first of n chords leans against the link by about sin(b) / (2 n), b
// being the angle of the bend, which is below 0.5 rad here. A lean of 1.5 / n is allowed,
// with n the points per link. The cosine of a lean differs from 1 by less than its
// square.
static void check_curve_ends(const vector *joints, int links, const vector *curve,
                             int count)
{
    double points_per_link = count / (double)links;
    double lean = links == 1 ? 1e-7 : 1.5 / points_per_link;

    vector first_piece = vector_sum(curve[1], -1, curve[0]);
    vector first_link = vector_sum(joints[1], -1, joints[0]);
    check_close(cosine_to_link(first_piece, first_link), 1, lean * lean);

    vector last_piece = vector_sum(curve[count - 1], -1, curve[count - 2]);
    vector last_link = vector_sum(joints[links], -1, joints[links - 1]);
    check_close(cosine_to_link(last_piece, last_link), 1, lean * lean);
}

static double distance_to_curve(vector point, const vector *curve, int count)
{
    double nearest = HUGE_VAL;
    for (int i = 0; i < count; i++) {
        nearest = fmin(nearest, distance(curve[i], point));
    }
    return nearest;
}

// The curve starts and ends where the arm does, along its outer links, and has a point in
// the middle of every inner link.
TEST(test_curve)
{
    for (EACH_OF(int, links, 1, 2, 3, 40)) {
        vector joints[MOST_CURVE_LINKS + 1], curve[MOST_CURVE_POINTS];
        assert_in_range(scene_curve_length(*links), 2, MOST_CURVE_POINTS);
        bend_arm(*links, joints);
        int count = scene_curve(joints, *links, curve);
        assert_int_equal(count, scene_curve_length(*links));

        // the ends
        check_close(distance(curve[0], joints[0]), 0, 1e-15);
        check_close(distance(curve[count - 1], joints[*links]), 0, 1e-15);
        check_curve_ends(joints, *links, curve, count);

        // the inner links
        for (int k = 1; k + 1 < *links; k++) {
            vector middle = vector_scaled(vector_add(joints[k], joints[k + 1]), 0.5);
            check_close(distance_to_curve(middle, curve, count), 0, 1e-12);
        }
    }
}

// At the instant of a row the joints have the angles of that row; halfway between two
// rows the last angle is the mean of theirs.
TEST(test_joints)
{
    SCOPED(forget) recorded r = record("corrected/five-links");
    const trace *t = &r.result.trace;
    const parameters *p = &r.scenario.parameters;
    vector joints[6];

    // a row in the middle of the run, the last one of its instant
    size_t row = t->row_count / 2;
    while (t->rows[row].time == t->rows[row + 1].time) {
        row++;
    }

    // the joints at that row
    scene_joints(t, p, t->rows[row].time, joints);
    const double *angles =
        t->angles + (row + 1) * (size_t)t->angle_count - 5; // behind the hub's
    for (int k = 0; k < 5; k++) {
        check_close(atan2(joints[k + 1].y - joints[k].y, joints[k + 1].x - joints[k].x),
                    angles[k], 1e-12);
        check_close(distance(joints[k + 1], joints[k]), p->arm.length / 5, 1e-12);
    }

    // halfway to the next row
    sample half =
        scene_joints(t, p, (t->rows[row].time + t->rows[row + 1].time) / 2, joints);
    check_close(half.last_angle,
                (t->rows[row].last_angle + t->rows[row + 1].last_angle) / 2, 1e-9);

    // after the end of the run the arm stays where it is
    check_close(scene_joints(t, p, 1e9, joints).last_angle, LAST_ROW(t)->last_angle,
                1e-15);
}

// The instants of a series of pictures begin with the run, increase, and end with the
// peak of the first pulse.
TEST(test_instants)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const summary *m = &r.result.summary;
    double times[6];
    scene_instants(&r.result, times, 6);
    check_close(times[0], 0, 1e-15);
    for (int i = 1; i < 6; i++) {
        check_below(times[i - 1], times[i]);
    }
    check_close(times[5], m->first_contact_s + m->first_pulse_time_to_peak_s, 1e-12);
}

// Each point to be seen lies within the window of the picture, and together they fill
// nearly all of its width (0.8) or of its height (0.75).
TEST(test_camera)
{
    const vector points[] = {{0, 0, 0.1},
                             {1, 0.2, -0.1},
                             {0.9, -0.4, 0},
                             {0.2, 0.3, 0.05}};
    const camera_window window = {0.1, 0.05, 0.9, 0.8};
    const camera_view kinds[] = {{CAMERA_THREE_QUARTER, 0, 0},
                                 {CAMERA_TOP, 0, 0},
                                 {CAMERA_SIDE, 0, 0},
                                 {CAMERA_FREE, 120, 25}};
    for (size_t k = 0; k < 4; k++) {
        camera c = camera_fit(kinds[k], 0.1, points, 4, 640, 360, window);
        double left = 1, right = 0, top = 1, bottom = 0;
        for (size_t i = 0; i < 4; i++) {
            // its place in the picture, and its depth between the nearest and the
            // farthest
            vector at = camera_project(&c, points[i]);
            left = fmin(left, at.x / 640);
            right = fmax(right, at.x / 640);
            top = fmin(top, at.y / 360);
            bottom = fmax(bottom, at.y / 360);
            check_below(c.nearest, at.z);
            check_below(at.z, c.farthest);

            // the ray through that place of the picture leads back to the point
            vector ray = camera_ray(&c, at.x, at.y);
            check_close(distance(vector_sum(c.eye, at.z, ray), points[i]), 0, 1e-9);
        }

        // the window
        check_below(window.left - 0.01, left);
        check_below(right, window.right + 0.01);
        check_below(window.top - 0.01, top);
        check_below(bottom, window.bottom + 0.01);
        assert_true(right - left > 0.75 || bottom - top > 0.7);
    }

    // in a plan, turned by a heading of 0.7 rad, that direction points to the right
    camera plan =
        camera_fit((camera_view){.kind = CAMERA_TOP}, 0.7, points, 4, 640, 360, window);
    vector hub = camera_project(&plan, (vector){0}),
           ahead = camera_project(&plan, (vector){cos(0.7), sin(0.7), 0});
    check_close(hub.y, ahead.y, 1);
    check_below(hub.x, ahead.x);
}

// --- pictures --------------------------------------------------------------------------

// The beam is there, the arrow only while the wall pushes.
TEST(test_content)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const scene_options cairo = {.renderer = RENDER_CAIRO, .plain = true};
    double before = 0.1, peak = 0.3634, pair[] = {0, 0.3634};
    PIXELS(free_arm) = scene_picture_of(&r, cairo, &before, 1);
    PIXELS(pushed) = scene_picture_of(&r, cairo, &peak, 1);
    PIXELS(both) = scene_picture_of(&r, cairo, pair, 2);
    assert_in_range(count_pixels(free_arm, count_beam), 500, 8000);
    assert_in_range(count_pixels(pushed, count_beam), 500, 8000);
    assert_int_equal(count_pixels(free_arm, count_arrow), 0);
    assert_in_range(count_pixels(pushed, count_arrow), 40, 4000);
    // the ghost of the earlier arm hides nothing of the later one
    check_close(count_pixels(both, count_beam), count_pixels(pushed, count_beam), 60);
    check_below(200, count_different(both, pushed, 20));
}

// Presets, and two given angles.
TEST(test_camera_words)
{
    camera_view view;
    assert_true(camera_read("tip", &view));
    assert_int_equal(view.kind, CAMERA_TIP);
    assert_true(camera_read("-60,40.5", &view));
    assert_int_equal(view.kind, CAMERA_FREE);
    check_close(view.azimuth, -60, 0);
    check_close(view.elevation, 40.5, 0);
    for (EACH_TEXT(c, "", "front", "10", "10,", "10,0", "400,40", "1,2,3")) {
        assert_false(camera_read(*c, &view));
    }
}

// Bending is drawn larger, while hub and tip stay where they are: the beam covers other
// pixels, the arrow at its tip the same.
TEST(test_exaggerated)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double peak = 0.3634;
    scene_options o = {.renderer = RENDER_CAIRO,
                       .plain = true,
                       .camera = {.kind = CAMERA_TOP}};
    PIXELS(by_itself) = scene_picture_of(&r, o, &peak, 1);
    o.exaggerate = 1;
    PIXELS(as_it_is) = scene_picture_of(&r, o, &peak, 1);
    o.exaggerate = 5;
    PIXELS(larger) = scene_picture_of(&r, o, &peak, 1);
    assert_int_equal(count_different(by_itself, larger, 0), 0);
    check_below(300, count_different(as_it_is, larger, 20));
    check_close(count_pixels(larger, count_arrow), count_pixels(as_it_is, count_arrow),
                12);
}

// How far the curve of an arm lies from the line from hub to tip at the most, in a run
// whose bending is enlarged [beam lengths].
static double largest_bend(const recorded *r, double factor)
{
    vector joints[MOST_CURVE_LINKS + 1], curve[MOST_CURVE_POINTS];
    const trace *t = &r->result.trace;
    const int links = r->scenario.parameters.arm.links;
    double bend = 0;
    for (size_t i = 0; i < t->row_count; i++) {
        scene_joints(t, &r->scenario.parameters, t->rows[i].time, joints);
        scene_exaggerate(joints, links, factor);
        const int count = scene_curve(joints, links, curve);
        const double chord = atan2(joints[links].y, joints[links].x);
        for (int k = 0; k < count; k++) {
            bend = fmax(bend, fabs(curve[k].y * cos(chord) - curve[k].x * sin(chord)));
        }
    }
    return bend / r->scenario.parameters.arm.length;
}

// By itself the bending is enlarged so far that it shows, and no further, however stiff
// the arm is; a single link has none.
TEST(test_bending_that_shows)
{
    for (EACH_TEXT(name, "corrected/first-impact", "corrected/stiff-beam",
                   "corrected/twenty-links")) {
        SCOPED(forget) recorded r = record(*name);
        const double bend = largest_bend(&r, scene_bending_auto(&r.scenario, &r.result));
        check_below(0.03, bend);
        check_below(bend, 0.09);
    }

    SCOPED(forget)
    recorded one = {.scenario = shipped_with("corrected/first-impact", "arm.links=1")};
    DONE(run_scenario(&one.scenario, true, &one.result));
    check_close(scene_bending_auto(&one.scenario, &one.result), 1, 0);
}

// Every word of a picture lies inside it, and the force's on no solid: where its place
// beyond the arrow's point is taken, it goes round the point.
TEST(test_label_stands_clear)
{
    enum { TAKEN = 60 };
    const camera picture = {.width = 300, .height = 200};
    const text_size size = {60, 20};
    const vector point = {150, 100}, right = {1, 0};
    taken_cells t = {0};
    taken_begin(&t, &picture);
    const figure_rect ahead = taken_clear_box(&t, point, right, size, &picture);
    check_below(point.x, ahead.x);

    // all that is right of the point is taken, then all but a corner
    taken_add_box(&t, (figure_rect){150, 0, 150, 200});
    const figure_rect aside = taken_clear_box(&t, point, right, size, &picture);
    check_below(aside.x + aside.width, 150);
    taken_add_box(&t, (figure_rect){0, 0, 300, 200});
    const figure_rect none = taken_clear_box(&t, (vector){299, 1}, right, size, &picture);
    check_below(none.x + none.width, 300);
    check_below(0, none.y);
    taken_finish(&t);
}

// The inset shows the contact at least twice as large, whatever the picture's size and
// camera.
TEST(test_inset_magnifies)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const int sizes[][2] = {{1280, 720}, {640, 640}, {300, 900}, {669, 535}};
    for (size_t i = 0; i < G_N_ELEMENTS(sizes); i++) {
        for (camera_kind kind = CAMERA_THREE_QUARTER; kind <= CAMERA_SIDE; kind++) {
            scene *sc;
            const scene_options o = {.renderer = RENDER_CAIRO,
                                     .camera = {.kind = kind},
                                     .inset = true,
                                     .samples = 1,
                                     .width = sizes[i][0],
                                     .height = sizes[i][1]};
            DONE(scene_create(&sc, &r.scenario, &r.result, &o, &f));
            const sample row = scene_shape(sc, 0.3634);
            const vector at = scene_contact(sc, &row);
            check_below(2 * labels_pixels(&sc->camera, at, 1),
                        labels_pixels(&sc->tip->camera, at, 1));
            scene_destroy(sc);
        }
    }
}

// In greys no pixel has a colour.
TEST(test_mono)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double peak = 0.3634;
    const scene_options o = {.renderer = RENDER_CAIRO,
                             .inset = true,
                             .theme = THEME_MONO};
    PIXELS(grey) = scene_picture_of(&r, o, &peak, 1);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const unsigned pixel = pixel_at(grey, x, y);
            assert_int_equal(channel_of(pixel, 0), channel_of(pixel, 1));
            assert_int_equal(channel_of(pixel, 1), channel_of(pixel, 2));
        }
    }
}

// Four samples a pixel's edge are the same picture as two but for edges, without steps
// between.
TEST(test_samples)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double peak = 0.3634;
    scene_options o = {.renderer = RENDER_CAIRO, .plain = true, .samples = SAMPLES_QUICK};
    PIXELS(quick) = scene_picture_of(&r, o, &peak, 1);
    o.samples = SAMPLES_FINE;
    PIXELS(fine) = scene_picture_of(&r, o, &peak, 1);
    check_below(count_different(quick, fine, 40), WIDTH * HEIGHT / 200);
    check_below(0, count_different(quick, fine, 4));
}

// Where the floor fades, squares of 8 x 8 pixels that hold no line mix two levels: a
// gradient without dithering would be flat in nearly all of them and jump between.
TEST(test_no_bands)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double start = 0;
    int smooth = 0, mixed = 0;
    PIXELS(s) = scene_picture_of(&r,
                                 (scene_options){.renderer = RENDER_CAIRO,
                                                 .plain = true,
                                                 .width = 640,
                                                 .height = 360},
                                 &start, 1);
    for (int y = 0; y + 8 <= 360; y += 8) {
        for (int x = 0; x + 8 <= 640; x += 8) {
            int low = 255, high = 0;
            for (int i = 0; i < 64; i++) {
                int level = channel_of(pixel_at(s, x + i % 8, y + i / 8), 1);
                low = level < low ? level : low;
                high = level > high ? level : high;
            }
            smooth += high - low <= 1 && low > 243 && high < 255;
            mixed += high - low == 1 && low > 243 && high < 255;
        }
    }
    check_below(100, smooth);
    check_below(smooth / 2, mixed);
}

static const struct {
    const char *file, *scenario;
    camera_kind camera;
    double times[3];
    int count;
} goldens[] = {
    {"scene-point.png",
     "corrected/first-impact",
     CAMERA_THREE_QUARTER,
     {0.0, 0.2, 0.3634},
     3},
    {"scene-plane.png", "corrected/plane-wall", CAMERA_TOP, {0.1, 0.36}, 2},
    {"scene-side.png", "corrected/twenty-links", CAMERA_SIDE, {0.2}, 1},
};

static void compare_golden(size_t index, scene_renderer renderer, const char *name)
{
    SCOPED(forget) recorded r = record(goldens[index].scenario);
    const scene_options options = {.camera = {.kind = goldens[index].camera},
                                   .renderer = renderer,
                                   .plain = true};
    PIXELS(drawn) =
        scene_picture_of(&r, options, goldens[index].times, goldens[index].count);
    const char *path =
        formatted("%s/%s", getenv("IMPACTLAB_GOLDENS"), goldens[index].file);
    if (getenv("IMPACTLAB_WRITE_GOLDENS") != NULL && renderer == RENDER_CAIRO) {
        assert_int_equal(cairo_surface_write_to_png(drawn, path), CAIRO_STATUS_SUCCESS);
    }
    PIXELS(golden) = cairo_image_surface_create_from_png(path);
    assert_int_equal(cairo_surface_status(golden), CAIRO_STATUS_SUCCESS);
    int different = count_different(drawn, golden, 12);
    if (different > WIDTH * HEIGHT / 500) {
        cairo_surface_write_to_png(drawn, goldens[index].file);
        fail_msg(
            "%s by %s: %d of %d pixels differ by more than 12 levels, the picture is %s",
            goldens[index].file, name, different, WIDTH * HEIGHT, goldens[index].file);
    }
}

TEST(test_golden_cairo)
{
    for (size_t i = 0; i < sizeof goldens / sizeof goldens[0]; i++) {
        compare_golden(i, RENDER_CAIRO, "cairo");
    }
}

TEST(test_golden_gl)
{
    bool any = false;
    for (scene_renderer which = RENDER_OSMESA; which <= RENDER_EGL; which++) {
        for (size_t i = 0; i < sizeof goldens / sizeof goldens[0] && is_there(which);
             i++) {
            compare_golden(i, which, which == RENDER_EGL ? "EGL" : "OSMesa");
            any = true;
        }
    }
    if (!any) {
        skip();
    }
}

// The file says what drew it, and a second one has the same bytes.
TEST(test_file)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double time = 0.3;
    const scene_picture p = {.scenario = &r.scenario,
                             .result = &r.result,
                             .options = {.renderer = RENDER_CAIRO,
                                         .width = WIDTH,
                                         .height = HEIGHT},
                             .times = &time,
                             .count = 1};
    DONE(scene_write(&p, "first.png", &f));
    for (EACH_TEXT(c, "Renderer", "cairo ", "scenario=corrected/first-impact",
                   "motor.voltage=1")) {
        check_contains("first.png", *c);
    }
    DONE(scene_write(&p, "second.png", &f));
    assert_int_equal(system("cmp first.png second.png"), 0);
}

// A wall that moves is drawn where the tip lies on it, at rows and between them.
TEST(a_wall_that_moves_is_drawn_at_the_tip)
{
    SCOPED(forget)
    recorded r = {
        .scenario =
            shipped_with("corrected/first-impact",
                         "wall.kind=plane wall.motion=sine wall.motion_amplitude=0.02")};
    const parameters *p = &r.scenario.parameters;
    DONE(run_scenario(&r.scenario, true, &r.result));
    const trace *t = &r.result.trace;
    double farthest = 0;
    for (size_t i = 0; i + 1 < t->row_count; i++) {
        vector joints[3];
        const double between = (t->rows[i].time + t->rows[i + 1].time) / 2;
        const sample row = scene_joints(t, p, between, joints);
        if (t->rows[i].contact != 0 && t->rows[i + 1].contact != 0) {
            const vector normal = {-sin(p->wall.angle), cos(p->wall.angle), 0};
            const vector shift = scene_wall_shift(p, &row);
            check_close(vector_dot(vector_sum(joints[2], -1, shift), normal), 0, 1e-6);
            farthest = fmax(farthest, vector_dot(shift, shift));
        }
    }
    assert_true(farthest > 1e-5);
}

TEST(test_refused)
{
    SCOPED(forget) recorded r = record("corrected/first-impact");
    const double late = 7, good = 0.1;
    scene_picture p = {.scenario = &r.scenario,
                       .result = &r.result,
                       .options = {.renderer = RENDER_CAIRO,
                                   .width = WIDTH,
                                   .height = HEIGHT},
                       .times = &late,
                       .count = 1};
    REFUSED(STATUS_BAD_ARGUMENT, "7 s", scene_write(&p, "x.png", &f));
    p.times = &good;
    REFUSED(STATUS_BAD_ARGUMENT, "", scene_write(&p, "x.jpg", &f));
    REFUSED(STATUS_CANNOT_WRITE, "", scene_write(&p, "/nowhere/x.png", &f));
    p.options.width = 3;
    REFUSED(STATUS_BAD_ARGUMENT, "", scene_write(&p, "x.png", &f));
    assert_int_not_equal(access("x.png", F_OK), 0);
}

int main(void)
{
    // one software renderer, the same on every machine
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    return run_cases(enter_folder, tear_down);
}

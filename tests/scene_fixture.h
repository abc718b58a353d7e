// Recorded runs, a folder for files, and ways to look at pictures of the arm.
#pragma once

#include "tests/shipped_scenario.h"

#include <dirent.h>

#include "render/scene/scene_parts.h"
#include "render/page/text.h"

enum { WIDTH = 320, HEIGHT = 180 };

// Pixels that go when their block is left: PIXELS(image) = paint_pixels(...);
GIVEN_BACK(cairo_surface_t, cairo_surface_destroy)
#define PIXELS(name) SCOPED(cairo_surface_destroy_kept) cairo_surface_t *name

typedef struct recorded {
    scenario scenario;
    run_result result;
} recorded;

static inline recorded record(const char *name)
{
    const scenario s = shipped(name);
    return (recorded){s, run_done(&s, true)};
}

static inline void forget(recorded *r)
{
    run_finish(&r->result);
    scenario_finish(&r->scenario);
}

// True if a renderer can be had here.
static inline bool is_there(scene_renderer which)
{
    scene_painter *painter;
    if (scene_painter_create(&painter, which, 16, 16, SAMPLES_QUICK, NULL) != STATUS_OK) {
        return false;
    }
    scene_painter_destroy(painter);
    return true;
}

static inline cairo_surface_t *scene_picture_of(const recorded *r, scene_options options,
                                                const double *times, int count)
{
    scene *sc;
    options.width = options.width ? options.width : WIDTH;
    options.height = options.height ? options.height : HEIGHT;
    DONE(scene_create(&sc, &r->scenario, &r->result, &options, &f));
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, options.width, options.height);
    DONE(scene_paint(sc, times, count, surface, &f));
    scene_destroy(sc);
    cairo_surface_flush(surface);
    return surface;
}

static inline unsigned pixel_at(cairo_surface_t *s, int x, int y)
{
    const unsigned char *data = cairo_image_surface_get_data(s);
    unsigned pixel;
    memcpy(&pixel, data + (ptrdiff_t)y * cairo_image_surface_get_stride(s) + 4 * x,
           sizeof pixel);
    return pixel & 0xFFFFFF;
}

static inline int channel_of(unsigned pixel, int index)
{
    return (int)(pixel >> (16 - 8 * index) & 255);
}

// Pixels as blue as the beam, or as red as the arrow.
static inline int count_beam(unsigned pixel)
{
    return channel_of(pixel, 2) > channel_of(pixel, 0) + 90;
}

static inline int count_arrow(unsigned pixel)
{
    return channel_of(pixel, 0) > channel_of(pixel, 2) + 140 &&
           channel_of(pixel, 0) > channel_of(pixel, 1) + 70;
}

// Pixels of a kind from one column to another, in rows above one.
static inline int count_pixels_in(cairo_surface_t *s, int from, int to, int bottom,
                                  int (*counts)(unsigned))
{
    int count = 0;
    for (int y = 0; y < bottom; y++) {
        for (int x = from; x < to; x++) {
            count += counts(pixel_at(s, x, y));
        }
    }
    return count;
}

static inline int count_pixels(cairo_surface_t *s, int (*counts)(unsigned))
{
    return count_pixels_in(s, 0, cairo_image_surface_get_width(s),
                           cairo_image_surface_get_height(s), counts);
}

// Pixels that differ by more than `tolerance` levels in some channel.
static inline int count_different(cairo_surface_t *a, cairo_surface_t *b, int tolerance)
{
    int count = 0;
    assert_int_equal(cairo_image_surface_get_width(a), cairo_image_surface_get_width(b));
    assert_int_equal(cairo_image_surface_get_height(a),
                     cairo_image_surface_get_height(b));
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

static inline void check_contains(const char *path, const char *text)
{
    fail_if(!file_has(path, text), "'%s' is not in %s", text, path);
}

static inline int tear_down(void **state)
{
    pango_cairo_font_map_set_default(NULL); // what Pango keeps for later figures
    return leave_folder(state);
}

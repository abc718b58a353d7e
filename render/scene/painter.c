#include "render/scene/painter.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/scene/gl_offscreen.h"

struct scene_painter {
    gl_offscreen *gl; // NULL: the depth buffer below is used
    int width, height;
    int samples; // of a pixel along each edge
    char name[300];
    // of all samples: 0xAARRGGBB, a region's rows without gaps where OpenGL paints; else of the
    // whole picture, and between pictures 0 with depths of FARTHEST
    uint32_t *pixels;
    gl_vertex *vertices;
    size_t vertex_capacity;
    float *depths;          // of the samples; NULL where OpenGL paints
    unsigned char *touched; // which tiles of the picture hold something
    int tiles_across, tiles_down;
};

enum { TILE = 16 }; // edge of a tile [pixels]

#define FARTHEST 2.0F // deeper than everything

bool scene_renderer_find(const char *name, scene_renderer *which)
{
    assert(name != NULL && which != NULL);
    static const char *const names[] = {"auto", "osmesa", "egl", "cairo"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(names[i], name) == 0) {
            *which = (scene_renderer)i;
            return true;
        }
    }
    return false;
}

static status complain_memory(const scene_painter *p, fault *f)
{
    return fault_set(f, STATUS_NO_MEMORY, "no memory for a scene of %d x %d pixels", p->width,
                     p->height);
}

// Opens the renderer asked for, or the first that is there.
static status open_renderer(scene_painter *p, scene_renderer which, fault *f)
{
    int width = p->samples * p->width, height = p->samples * p->height;
    status code = STATUS_OK;

    // OSMesa is tried first: it needs no driver
    if (which == RENDER_OSMESA || which == RENDER_AUTO) {
        code = gl_offscreen_create(&p->gl, GL_OSMESA, width, height, f);
    }
    if (which == RENDER_EGL || (which == RENDER_AUTO && p->gl == NULL)) {
        code = gl_offscreen_create(&p->gl, GL_EGL, width, height, f);
    }

    if (p->gl != NULL) {
        snprintf(p->name, sizeof p->name, "%s", gl_offscreen_renderer(p->gl));
        return STATUS_OK;
    }
    if (which != RENDER_AUTO && which != RENDER_CAIRO) {
        return code;
    }

    // drawing by hand needs only memory for the depths
    snprintf(p->name, sizeof p->name, "cairo %s, own depth buffer", cairo_version_string());
    size_t count = (size_t)width * (size_t)height;
    p->depths = malloc(count * sizeof *p->depths);
    for (size_t i = 0; i < count && p->depths != NULL; i++) {
        p->depths[i] = FARTHEST;
    }
    return p->depths ? STATUS_OK : complain_memory(p, f);
}

status scene_painter_create(scene_painter **out, scene_renderer which, int width, int height,
                            int samples, fault *f)
{
    assert(out != NULL && width > 0 && height > 0 && samples > 0);
    scene_painter *p = calloc(1, sizeof *p);
    *out = NULL;
    if (p != NULL) {
        p->width = width;
        p->height = height;
        p->samples = samples;
        p->tiles_across = (width + TILE - 1) / TILE;
        p->tiles_down = (height + TILE - 1) / TILE;
        p->pixels =
            calloc((size_t)width * (size_t)height, (size_t)(samples * samples) * sizeof(uint32_t));
        p->touched = malloc((size_t)p->tiles_across * (size_t)p->tiles_down);
    }

    if (p == NULL || p->pixels == NULL || p->touched == NULL) {
        scene_painter_destroy(p);
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a scene of %d x %d pixels", width,
                         height);
    }

    status code = open_renderer(p, which, f);
    if (code != STATUS_OK) {
        scene_painter_destroy(p);
        return code;
    }
    *out = p;
    return STATUS_OK;
}

void scene_painter_destroy(scene_painter *p)
{
    if (p != NULL) {
        gl_offscreen_destroy(p->gl);
        free(p->pixels);
        free(p->vertices);
        free(p->depths);
        free(p->touched);
        free(p);
    }
}

const char *scene_painter_name(const scene_painter *p)
{
    assert(p != NULL);
    return p->name;
}

// ---- light

#define AMBIENT_SKY    0.50 // light from above, everywhere
#define AMBIENT_GROUND 0.26 // light that the floor throws back
#define LAMP           0.62
#define FILL           0.14 // light from the side opposite to the lamp
#define HIGHLIGHT      0.55
#define HIGHLIGHT_EDGE 36.0 // how narrow highlights are

static double to_linear(double shade)
{
    return pow(shade, 2.2);
}

static float to_screen(double light)
{
    return (float)pow(fmin(1, fmax(0, light)), 1 / 2.2);
}

// The colour in which the camera sees a vertex: light from the sky, a lamp and a weaker one across,
// and the lamp's highlight (Blinn 1977).
static void light_vertex(const mesh_vertex *v, const camera *c, vector light, float rgba[4])
{
    vector view = vector_unit(vector_sum(c->eye, -1, v->place));

    // lamp, weaker lamp and sky, each by the angle at which it falls in
    double lamp = fmax(0, vector_dot(v->normal, light));
    vector across = vector_unit((vector){-light.x, -light.y, 0.4});
    double fill = fmax(0, vector_dot(v->normal, across));
    double sky = 0.5 + 0.5 * v->normal.z;
    double sum = AMBIENT_GROUND + (AMBIENT_SKY - AMBIENT_GROUND) * sky + LAMP * lamp + FILL * fill;

    // brightest where the normal halves the angle between lamp and eye
    double glance = fmax(0, vector_dot(v->normal, vector_unit(vector_add(light, view))));
    double shine = HIGHLIGHT * v->material.shine * pow(glance, HIGHLIGHT_EDGE);

    // lights add up in linear colours only
    rgba[0] = to_screen(to_linear(v->material.colour.red) * sum + shine);
    rgba[1] = to_screen(to_linear(v->material.colour.green) * sum + shine);
    rgba[2] = to_screen(to_linear(v->material.colour.blue) * sum + shine);
    rgba[3] = 1;
}

// ---- triangles

static status make_room(scene_painter *p, const mesh *m, fault *f)
{
    if (m->vertex_count > p->vertex_capacity) {
        free(p->vertices);
        p->vertices = malloc(m->vertex_count * sizeof *p->vertices);
        p->vertex_capacity = p->vertices ? m->vertex_count : 0;
    }
    if (m->out_of_memory || p->vertex_capacity < m->vertex_count) {
        return complain_memory(p, f);
    }
    return STATUS_OK;
}

// Lights the vertices and finds their places: clip coordinates whose w is the depth. Returns the
// pixels that they cover.
static gl_region project(scene_painter *p, const mesh *m, const camera *c, vector light)
{
    double left = p->width, right = 0, top = p->height, bottom = 0;
    double span = c->farthest - c->nearest;

    // vertices in OpenGL's clip coordinates, lit
    for (size_t i = 0; i < m->vertex_count; i++) {
        vector at = camera_project(c, m->vertices[i].place);
        gl_vertex *v = &p->vertices[i];
        // y stays down: the rows that are read back are then the picture's, from its top
        v->place[0] = (float)((2 * at.x / c->width - 1) * at.z);
        v->place[1] = (float)((2 * at.y / c->height - 1) * at.z);
        v->place[2] =
            (float)(((c->farthest + c->nearest) * at.z - 2 * c->farthest * c->nearest) / span);
        v->place[3] = (float)at.z;
        light_vertex(&m->vertices[i], c, light, v->colour);

        // the box round all of them
        left = fmin(left, at.x);
        right = fmax(right, at.x);
        top = fmin(top, at.y);
        bottom = fmax(bottom, at.y);
    }

    // whole pixels within the picture
    int x = (int)fmax(0, floor(left)), y = (int)fmax(0, floor(top));
    int x_end = (int)fmin(p->width, ceil(right)), y_end = (int)fmin(p->height, ceil(bottom));
    return (gl_region){x, y, x_end - x, y_end - y};
}

// A quantity that is linear over the picture: value at the first corner and growth per sample.
typedef struct ramp {
    float start, right, down;
} ramp;

// A triangle in samples of the picture.
typedef struct flat_triangle {
    float x[3], y[3], twice_area;
} flat_triangle;

static ramp ramp_of(const flat_triangle *t, float a, float b, float c)
{
    float right = ((b - a) * (t->y[2] - t->y[0]) - (c - a) * (t->y[1] - t->y[0])) / t->twice_area;
    float down = ((c - a) * (t->x[1] - t->x[0]) - (b - a) * (t->x[2] - t->x[0])) / t->twice_area;
    return (ramp){a - right * t->x[0] - down * t->y[0], right, down};
}

static float ramp_at(ramp r, float x, float y)
{
    return r.start + r.right * x + r.down * y;
}

static uint32_t channel(float shade)
{
    return shade <= 0 ? 0 : shade >= 1 ? 255 : (uint32_t)(shade * 255 + 0.5F);
}

static int bounded(float value, int most)
{
    return value <= 0 ? 0 : value >= (float)most ? most : (int)value;
}

// The columns of a row in which a ramp may be above zero: narrows [*from, *to), a column to spare.
static void narrow(ramp r, float y, int *from, int *to)
{
    float value = ramp_at(r, 0.5F, y); // in column 0
    if (r.right > 0) {
        int first = bounded(-value / r.right - 1, *to);
        *from = first > *from ? first : *from;
    } else if (r.right < 0) {
        int end = bounded(-value / r.right + 3, *to);
        *to = end < *to ? end : *to;
    } else if (value < 0) {
        *to = *from;
    }
}

// Fills the samples whose centres lie in the triangle and nearer than what is there.
static void fill_triangle(scene_painter *p, const flat_triangle *t, const gl_vertex *const v[3])
{
    const int width = p->samples * p->width, height = p->samples * p->height;
    ramp share[3], depth, tint[3];

    // barycentric shares, colour and depth change linearly over the picture
    for (int k = 0; k < 3; k++) {
        share[k] = ramp_of(t, k == 0, k == 1, k == 2);
        tint[k] = ramp_of(t, v[0]->colour[k], v[1]->colour[k], v[2]->colour[k]);
    }
    depth = ramp_of(t, v[0]->place[2] / v[0]->place[3], v[1]->place[2] / v[1]->place[3],
                    v[2]->place[2] / v[2]->place[3]);

    // the rows and columns that it may touch
    int top = bounded(fminf(t->y[0], fminf(t->y[1], t->y[2])), height);
    int bottom = bounded(fmaxf(t->y[0], fmaxf(t->y[1], t->y[2])) + 1, height);
    int left = bounded(fminf(t->x[0], fminf(t->x[1], t->x[2])), width);
    int right = bounded(fmaxf(t->x[0], fmaxf(t->x[1], t->x[2])) + 1, width);

    for (int row = top; row < bottom; row++) {
        // of these only what may be inside
        float y = (float)row + 0.5F;
        int from = left, to = right;
        for (int k = 0; k < 3; k++) {
            narrow(share[k], y, &from, &to);
        }

        ptrdiff_t at = (ptrdiff_t)row * width + from;
        for (int column = from; column < to; column++, at++) {
            // inside, and nearer than what is there
            float x = (float)column + 0.5F, z = ramp_at(depth, x, y);
            if (ramp_at(share[0], x, y) >= 0 && ramp_at(share[1], x, y) >= 0 &&
                ramp_at(share[2], x, y) >= 0 && z < p->depths[at]) {
                p->depths[at] = z;
                p->pixels[at] = 0xFF000000U | channel(ramp_at(tint[0], x, y)) << 16 |
                                channel(ramp_at(tint[1], x, y)) << 8 |
                                channel(ramp_at(tint[2], x, y));
            }
        }
    }
}

// Corners of a triangle in samples; false if it is seen edge-on and covers nothing.
static bool flatten(const scene_painter *p, const gl_vertex *const v[3], flat_triangle *t)
{
    for (size_t k = 0; k < 3; k++) {
        const float *at = v[k]->place;
        t->x[k] = (at[0] / at[3] + 1) * (float)(p->width * p->samples) / 2;
        t->y[k] = (at[1] / at[3] + 1) * (float)(p->height * p->samples) / 2;
    }
    t->twice_area =
        (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (t->x[2] - t->x[0]) * (t->y[1] - t->y[0]);
    return fabsf(t->twice_area) > 1e-6F;
}

// Remembers the tiles that a triangle may touch.
static void touch_tiles(scene_painter *p, const flat_triangle *t)
{
    const float tile = (float)(TILE * p->samples);
    int left = bounded(fminf(t->x[0], fminf(t->x[1], t->x[2])) / tile, p->tiles_across - 1);
    int right = bounded(fmaxf(t->x[0], fmaxf(t->x[1], t->x[2])) / tile, p->tiles_across - 1);
    int top = bounded(fminf(t->y[0], fminf(t->y[1], t->y[2])) / tile, p->tiles_down - 1);
    int bottom = bounded(fmaxf(t->y[0], fmaxf(t->y[1], t->y[2])) / tile, p->tiles_down - 1);
    for (int row = top; row <= bottom; row++) {
        memset(p->touched + (ptrdiff_t)row * p->tiles_across + left, 1, (size_t)(right - left + 1));
    }
}

// Finds the tiles that the mesh touches; without OpenGL paints every triangle into the depth
// buffer.
static void paint_triangles(scene_painter *p, const mesh *m)
{
    memset(p->touched, 0, (size_t)p->tiles_across * (size_t)p->tiles_down);
    for (size_t i = 0; i + 2 < m->corner_count; i += 3) {
        flat_triangle t;
        const gl_vertex *const v[3] = {&p->vertices[m->corners[i]], &p->vertices[m->corners[i + 1]],
                                       &p->vertices[m->corners[i + 2]]};
        if (flatten(p, v, &t)) {
            touch_tiles(p, &t);
            if (p->gl == NULL) {
                fill_triangle(p, &t, v);
            }
        }
    }
}

// Two of a pixel's four channels, with room for sums.
#define PAIR 0x00FF00FFU

// The mean of a pixel's samples x samples, as much of it as the opacity [1/256] lets through.
static inline uint32_t mean_of(int samples, const uint32_t *first, ptrdiff_t across,
                               uint32_t opacity)
{
    uint32_t even = 0, odd = 0, count = (uint32_t)(samples * samples);
    for (int row = 0; row < samples; row++) {
        for (int column = 0; column < samples; column++) {
            uint32_t one = first[row * across + column];
            even += one & PAIR;
            odd += one >> 8 & PAIR;
        }
    }
    if (odd == 0) {
        return 0;
    }

    // four numbers of 0 to 255, rounded
    uint32_t channels[4] = {even & 0xFFFF, odd & 0xFFFF, even >> 16, odd >> 16}, mean = 0;
    for (int i = 0; i < 4; i++) {
        mean |= (channels[i] * opacity + 128 * count) / (256 * count) << (8 * i);
    }
    return mean;
}

// The same with a number of samples that the compiler knows: twice as fast.
static uint32_t mean_of_fine(const uint32_t *first, ptrdiff_t across, uint32_t opacity)
{
    return mean_of(SAMPLES_FINE, first, across, opacity);
}

// A colour, opacity multiplied in, over another one.
static uint32_t over(uint32_t upper, uint32_t below)
{
    uint32_t left = 255 - (upper >> 24); // what it lets through
    uint32_t even = ((below & PAIR) * left + 0x00800080) >> 8 & PAIR;
    uint32_t odd = ((below >> 8 & PAIR) * left + 0x00800080) >> 8 & PAIR;
    return upper + (even | odd << 8);
}

// The samples of a region: those of its pixels in rows of `across`.
typedef struct sampled_region {
    gl_region pixels;
    const uint32_t *first;
    ptrdiff_t across;
} sampled_region;

// The part of a tile within a region.
static gl_region tile_within(const scene_painter *p, int tile, gl_region r)
{
    int x = tile % p->tiles_across * TILE, y = tile / p->tiles_across * TILE;
    int left = x > r.x ? x : r.x, top = y > r.y ? y : r.y;
    int right = x + TILE < r.x + r.width ? x + TILE : r.x + r.width;
    int bottom = y + TILE < r.y + r.height ? y + TILE : r.y + r.height;
    return (gl_region){left, top, right - left, bottom - top};
}

// Lays the means of a tile's samples over the picture.
static void lay_tile(const scene_painter *p, const sampled_region *from, gl_region tile,
                     uint32_t opacity, cairo_surface_t *onto)
{
    unsigned char *data = cairo_image_surface_get_data(onto);
    ptrdiff_t stride = cairo_image_surface_get_stride(onto);
    for (int row = 0; row < tile.height; row++) {
        uint32_t *to = (uint32_t *)(void *)(data + (tile.y + row) * stride) + tile.x;
        const uint32_t *samples = from->first +
                                  p->samples * (tile.y + row - from->pixels.y) * from->across +
                                  (ptrdiff_t)p->samples * (tile.x - from->pixels.x);
        for (int i = 0; i < tile.width; i++) {
            const uint32_t *first = samples + (ptrdiff_t)p->samples * i;
            uint32_t mean = p->samples == SAMPLES_FINE
                                ? mean_of_fine(first, from->across, opacity)
                                : mean_of(p->samples, first, from->across, opacity);
            to[i] = mean != 0 ? over(mean, to[i]) : to[i];
        }
    }
}

// Makes a tile's samples empty and far again.
static void wipe_tile(scene_painter *p, gl_region tile)
{
    ptrdiff_t across = (ptrdiff_t)p->samples * p->width;
    int count = p->samples * tile.width;
    for (int row = p->samples * tile.y; row < p->samples * (tile.y + tile.height); row++) {
        ptrdiff_t at = row * across + (ptrdiff_t)p->samples * tile.x;
        memset(p->pixels + at, 0, (size_t)count * sizeof *p->pixels);
        for (int i = 0; i < count; i++) {
            p->depths[at + i] = FARTHEST;
        }
    }
}

static void lay_over(scene_painter *p, const sampled_region *from, double opacity,
                     cairo_surface_t *onto)
{
    const uint32_t share = (uint32_t)(256 * opacity + 0.5);
    cairo_surface_flush(onto);
    for (int i = 0; i < p->tiles_across * p->tiles_down; i++) {
        gl_region tile = tile_within(p, i, from->pixels);
        if (p->touched[i] && tile.width > 0 && tile.height > 0) {
            lay_tile(p, from, tile, share, onto);
            if (p->gl == NULL) {
                wipe_tile(p, tile);
            }
        }
    }
    cairo_surface_mark_dirty(onto);
}

status scene_painter_paint(scene_painter *p, const painting *what, cairo_surface_t *onto, fault *f)
{
    assert(p != NULL && what != NULL && onto != NULL);
    assert(what->opacity >= 0 && what->opacity <= 1);
    const mesh *m = what->mesh;
    status code = make_room(p, m, f);
    if (code != STATUS_OK) {
        return code;
    }

    // only the part of the picture that holds something
    gl_region r = project(p, m, what->camera, what->light);
    if (r.width <= 0 || r.height <= 0) {
        return STATUS_OK;
    }

    // samples, by hand or by OpenGL
    sampled_region samples = {.first = p->pixels};
    paint_triangles(p, m);
    if (p->gl != NULL) {
        const gl_triangles all = {p->vertices, m->vertex_count, m->corners, m->corner_count};
        const gl_region sampled = {p->samples * r.x, p->samples * r.y, p->samples * r.width,
                                   p->samples * r.height};
        samples.pixels = r;
        samples.across = sampled.width;
        code = gl_offscreen_draw(p->gl, &all, sampled, p->pixels, f);
    } else {
        samples.pixels = (gl_region){0, 0, p->width, p->height};
        samples.across = (ptrdiff_t)p->samples * p->width;
    }

    if (code == STATUS_OK) {
        lay_over(p, &samples, what->opacity, onto);
    }
    return code;
}

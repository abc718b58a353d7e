// Triangles as samples of a picture: which they fill, by hand or where OpenGL has done
// so, and the means that become its pixels.
#include "render/scene/scene_parts.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define FARTHEST 2.0F // deeper than everything

enum {
    ROW_MOST = 8 * SAMPLE_TILE, // most samples in a row of a tile
    FOUR = 4,                   // samples worked on at once
};

void samples_init(sample_buffer *b, int width, int height, int samples, bool depths)
{
    assert(width > 0 && height > 0);
    assert(samples > 0 && samples * SAMPLE_TILE <= ROW_MOST);
    *b = (sample_buffer){width, height, .samples = samples,
                         .tiles_across = (width + SAMPLE_TILE - 1) / SAMPLE_TILE,
                         .tiles_down = (height + SAMPLE_TILE - 1) / SAMPLE_TILE};

    // with room for what fill_columns reads after the last
    const int rows = depths ? height : MIN(height, SAMPLE_BAND);
    const size_t count = (size_t)(samples * width) * (size_t)(samples * rows) + FOUR;
    b->pixels = g_new0(uint32_t, count);
    b->touched = g_new(unsigned char, b->tiles_across * b->tiles_down);
    if (depths) {
        b->depths = g_new(float, count);
        for (size_t i = 0; i < count; i++) {
            b->depths[i] = FARTHEST;
        }
    }
}

void samples_finish(sample_buffer *b)
{
    g_free(b->pixels);
    g_free(b->depths);
    g_free(b->touched);
    *b = (sample_buffer){0};
}

// ---- triangles

// A triangle in samples of the picture.
typedef struct flat_triangle {
    float x[3], y[3], twice_area;
} flat_triangle;

// A quantity that is linear over the picture: value at the first corner and growth per
// sample.
typedef struct ramp {
    float start, right, down;
} ramp;

static ramp ramp_of(const flat_triangle *t, float a, float b, float c)
{
    float right =
        ((b - a) * (t->y[2] - t->y[0]) - (c - a) * (t->y[1] - t->y[0])) / t->twice_area;
    float down =
        ((c - a) * (t->x[1] - t->x[0]) - (b - a) * (t->x[2] - t->x[0])) / t->twice_area;
    return (ramp){a - right * t->x[0] - down * t->y[0], right, down};
}

static float ramp_at(ramp r, float x, float y)
{
    return r.start + r.right * x + r.down * y;
}

// A number as a whole one of 0 to `most`.
static int bounded(float value, int most)
{
    if (value <= 0) {
        return 0;
    }
    if (value >= (float)most) {
        return most;
    }
    return (int)value;
}

static float least(const float v[3])
{
    return fminf(v[0], fminf(v[1], v[2]));
}

static float greatest(const float v[3])
{
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

// Corners of a triangle in samples; false if it is seen from behind, or edge-on, and
// shows nothing.
static bool flatten(const sample_buffer *b, const gl_vertex *const v[3], flat_triangle *t)
{
    for (size_t k = 0; k < 3; k++) {
        const float *at = v[k]->place;
        t->x[k] = (at[0] / at[3] + 1) * (float)(b->width * b->samples) / 2;
        t->y[k] = (at[1] / at[3] + 1) * (float)(b->height * b->samples) / 2;
    }
    t->twice_area = (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) -
                    (t->x[2] - t->x[0]) * (t->y[1] - t->y[0]);
    // corners run counterclockwise as seen from outside, and y points down
    return t->twice_area < -1e-6F;
}

// Remembers the tiles that a triangle may touch.
static void touch_tiles(sample_buffer *b, const flat_triangle *t)
{
    const float tile = (float)(SAMPLE_TILE * b->samples);
    int left = bounded(least(t->x) / tile, b->tiles_across - 1);
    int right = bounded(greatest(t->x) / tile, b->tiles_across - 1);
    int top = bounded(least(t->y) / tile, b->tiles_down - 1);
    int bottom = bounded(greatest(t->y) / tile, b->tiles_down - 1);
    for (int row = top; row <= bottom; row++) {
        memset(b->touched + (ptrdiff_t)row * b->tiles_across + left, 1,
               (size_t)(right - left + 1));
    }
}

// The quantities that change linearly over a triangle: each corner's share (its
// barycentric coordinate), colour and depth.
typedef struct triangle_ramps {
    ramp share[3], tint[3], depth;

    // -1/(change of the share from column to column): times the share in the first column
    // of a row it is the column at which the share crosses zero; 0 where it never does
    float column[3];
} triangle_ramps;

// The ramps of a triangle t with the corners v. Corner k has the share 1 at itself and 0
// at both others.
static triangle_ramps ramps_of(const flat_triangle *t, const gl_vertex *const v[3])
{
    triangle_ramps r;
    for (int k = 0; k < 3; k++) {
        r.share[k] = ramp_of(t, k == 0, k == 1, k == 2);
        if (r.share[k].right != 0) {
            r.column[k] = -1 / r.share[k].right;
        } else {
            r.column[k] = 0;
        }
        r.tint[k] = ramp_of(t, v[0]->colour[k], v[1]->colour[k], v[2]->colour[k]);
    }

    r.depth = ramp_of(t, v[0]->place[2] / v[0]->place[3], v[1]->place[2] / v[1]->place[3],
                      v[2]->place[2] / v[2]->place[3]);
    return r;
}

// Narrows the columns [*from, *to) of a row to those that may be inside the triangle,
// some to spare.
static void narrow_columns(const triangle_ramps *r, float y, int *from, int *to)
{
    for (int k = 0; k < 3; k++) {
        const float right = r->share[k].right, value = ramp_at(r->share[k], 0.5F, y);
        const float crossing = value * r->column[k];

        // the share is positive to one side of where it crosses zero
        if (right > 0) {
            int first = bounded(crossing - 1, *to);
            if (first > *from) {
                *from = first;
            }
        } else if (right < 0) {
            int end = bounded(crossing + 3, *to);
            if (end < *to) {
                *to = end;
            }
        } else if (value < 0) {
            *to = *from;
        }
    }
}

// Four columns at once: numbers, and whole numbers or what holds (all bits) and what does
// not.
typedef float four __attribute__((vector_size(16)));
typedef int32_t four_bits __attribute__((vector_size(16)));

static inline four four_at(ramp r, four x, float y)
{
    return r.start + r.right * x + r.down * y;
}

static inline four_bits select_bits(four_bits which, four_bits yes, four_bits no)
{
    return (which & yes) | (~which & no);
}

// Shades of 0 to 1 as 0 to 255.
static inline four_bits channels(four shade)
{
    const four one = {1, 1, 1, 1};
    shade = (four)((shade > 0) & (four_bits)shade);
    shade = (four)select_bits(shade < 1, (four_bits)shade, (four_bits)one);
    return __builtin_convertvector(shade * 255 + 0.5F, four_bits);
}

// Fills the columns [from, to) of a row that are inside the triangle and nearer than what
// is there. Up to three columns after them are read, and written as they were.
static void fill_columns(uint32_t *pixels, float *depths, const triangle_ramps *r,
                         float y, int from, int to)
{
    const four_bits steps = {0, 1, 2, 3};
    const int opaque = (int)0xFF000000U;

    for (int column = from; column < to; column += FOUR) {
        four_bits columns = column + steps, before;
        four x = __builtin_convertvector(columns, four) + 0.5F, there;
        memcpy(&there, depths + column, sizeof there);
        memcpy(&before, pixels + column, sizeof before);

        // inside, and nearer than what is there
        four z = four_at(r->depth, x, y);
        four_bits seen = (columns < to) & (four_at(r->share[0], x, y) >= 0) &
                         (four_at(r->share[1], x, y) >= 0) &
                         (four_at(r->share[2], x, y) >= 0) & (z < there);

        four_bits rgb = opaque | channels(four_at(r->tint[0], x, y)) << 16 |
                        channels(four_at(r->tint[1], x, y)) << 8 |
                        channels(four_at(r->tint[2], x, y));
        there = (four)select_bits(seen, (four_bits)z, (four_bits)there);
        before = select_bits(seen, rgb, before);
        memcpy(depths + column, &there, sizeof there);
        memcpy(pixels + column, &before, sizeof before);
    }
}

// Fills the samples with centres inside the triangle that are nearer than their present
// depth.
static void fill_triangle(sample_buffer *b, const flat_triangle *t,
                          const gl_vertex *const v[3])
{
    const int width = b->samples * b->width, height = b->samples * b->height;
    const triangle_ramps ramps = ramps_of(t, v);

    // the rows and columns that it may touch
    int top = bounded(least(t->y), height), bottom = bounded(greatest(t->y) + 1, height);
    int left = bounded(least(t->x), width), right = bounded(greatest(t->x) + 1, width);

    for (int row = top; row < bottom; row++) {
        float y = (float)row + 0.5F;
        int from = left, to = right;
        narrow_columns(&ramps, y, &from, &to);
        fill_columns(b->pixels + (ptrdiff_t)row * width,
                     b->depths + (ptrdiff_t)row * width, &ramps, y, from, to);
    }
}

// Takes in a new set of triangles: the tiles they touch and, without OpenGL, what they
// fill.
void samples_take(sample_buffer *b, const gl_triangles *t)
{
    memset(b->touched, 0, (size_t)b->tiles_across * (size_t)b->tiles_down);

    // each triangle that is seen from its front
    for (size_t i = 0; i + 2 < t->corner_count; i += 3) {
        flat_triangle flat;
        const gl_vertex *const v[3] = {&t->vertices[t->corners[i]],
                                       &t->vertices[t->corners[i + 1]],
                                       &t->vertices[t->corners[i + 2]]};
        if (flatten(b, v, &flat)) {
            touch_tiles(b, &flat);
            if (b->depths != NULL) {
                fill_triangle(b, &flat, v);
            }
        }
    }
}

// ---- means

// Two of a pixel's four channels, with room for sums.
#define PAIR 0x00FF00FFU

// Sums over a column of samples: of two channels each.
typedef struct column_sums {
    uint32_t even[ROW_MOST], odd[ROW_MOST];
} column_sums;

// Adds up `samples` rows of `count` columns.
static void add_rows(column_sums *sums, const uint32_t *first, ptrdiff_t across,
                     int samples, int count)
{
    for (int i = 0; i < count; i++) {
        sums->even[i] = first[i] & PAIR;
        sums->odd[i] = first[i] >> 8 & PAIR;
    }

    // the others are added
    for (int row = 1; row < samples; row++) {
        const uint32_t *line = first + row * across;
        for (int i = 0; i < count; i++) {
            sums->even[i] += line[i] & PAIR;
            sums->odd[i] += line[i] >> 8 & PAIR;
        }
    }
}

// The mean of a pixel's samples x samples, weighted by the opacity [1/256].
static uint32_t mean_of(const column_sums *sums, int at, int samples, uint32_t opacity)
{
    uint32_t even = 0, odd = 0, count = (uint32_t)(samples * samples);
    for (int i = at; i < at + samples; i++) {
        even += sums->even[i];
        odd += sums->odd[i];
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

// A colour, opacity multiplied in, over another one.
static uint32_t over(uint32_t upper, uint32_t below)
{
    uint32_t left = 255 - (upper >> 24); // what it lets through
    uint32_t even = ((below & PAIR) * left + 0x00800080) >> 8 & PAIR;
    uint32_t odd = ((below >> 8 & PAIR) * left + 0x00800080) >> 8 & PAIR;
    return upper + (even | odd << 8);
}

// Lays the means of a tile's samples over the picture.
static void lay_tile(const sample_buffer *b, pixel_box region, pixel_box tile,
                     uint32_t opacity, cairo_surface_t *onto)
{
    unsigned char *data = cairo_image_surface_get_data(onto);
    ptrdiff_t stride = cairo_image_surface_get_stride(onto),
              across = b->samples * region.width;
    column_sums sums;

    for (int row = 0; row < tile.height; row++) {
        uint32_t *to = (uint32_t *)(void *)(data + (tile.y + row) * stride) + tile.x;
        const uint32_t *first = b->pixels +
                                b->samples * (tile.y + row - region.y) * across +
                                (ptrdiff_t)b->samples * (tile.x - region.x);
        add_rows(&sums, first, across, b->samples, b->samples * tile.width);
        for (int i = 0; i < tile.width; i++) {
            uint32_t mean = mean_of(&sums, b->samples * i, b->samples, opacity);
            if (mean != 0) {
                to[i] = over(mean, to[i]);
            }
        }
    }
}

// Lays the means of all tiles that were touched over the picture.
void samples_lay_over(sample_buffer *b, pixel_box region, double opacity,
                      cairo_surface_t *onto)
{
    assert(opacity >= 0 && opacity <= 1);
    const uint32_t share = (uint32_t)(256 * opacity + 0.5);
    cairo_surface_flush(onto);
    for (int i = 0; i < b->tiles_across * b->tiles_down; i++) {
        // the part of the tile within the region
        const int x = i % b->tiles_across * SAMPLE_TILE,
                  y = i / b->tiles_across * SAMPLE_TILE;
        const int left = MAX(x, region.x),
                  right = MIN(x + SAMPLE_TILE, region.x + region.width);
        const int top = MAX(y, region.y),
                  bottom = MIN(y + SAMPLE_TILE, region.y + region.height);
        if (!b->touched[i] || right <= left || bottom <= top) {
            continue;
        }
        lay_tile(b, region, (pixel_box){left, top, right - left, bottom - top}, share,
                 onto);

        // its samples are empty and far again
        const size_t count = (size_t)(b->samples * (right - left));
        for (int row = b->samples * top; row < b->samples * bottom && b->depths != NULL;
             row++) {
            ptrdiff_t at =
                (ptrdiff_t)row * b->samples * b->width + (ptrdiff_t)b->samples * left;
            memset(b->pixels + at, 0, count * sizeof *b->pixels);
            for (size_t k = 0; k < count; k++) {
                b->depths[at + (ptrdiff_t)k] = FARTHEST;
            }
        }
    }
    cairo_surface_mark_dirty(onto);
}

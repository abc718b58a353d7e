// The floor: a pale plane with a grid that fades into the page, and soft shadows on it.
#include "render/scene/scene_parts.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "render/page/picture_file.h"

enum {
    MAP = 640,       // cells along each edge of the shadow's map
    BLUR = 4,        // half width of a smoothing pass [cells]
    BLUR_PASSES = 3, // three boxes are nearly a bell
};

#define SHADOW_DEPTH 0.30  // what a shadow takes away of the floor's light
#define LINE_WIDTH   0.012 // of a grid line, in distances of the grid

// How much of a pixel that is `across` wide a grid line covers.
static double line_cover(double place, double grid, double across)
{
    double lines = place / grid, off = fabs(lines - floor(lines + 0.5)) * grid;
    double cover = 0.5 + (fmax(LINE_WIDTH * grid, across) / 2 - off) / across;
    if (cover < 0) {
        return 0;
    }
    if (cover > 1) {
        return 1;
    }
    return cover;
}

// What decides at a pixel whether a value between two levels goes to the upper one:
// Bayer's matrix of 8 x 8 (1973), 1/128 to 127/128. Gradients of few levels show no bands
// then.
static double threshold_at(int column, int row)
{
    unsigned x = (unsigned)column & 7, y = (unsigned)row & 7, z = x ^ y;
    unsigned rank = (z & 1) << 5 | (y & 1) << 4 | (z & 2) << 2 | (y & 2) << 1 |
                    (z & 4) >> 1 | (y & 4) >> 2;
    return (rank + 0.5) / 64;
}

static uint32_t rgb_of(colour c, double threshold)
{
    return 0xFF000000U | (uint32_t)(255 * c.red + threshold) << 16 |
           (uint32_t)(255 * c.green + threshold) << 8 |
           (uint32_t)(255 * c.blue + threshold);
}

static double floor_level(const scene *sc)
{
    return FLOOR_LEVEL * sc->length;
}

// Colour of the floor at (x, y) within its reach, a pixel being `wide` by `deep` there.
static colour floor_colour(const scene *sc, double x, double y, double wide, double deep)
{
    // fades out towards its reach
    const scene_floor *floor = &sc->floor;
    double away_x = x - floor->middle.x, away_y = y - floor->middle.y;
    double left = 1 - (away_x * away_x + away_y * away_y) / (floor->reach * floor->reach);

    double fade = left * sqrt(left), over_x = line_cover(x, sc->grid, wide);
    double over_y = line_cover(y, sc->grid, deep);

    // lines closer than a few pixels would only flicker
    double dense = fmin(1, fmax(0, sc->grid / fmax(wide, deep) / 6 - 0.5));
    double cover = dense * (1 - (1 - over_x) * (1 - over_y));

    colour c = colour_between(sc->around->ground, sc->around->line, cover);
    return colour_between(sc->around->page, c, fade);
}

// Rays through pixels: of the first one's centre, and how they change to the right and
// downwards.
typedef struct ray_field {
    vector first, right, down;
} ray_field;

// Sets where the ray of a pixel meets the floor, and the colour it has there without a
// shadow.
static void set_floor_pixel(scene *sc, const ray_field *rays, vector ray, int column,
                            int row)
{
    // where the ray meets the floor
    scene_floor *floor = &sc->floor;
    const camera *c = &sc->camera;
    const size_t at = (size_t)row * (size_t)sc->options.width + (size_t)column;
    double along = (floor_level(sc) - c->eye.z) / ray.z;
    double x = c->eye.x + along * ray.x, y = c->eye.y + along * ray.y;
    double away_x = x - floor->middle.x, away_y = y - floor->middle.y;

    // a ray towards the sky meets the floor behind the eye, and none beyond its reach is
    // seen
    bool meets =
        ray.z < 0 && away_x * away_x + away_y * away_y < floor->reach * floor->reach;
    if (!meets) {
        floor->x[at] = floor->y[at] = 1e30F;
        floor->ground[at] = rgb_of(sc->around->page, 0.5);
        return;
    }
    floor->x[at] = (float)x;
    floor->y[at] = (float)y;

    // how far a pixel reaches on the floor along both directions
    double slope_x = ray.x / ray.z, slope_y = ray.y / ray.z;
    const vector *r = &rays->right, *d = &rays->down;
    double wide =
        fabs(along * (r->x - slope_x * r->z)) + fabs(along * (d->x - slope_x * d->z));
    double deep =
        fabs(along * (r->y - slope_y * r->z)) + fabs(along * (d->y - slope_y * d->z));
    floor->ground[at] =
        rgb_of(floor_colour(sc, x, y, wide, deep), threshold_at(column, row));
}

// The floor without shadows, pixel by pixel.
static void paint_floor_ground(scene *sc)
{
    const camera *c = &sc->camera;
    ray_field rays = {.first = camera_ray(c, 0.5, 0.5)};
    rays.right = vector_sum(camera_ray(c, 1.5, 0.5), -1, rays.first);
    rays.down = vector_sum(camera_ray(c, 0.5, 1.5), -1, rays.first);

    // each ray from the first by steps to the right and down
    for (int row = 0; row < sc->options.height; row++) {
        vector start = vector_sum(rays.first, row, rays.down);
        for (int column = 0; column < sc->options.width; column++) {
            set_floor_pixel(sc, &rays, vector_sum(start, column, rays.right), column,
                            row);
        }
    }
}

// The floor round a point, and an empty map of the shadows on it.
void scene_floor_init(scene *sc, vector middle, double reach)
{
    assert(reach > 0);
    const size_t pixels = (size_t)sc->options.width * (size_t)sc->options.height;

    // the map of the shadow covers all of the floor
    scene_floor *floor = &sc->floor;
    *floor = (scene_floor){.middle = middle,
                           .reach = reach,
                           .ground = g_new(unsigned, pixels),
                           .x = g_new(float, pixels),
                           .y = g_new(float, pixels),
                           .mask = g_new(unsigned char, MAP *MAP),
                           .spare = g_new(unsigned char, MAP *MAP),
                           .map_left = middle.x - reach,
                           .map_low = middle.y - reach,
                           .map_cell = 2 * reach / MAP};
    paint_floor_ground(sc);
}

void scene_floor_finish(scene_floor *floor)
{
    g_free(floor->ground);
    g_free(floor->x);
    g_free(floor->y);
    g_free(floor->mask);
    g_free(floor->spare);
    *floor = (scene_floor){0};
}

// Columns [left, right) and rows [low, high) of the map or of the picture.
typedef struct cell_box {
    int left, right, low, high;
} cell_box;

// One smoothing pass along rows of the box, outside which all is empty; the result is
// stored turned round, so that two passes do both directions.
static void blur_turned(const unsigned char *from, unsigned char *to, cell_box cells)
{
    for (int row = cells.low; row < cells.high; row++) {
        const unsigned char *line_from = from + (ptrdiff_t)row * MAP;
        int sum = 0;
        for (int i = cells.left; i < cells.left + BLUR && i < cells.right; i++) {
            sum += line_from[i];
        }

        // the sum runs along: a cell enters ahead, another leaves behind
        for (int i = cells.left; i < cells.right; i++) {
            if (i + BLUR < cells.right) {
                sum += line_from[i + BLUR];
            }
            to[(ptrdiff_t)i * MAP + row] = (unsigned char)(sum / (2 * BLUR + 1));
            if (i >= cells.left + BLUR) {
                sum -= line_from[i - BLUR];
            }
        }
    }
}

// A cell of the map, or of its edge.
static int within_map(double cell)
{
    if (cell < 0) {
        return 0;
    }
    if (cell > MAP) {
        return MAP;
    }
    return (int)cell;
}

// The cells of the map that sharp shadows and their soft edge may cover.
static cell_box with_soft_edge(double left, double right, double low, double high)
{
    const int edge = BLUR * BLUR_PASSES + 1;
    return (cell_box){within_map(left - edge), within_map(right + edge + 1),
                      within_map(low - edge), within_map(high + edge + 1)};
}

// Draws the mesh's triangles, thrown onto the floor along the light, into the map.
// *covered is what they and their soft edge may cover.
static status cast_sharp_shadow(scene *sc, cell_box *covered, fault *f)
{
    scene_floor *floor = &sc->floor;
    const mesh *m = &sc->mesh;
    const vector light = sc->light;
    double left = MAP, right = 0, low = MAP, high = 0;

    // a map of opacities alone, in whole cells
    memset(floor->mask, 0, (size_t)MAP * MAP);
    cairo_surface_t *map =
        cairo_image_surface_create_for_data(floor->mask, CAIRO_FORMAT_A8, MAP, MAP, MAP);
    cairo_t *cr = cairo_create(map);
    cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE);

    for (size_t i = 0; i + 2 < m->corner_count; i += 3) {
        // a closed solid's shadow is that of its lit side
        if (vector_dot(m->vertices[m->corners[i]].normal, light) <= 0) {
            continue;
        }

        // its corners, moved along the light onto the floor
        for (size_t k = 0; k < 3; k++) {
            vector p = m->vertices[m->corners[i + k]].place;
            double along = fmax(0, p.z - floor_level(sc)) / light.z;
            double x = p.x - along * light.x, y = p.y - along * light.y;
            double across = (x - floor->map_left) / floor->map_cell;
            double up = (y - floor->map_low) / floor->map_cell;
            cairo_line_to(cr, across, up);
            left = fmin(left, across);
            right = fmax(right, across);
            low = fmin(low, up);
            high = fmax(high, up);
        }
        cairo_close_path(cr);
        cairo_fill(cr);
    }

    const status code = picture_end_drawing(cr, STATUS_OK, f);
    cairo_surface_destroy(map);
    *covered = with_soft_edge(left, right, low, high);
    return code;
}

// Gives the shadow on the map a soft edge, as of a wide lamp.
static void soften_shadow(scene_floor *floor, cell_box cells)
{
    const cell_box turned = {cells.low, cells.high, cells.left, cells.right};
    for (int pass = 0; pass < BLUR_PASSES; pass++) {
        blur_turned(floor->mask, floor->spare, cells);
        blur_turned(floor->spare, floor->mask, turned);
    }
}

// The shadow at a place of the floor, 0 to 255, between the map's cells.
static float shadow_at(const scene_floor *floor, float x, float y)
{
    float scale = (float)(1 / floor->map_cell);
    float u = (x - (float)floor->map_left) * scale - 0.5F;
    float v = (y - (float)floor->map_low) * scale - 0.5F;
    if (!(u >= 0 && v >= 0 && u < MAP - 1 && v < MAP - 1)) {
        return 0;
    }

    // a mean of four cells, by how near their middles are
    int i = (int)u, j = (int)v;
    float a = u - (float)i, b = v - (float)j;
    const unsigned char *at = floor->mask + (ptrdiff_t)j * MAP + i;
    return (1 - b) * ((1 - a) * at[0] + a * at[1]) +
           b * ((1 - a) * at[MAP] + a * at[MAP + 1]);
}

// The pixels that show a box of the map, some to spare.
static cell_box seen_box(const scene *sc, cell_box cells)
{
    const scene_floor *floor = &sc->floor;
    const int width = sc->options.width, height = sc->options.height;
    double left = width, right = 0, top = height, bottom = 0;

    // the corners of the box on the picture
    for (int i = 0; i < 4; i++) {
        const int across = i & 1 ? cells.left : cells.right;
        const int up = i & 2 ? cells.low : cells.high;
        const vector corner = {floor->map_left + across * floor->map_cell,
                               floor->map_low + up * floor->map_cell, floor_level(sc)};
        const vector at = camera_project(&sc->camera, corner);
        if (at.z < sc->camera.nearest) {
            // it reaches behind the eye
            return (cell_box){0, width, 0, height};
        }

        left = fmin(left, at.x);
        right = fmax(right, at.x);
        top = fmin(top, at.y);
        bottom = fmax(bottom, at.y);
    }

    // one pixel more on each side
    return (cell_box){(int)fmax(0, left - 1), (int)fmin(width, right + 2),
                      (int)fmax(0, top - 1), (int)fmin(height, bottom + 2)};
}

// A colour under a shadow of 0 to 255; threshold [1/65536] as of threshold_at.
static uint32_t darkened(uint32_t rgb, float shadow, uint32_t threshold)
{
    uint32_t light = 65536 - (uint32_t)(shadow * (float)(SHADOW_DEPTH * 65536 / 255));
    uint32_t red = ((rgb >> 16 & 255) * light + threshold) >> 16;
    uint32_t green = ((rgb >> 8 & 255) * light + threshold) >> 16;
    return 0xFF000000U | red << 16 | green << 8 | ((rgb & 255) * light + threshold) >> 16;
}

// The floor as it is without shadows, darker where they fall.
status scene_floor_paint(scene *sc, cairo_surface_t *onto, fault *f)
{
    cell_box shade;
    TRY(cast_sharp_shadow(sc, &shade, f));
    soften_shadow(&sc->floor, shade);

    const cell_box seen = seen_box(sc, shade);
    const scene_floor *floor = &sc->floor;
    const size_t width = (size_t)sc->options.width;

    cairo_surface_flush(onto);
    unsigned char *data = cairo_image_surface_get_data(onto);
    ptrdiff_t stride = cairo_image_surface_get_stride(onto);

    for (int row = 0; row < sc->options.height; row++) {
        // as it is without shadows
        uint32_t *to = (uint32_t *)(void *)(data + row * stride), thresholds[8];
        size_t at = (size_t)row * width;
        memcpy(to, floor->ground + at, width * sizeof *to);
        if (row < seen.low || row >= seen.high) {
            continue;
        }

        // and darker where they fall
        for (int i = 0; i < 8; i++) {
            thresholds[i] = (uint32_t)(65536 * threshold_at(i, row));
        }
        for (int column = seen.left; column < seen.right; column++) {
            size_t pixel = at + (size_t)column;
            float shadow = shadow_at(floor, floor->x[pixel], floor->y[pixel]);
            if (shadow > 0) {
                to[column] =
                    darkened(floor->ground[pixel], shadow, thresholds[column & 7]);
            }
        }
    }
    cairo_surface_mark_dirty(onto);
    return STATUS_OK;
}

// What a picture of a scene has taken, as cells that no label may cover.
#include "render/scene/scene_parts.h"

#include <math.h>

#define CELL 6.0 // edge [pixels]

void taken_begin(taken_cells *t, const camera *c)
{
    taken_finish(t);
    t->across = (int)ceil(c->width / CELL);
    t->down = (int)ceil(c->height / CELL);
    t->filled = g_new0(unsigned char, (size_t)t->across *(size_t)t->down);
}

void taken_finish(taken_cells *t)
{
    g_clear_pointer(&t->filled, g_free);
}

// Takes the cell of a point [pixels].
static void take_point(taken_cells *t, double x, double y)
{
    const double column = floor(x / CELL), row = floor(y / CELL);
    if (column >= 0 && column < t->across && row >= 0 && row < t->down) {
        t->filled[(int)row * t->across + (int)column] = 1;
    }
}

// Takes the cells of a triangle on the picture, by points a cell apart.
static void take_triangle(taken_cells *t, const vector corners[3])
{
    const vector along = vector_sum(corners[1], -1, corners[0]);
    const vector across = vector_sum(corners[2], -1, corners[0]);
    const double longest = fmax(hypot(along.x, along.y), hypot(across.x, across.y));
    const int steps = 1 + (int)fmin(longest / CELL, 2000);
    for (int i = 0; i <= steps; i++) {
        for (int k = 0; k <= steps - i; k++) {
            const double u = (double)i / steps, v = (double)k / steps;
            take_point(t, corners[0].x + u * along.x + v * across.x,
                       corners[0].y + u * along.y + v * across.y);
        }
    }
}

void taken_add_mesh(taken_cells *t, const mesh *m, const camera *c)
{
    for (size_t i = 0; i + 2 < m->corner_count; i += 3) {
        vector corners[3];
        bool seen = true; // not beside or behind the eye
        for (size_t k = 0; k < 3; k++) {
            corners[k] = camera_project(c, m->vertices[m->corners[i + k]].place);
            seen = seen && corners[k].z > c->nearest / 2;
        }
        if (seen) {
            take_triangle(t, corners);
        }
    }
}

void taken_add_box(taken_cells *t, figure_rect area)
{
    for (double y = area.y; y < area.y + area.height + CELL; y += CELL) {
        for (double x = area.x; x < area.x + area.width + CELL; x += CELL) {
            take_point(t, x, y);
        }
    }
}

// How many cells of a box are taken, or lie outside the picture.
static int count_taken(const taken_cells *t, figure_rect area)
{
    int count = 0;
    const int right = (int)floor((area.x + area.width) / CELL);
    const int bottom = (int)floor((area.y + area.height) / CELL);
    for (int row = (int)floor(area.y / CELL); row <= bottom; row++) {
        for (int column = (int)floor(area.x / CELL); column <= right; column++) {
            const bool inside =
                row >= 0 && row < t->down && column >= 0 && column < t->across;
            count += !inside || t->filled[row * t->across + column] != 0;
        }
    }
    return count;
}

// The box round a centre that touches it from a direction, `apart` pixels away.
static figure_rect box_beside(vector point, double angle, double apart, text_size size)
{
    const double x = cos(angle), y = sin(angle);
    return (figure_rect){point.x + x * (size.width / 2 + apart) - size.width / 2,
                         point.y + y * (size.height / 2 + apart) - size.height / 2,
                         size.width, size.height};
}

figure_rect taken_clear_box(const taken_cells *t, vector point, vector along,
                            text_size size, const camera *c)
{
    enum { RINGS = 6, DIRECTIONS = 12 };
    const double ahead = atan2(along.y, along.x), near = size.height / 2;
    figure_rect best = box_beside(point, ahead, near, size);
    int fewest = count_taken(t, best);
    for (int i = 1; i < RINGS * DIRECTIONS && fewest > 0; i++) {
        // ahead first, then to the left and the right in turn
        const int side = i % DIRECTIONS;
        const double turn = (side + 1) / 2 * (side % 2 == 0 ? 1 : -1);
        const double apart = near * (1 + i / DIRECTIONS);
        const figure_rect area =
            box_beside(point, ahead + turn * 2 * M_PI / DIRECTIONS, apart, size);
        const int taken = count_taken(t, area);
        if (taken < fewest) {
            fewest = taken;
            best = area;
        }
    }

    // where nothing is clear, at least inside the picture
    best.x = fmin(fmax(best.x, 4), c->width - size.width - 4);
    best.y = fmin(fmax(best.y, 4), c->height - size.height - 4);
    return best;
}

// Rectangles of texts on a page: whether one is within another, and whether two cover each other.
#pragma once

#include <math.h>
#include <stdbool.h>

#include "render/page/page.h"

// Whether r lies within `outer`, to a slack [pt].
static inline bool rect_is_within(const figure_rect *r, const figure_rect *outer, double slack)
{
    return r->x >= outer->x - slack && r->y >= outer->y - slack &&
           r->x + r->width <= outer->x + outer->width + slack &&
           r->y + r->height <= outer->y + outer->height + slack;
}

// Whether the letters of two texts overlap; their line boxes are taller than the letters.
static inline bool rects_overlap(const figure_rect *a, const figure_rect *b)
{
    double down = fmin(a->y + a->height, b->y + b->height) - fmax(a->y, b->y);
    double across = fmin(a->x + a->width, b->x + b->width) - fmax(a->x, b->x);
    return across > 0.5 && down > 0.3 * fmin(a->height, b->height);
}

#include "render/plot/scale.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#define LEAST_DECADES 0.5 // of a logarithmic scale

double scale_coordinate(scale_kind kind, double value)
{
    return kind == SCALE_LOGARITHMIC ? log10(value) : value;
}

double scale_value(scale_kind kind, double coordinate)
{
    return kind == SCALE_LOGARITHMIC ? pow(10, coordinate) : coordinate;
}

double scale_share(const axis_scale *s, double value)
{
    return (scale_coordinate(s->kind, value) - s->low) / (s->high - s->low);
}

bool scale_holds(const axis_scale *s, double value)
{
    double at = scale_coordinate(s->kind, value);
    return at >= s->low && at <= s->high;
}

axis_scale scale_empty(scale_kind kind)
{
    return (axis_scale){kind, (double)INFINITY, -(double)INFINITY};
}

void scale_include(axis_scale *s, double value)
{
    double at = scale_coordinate(s->kind, value);
    if (isfinite(at)) {
        s->low = fmin(s->low, at);
        s->high = fmax(s->high, at);
    }
}

bool scale_is_empty(const axis_scale *s)
{
    return !(s->low <= s->high);
}

void scale_widen(axis_scale *s, double share)
{
    assert(s != NULL && share >= 0);
    if (!isfinite(s->low) || !isfinite(s->high)) {
        s->low = 0;
        s->high = 1;
    }

    // equal ends go apart
    double size = fmax(fabs(s->low), fabs(s->high)), range = s->high - s->low;
    if (s->kind == SCALE_LOGARITHMIC && range < LEAST_DECADES) {
        s->low -= (LEAST_DECADES - range) / 2;
        s->high += (LEAST_DECADES - range) / 2;
    } else if (range <= 1e-9 * size || s->high == s->low) {
        double half = size > 0 ? 0.1 * size : 1;
        s->low -= half;
        s->high += half;
    }

    range = s->high - s->low;
    s->low -= share * range;
    s->high += share * range;
}

// Colours as people see them, with full sight and with colour blindness.
#pragma once

#include <math.h>

#include "render/page/page.h"

static inline double linear(double part)
{
    return part <= 0.04045 ? part / 12.92 : pow((part + 0.055) / 1.055, 2.4);
}

// Relative luminance of an sRGB colour (IEC 61966-2-1).
static inline double luminance(colour c)
{
    return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}

// Contrast of two colours, 1 to 21 (WCAG 2).
static inline double contrast(colour a, colour b)
{
    double x = luminance(a), y = luminance(b);
    return (fmax(x, y) + 0.05) / (fmin(x, y) + 0.05);
}

// Kinds of sight: severity 1 of Machado, Oliveira and Fernandes (2009), in linear sRGB.
static const double sights[][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.367322, 0.860646, -0.227968},
     {0.280085, 0.672501, 0.047413},
     {-0.011820, 0.042940, 0.968881}},
    {{0.152286, 1.052583, -0.204868},
     {0.114503, 0.786281, 0.099216},
     {-0.003882, -0.048116, 1.051998}},
};
static const char *const sight_names[] = {"full sight", "deuteranopia", "protanopia"};

// CIE L*, a*, b* under D65 of a colour as it is seen.
static inline void lab_of(colour c, int sight, double out[3])
{
    static const double to_xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375},
                                        {0.2126729, 0.7151522, 0.0721750},
                                        {0.0193339, 0.1191920, 0.9503041}};
    static const double white[3] = {0.95047, 1, 1.08883};
    const double in[3] = {linear(c.red), linear(c.green), linear(c.blue)};
    double seen[3], f[3];
    for (int i = 0; i < 3; i++) {
        seen[i] = 0;
        for (int k = 0; k < 3; k++) {
            seen[i] += sights[sight][i][k] * in[k];
        }
        seen[i] = fmin(fmax(seen[i], 0), 1);
    }
    for (int i = 0; i < 3; i++) {
        double t = 0;
        for (int k = 0; k < 3; k++) {
            t += to_xyz[i][k] * seen[k];
        }
        t /= white[i];
        f[i] = t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    }
    out[0] = 116 * f[1] - 16;
    out[1] = 500 * (f[0] - f[1]);
    out[2] = 200 * (f[1] - f[2]);
}

// Distance in CIE L*a*b* of 1976: 2.3 is just noticed side by side.
static inline double distance_seen(colour a, colour b, int sight)
{
    double p[3], q[3];
    lab_of(a, sight, p);
    lab_of(b, sight, q);
    return sqrt(pow(p[0] - q[0], 2) + pow(p[1] - q[1], 2) + pow(p[2] - q[2], 2));
}

#include "ui/terminal/ink_colours.h"

#include <assert.h>
#include <math.h>

// As many colours as can be told apart with 4.6 of contrast on both grounds, also without
// the sensitivity for red or for green, near the hues of Okabe and Ito 2008.
static const struct {
    rgb dark, light;
} inks[INK_COUNT] = {
    [INK_DIM] = {{160, 160, 160}, {92, 92, 92}},
    [INK_FRAME] = {{128, 128, 128}, {128, 128, 128}},
    [INK_ARM] = {{135, 215, 255}, {0, 85, 165}},
    [INK_HUB] = {{255, 215, 175}, {120, 80, 0}},
    [INK_WALL] = {{188, 188, 188}, {80, 80, 80}},
    [INK_FORCE] = {{255, 150, 40}, {175, 70, 0}},
    [INK_EVENT] = {{255, 215, 0}, {140, 75, 0}},
    [INK_CURSOR] = {{95, 255, 255}, {0, 105, 110}},
    [INK_WARNING] = {{255, 110, 110}, {195, 0, 20}},
    [INK_OTHER] = {{180, 145, 255}, {115, 60, 200}},
    [INK_SERIES_0] = {{24, 191, 255}, {39, 115, 184}},
    {{247, 189, 30}, {137, 102, 22}},
    {{0, 171, 115}, {0, 86, 73}},
    {{126, 233, 255}, {17, 70, 197}},
    {{255, 125, 189}, {125, 36, 137}},
    {{255, 96, 11}, {140, 36, 0}},
    {{204, 248, 183}, {36, 0, 0}},
    {{255, 255, 30}, {87, 116, 111}},
};

bool ink_rgb(colour_theme theme, ink i, rgb *colour)
{
    if (theme == COLOURS_LIGHT) {
        *colour = inks[i].light;
    } else {
        *colour = inks[i].dark;
    }
    return theme != COLOURS_MONO && i != INK_TEXT && i != INK_TITLE && i != INK_SELECTED;
}

const rgb *theme_grounds(colour_theme theme)
{
    static const rgb grounds[2][2] = {{{0, 0, 0}, {40, 44, 52}},
                                      {{255, 255, 255}, {253, 246, 227}}};
    return grounds[theme == COLOURS_LIGHT];
}

// --- measures --------------------------------------------------------------------------

static double linear(unsigned char value)
{
    double share = value / 255.0;
    if (share <= 0.04045) {
        return share / 12.92;
    }
    return pow((share + 0.055) / 1.055, 2.4);
}

static double luminance(rgb c)
{
    return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}

double rgb_contrast(rgb a, rgb b)
{
    double one = luminance(a) + 0.05, other = luminance(b) + 0.05;
    return fmax(one, other) / fmin(one, other);
}

// Ottosson 2020
static void oklab(rgb c, double lab[3])
{
    double r = linear(c.red), g = linear(c.green), b = linear(c.blue);
    double l = cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    double m = cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    double s = cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

double rgb_distance(rgb a, rgb b)
{
    double x[3], y[3];
    oklab(a, x);
    oklab(b, y);
    return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
}

// --- terminals with fewer colours ------------------------------------------------------

rgb colour_256(int index)
{
    static const unsigned char levels[6] = {0, 95, 135, 175, 215, 255};

    // the PC's text mode, which has the largest difference between bright and dark
    // colours
    if (index < 16) {
        unsigned char on = 170, off = 0;
        if (index & 8) {
            on = 255;
            off = 85;
        }
        rgb c = {off, off, off};
        if (index & 1) {
            c.red = on;
        }
        if (index & 2) {
            c.green = on;
        }
        if (index & 4) {
            c.blue = on;
        }
        if (index == 3) {
            c.green = 85; // brown instead of a dark yellow
        }
        return c;
    }
    if (index >= 232) {
        unsigned char grey = (unsigned char)(8 + 10 * (index - 232));
        return (rgb){grey, grey, grey};
    }
    index -= 16;
    return (rgb){levels[index / 36], levels[index / 6 % 6], levels[index % 6]};
}

static bool is_grey(rgb c)
{
    return c.red == c.green && c.green == c.blue;
}

// The nearest colour of 256, or of the first 16 (`few`), that has enough contrast on the
// grounds and is none of those taken (bits); a grey may stand for a colour if `greys`. -1
// if there is none.
static int nearest(colour_theme theme, ink i, bool few, unsigned taken, bool greys)
{
    // lines need less contrast than text
    double least = i == INK_FRAME ? 3 : 4.5, distance = (double)INFINITY;
    rgb wanted;
    int best = -1;
    if (!ink_rgb(theme, i, &wanted)) {
        return -1;
    }

    // of 256 the first 16 are whatever the user has made of them
    int first = 16, end = 256, grounds = 2;
    if (few) {
        first = 0;
        end = 16;
        grounds = 1;
    }
    for (int index = first; index < end; index++) {
        const rgb c = colour_256(index);

        // no colour for what has none, and the other way round where there are some
        const bool suits = is_grey(c) == is_grey(wanted) || (is_grey(c) && greys);
        bool readable = suits && !(few && taken >> index & 1);
        for (int g = 0; g < grounds; g++) {
            readable = readable && rgb_contrast(c, theme_grounds(theme)[g]) >= least;
        }
        if (readable && rgb_distance(c, wanted) < distance) {
            best = index;
            distance = rgb_distance(c, wanted);
        }
    }
    return best;
}

static int find_16(colour_theme theme, ink i)
{
    unsigned taken = 0;
    int best = -1;
    // curves differ as long as there are colours
    for (int k = i < INK_SERIES_0 ? (int)i : INK_SERIES_0; k <= (int)i; k++) {
        best = nearest(theme, (ink)k, true, taken, false);
        if (best < 0) {
            best = nearest(theme, (ink)k, true, taken, true);
        }
        if (best < 0) {
            best = nearest(theme, (ink)k, true, 0, true);
        }
        if (best < 0) {
            taken |= 0;
        } else {
            taken |= 1u << best;
        }
    }
    // black and white are the text's own, which the user may have exchanged
    if (best == 0 || best == 7 || best == 15) {
        return -1;
    }
    return best;
}

int ink_index(colour_theme theme, ink i, colour_depth depth)
{
    // found once: kept with 2 added, so that 0 is unknown
    static short kept[2][COLOUR_THEMES][INK_COUNT];
    assert(theme < COLOUR_THEMES && i < INK_COUNT);
    short *known = &kept[depth == DEPTH_256][theme][i];
    if (*known == 0) {
        const int found =
            depth == DEPTH_256 ? nearest(theme, i, false, 0, true) : find_16(theme, i);
        *known = (short)(found + 2);
    }
    return *known - 2;
}

bool inks_look_alike(colour_theme theme, colour_depth depth, ink a, ink b)
{
    if (depth == DEPTH_16 || depth == DEPTH_256) {
        return ink_index(theme, a, depth) == ink_index(theme, b, depth);
    }
    return a == b;
}

#include "ui/terminal/ink_colours.h"

#include <assert.h>
#include <math.h>

// Colours that can be told apart, also without the sensitivity for red or for green, each
// with a contrast of 4.6 on both grounds; near the hues of Okabe and Ito 2008.
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

enum { GROUNDS = 2 }; // of a theme

bool ink_rgb(colour_theme theme, ink i, rgb *colour)
{
    *colour = theme == COLOURS_LIGHT ? inks[i].light : inks[i].dark;
    return theme != COLOURS_MONO && i != INK_TEXT && i != INK_TITLE && i != INK_SELECTED;
}

const rgb *theme_grounds(colour_theme theme)
{
    static const rgb dark[GROUNDS] = {{0, 0, 0}, {40, 44, 52}};
    static const rgb light[GROUNDS] = {{255, 255, 255}, {253, 246, 227}};
    return theme == COLOURS_LIGHT ? light : dark;
}

// --- measures --------------------------------------------------------------------------

// A component of sRGB as an intensity of light, 0 to 1 (IEC 61966-2-1).
static double intensity(unsigned char component)
{
    const double share = component / 255.0;
    if (share <= 0.04045) {
        return share / 12.92;
    }
    return pow((share + 0.055) / 1.055, 2.4);
}

// The relative luminance of WCAG 2, 0 to 1.
static double luminance(rgb c)
{
    return 0.2126 * intensity(c.red) + 0.7152 * intensity(c.green) +
           0.0722 * intensity(c.blue);
}

double rgb_contrast(rgb a, rgb b)
{
    const double of_a = luminance(a) + 0.05, of_b = luminance(b) + 0.05;
    return fmax(of_a, of_b) / fmin(of_a, of_b);
}

// Lightness and two axes of colour, in which distances are as people see them (Ottosson
// 2020).
static void oklab(rgb c, double lab[3])
{
    const double r = intensity(c.red), g = intensity(c.green), b = intensity(c.blue);

    // the responses of the three cones of an eye
    const double l = cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    const double m = cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    const double s = cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
    lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
    lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

double rgb_distance(rgb a, rgb b)
{
    double of_a[3], of_b[3];
    oklab(a, of_a);
    oklab(b, of_b);
    return hypot(hypot(of_a[0] - of_b[0], of_a[1] - of_b[1]), of_a[2] - of_b[2]);
}

// --- terminals with fewer colours ------------------------------------------------------

// The first 16 as the PC's text mode has them, which has the largest difference between
// bright and dark colours: a bit each for red, green and blue, one for bright.
static rgb colour_16(int index)
{
    enum { BROWN = 3 };
    if (index == BROWN) {
        return (rgb){170, 85, 0};
    }
    const bool bright = (index & 8) != 0;
    const unsigned char on = bright ? 255 : 170, off = bright ? 85 : 0;
    return (rgb){.red = index & 1 ? on : off,
                 .green = index & 2 ? on : off,
                 .blue = index & 4 ? on : off};
}

rgb colour_256(int index)
{
    enum { CUBE = 16, GREYS = 232 }; // where a cube of colours begins, and greys
    static const unsigned char levels[6] = {0, 95, 135, 175, 215, 255};
    if (index < CUBE) {
        return colour_16(index);
    }
    if (index >= GREYS) {
        const unsigned char grey = (unsigned char)(8 + 10 * (index - GREYS));
        return (rgb){grey, grey, grey};
    }

    // red changes slowest, blue fastest
    const int in_cube = index - CUBE;
    return (rgb){levels[in_cube / 36], levels[in_cube / 6 % 6], levels[in_cube % 6]};
}

// Whether a colour has no hue.
static bool is_grey(rgb c)
{
    return c.red == c.green && c.green == c.blue;
}

// What colours an ink may have: those from `first` to before `end` that are not among
// those taken (bits, of the first 16), that differ enough from the first grounds, and no
// grey for a colour unless that is allowed.
typedef struct colour_search {
    int first, end;
    unsigned taken;
    int grounds;
    double contrast; // at least
    bool greys;
} colour_search;

// Whether a colour of the terminal is among those that may stand for the wanted one.
static bool is_allowed(const colour_search *search, colour_theme theme, int index,
                       rgb wanted)
{
    // no colour for what has none, and the other way round where there are some
    const rgb c = colour_256(index);
    if (is_grey(wanted) && !is_grey(c)) {
        return false;
    }
    if (!is_grey(wanted) && is_grey(c) && !search->greys) {
        return false;
    }
    if (index < 16 && (search->taken >> index & 1) != 0) {
        return false;
    }
    for (int g = 0; g < search->grounds; g++) {
        if (rgb_contrast(c, theme_grounds(theme)[g]) < search->contrast) {
            return false;
        }
    }
    return true;
}

// The nearest of those colours, -1 if there is none.
static int nearest(const colour_search *search, colour_theme theme, ink i)
{
    double least = (double)INFINITY;
    int best = -1;
    rgb wanted;
    if (!ink_rgb(theme, i, &wanted)) {
        return -1;
    }
    for (int index = search->first; index < search->end; index++) {
        const double distance = rgb_distance(colour_256(index), wanted);
        if (distance < least && is_allowed(search, theme, index, wanted)) {
            best = index;
            least = distance;
        }
    }
    return best;
}

// Lines need less contrast than text.
static double needed_contrast(ink i)
{
    return i == INK_FRAME ? 3 : 4.5;
}

// Of 256 the first 16 are whatever the user has made of them.
static int find_256(colour_theme theme, ink i)
{
    const colour_search search = {.first = 16,
                                  .end = 256,
                                  .grounds = GROUNDS,
                                  .contrast = needed_contrast(i),
                                  .greys = true};
    return nearest(&search, theme, i);
}

// Of 16 the nearest one that is not taken, at need a grey, or one that is taken.
static int nearest_of_16(colour_theme theme, ink i, unsigned taken)
{
    colour_search search = {.end = 16,
                            .taken = taken,
                            .grounds = 1,
                            .contrast = needed_contrast(i)};
    int best = nearest(&search, theme, i);
    if (best < 0) {
        search.greys = true;
        best = nearest(&search, theme, i);
    }
    if (best < 0) {
        search.taken = 0;
        best = nearest(&search, theme, i);
    }
    return best;
}

// The index of an ink among 16 colours, -1 for the default of the terminal.
static int find_16(colour_theme theme, ink i)
{
    int best = -1;
    if (i < INK_SERIES_0) {
        best = nearest_of_16(theme, i, 0);
    } else {
        // curves differ as long as there are colours
        unsigned taken = 0;
        for (int curve = INK_SERIES_0; curve <= (int)i; curve++) {
            best = nearest_of_16(theme, (ink)curve, taken);
            if (best >= 0) {
                taken |= 1u << best;
            }
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
    assert(theme < COLOUR_THEMES && i < INK_COUNT);

    // remembered with 2 added, so that 0 is unknown
    static short remembered[2][COLOUR_THEMES][INK_COUNT];
    short *known = &remembered[depth == DEPTH_256][theme][i];
    if (*known == 0) {
        int found;
        if (depth == DEPTH_256) {
            found = find_256(theme, i);
        } else {
            found = find_16(theme, i);
        }
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

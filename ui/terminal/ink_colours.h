// The colours of inks: one table in red, green and blue for dark and for light
// backgrounds, from which the colours of terminals with fewer colours are computed.
#pragma once

#include "ui/terminal/screen.h"

typedef struct rgb {
    unsigned char red, green, blue;
} rgb;

// The colour of an ink; false if it is the terminal's default text colour.
bool ink_rgb(colour_theme theme, ink i, rgb *colour);
// The same as one of 256 colours, or of 16 with any other depth: the nearest one that is
// readable;
// -1 for the terminal's default.
int ink_index(colour_theme theme, ink i, colour_depth depth);

// Whether two inks have the same colour on a terminal with that many colours.
bool inks_look_alike(colour_theme theme, colour_depth depth, ink a, ink b);

// The two backgrounds for which a theme is designed: the plainest one, and the usual one
// with the least contrast.
const rgb *theme_grounds(colour_theme theme);

// The usual colour of one of 256 colours on terminals; those of 16 are the first.
rgb colour_256(int index);

// Contrast of two colours, 1 to 21, as in WCAG 2; text needs 4.5.
double rgb_contrast(rgb a, rgb b);
// Distance of two colours in OKLab; that of black and white is 1.
double rgb_distance(rgb a, rgb b);

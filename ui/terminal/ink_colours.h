// What colour an ink has: one table in red, green and blue for dark and for light ground; what a
// terminal with fewer colours shows is computed from it.
#pragma once

#include "ui/terminal/screen.h"

typedef struct rgb {
    unsigned char red, green, blue;
} rgb;

// The colour of an ink; false where it is the terminal's own for text.
bool ink_rgb(colour_theme theme, ink i, rgb *colour);
// The same as one of 256 colours, or of 16, as near to it as still can be read; -1 for the
// terminal's own.
int ink_256(colour_theme theme, ink i);
int ink_16(colour_theme theme, ink i);

// Whether two inks come out as one colour on a terminal of so many.
bool inks_look_alike(colour_theme theme, colour_depth depth, ink a, ink b);

// Grounds that a theme is made for, two: the plainest one and the least contrasting usual one.
const rgb *theme_grounds(colour_theme theme);

// What terminals show for one of 256 colours, as far as they agree, or for one of 16.
rgb colour_256(int index);
rgb colour_16(int index);

// Contrast of two colours, 1 to 21, as in WCAG 2: text wants 4.5.
double rgb_contrast(rgb a, rgb b);
// How different two colours look, in OKLab; black and white are 1 apart.
double rgb_distance(rgb a, rgb b);

// How the explorer looks on its terminal, and the words that commands and settings have for that.
#pragma once

#include "ui/terminal/screen.h"

typedef struct looks {
    glyph_set glyphs;
    colour_theme theme;
    colour_depth depth;
    bool mouse;  // it reports to the explorer
    bool redraw; // the whole screen is to be drawn anew
} looks;

// The words for each value of the enumerations, in their order.
extern const char *const glyph_set_words[GLYPH_SETS];
extern const char *const colour_theme_words[COLOUR_THEMES];
extern const char *const colour_depth_words[COLOUR_DEPTHS];
extern const char *const mouse_words[2];

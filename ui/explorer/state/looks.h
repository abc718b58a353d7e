// The appearance of the explorer, and the words for it in commands and settings.
#pragma once

#include "ui/terminal/screen.h"

// Which lanes are shown below the curves.
typedef enum lane_choice {
    LANES_AUTO, // as many as there is room for
    LANES_ALL,
    LANES_OFF,
    LANE_CHOICES
} lane_choice;

// Whether a close-up of the contact is shown.
typedef enum close_up_choice {
    CLOSE_UP_AUTO, // if the terminal has pixels
    CLOSE_UP_ON,
    CLOSE_UP_OFF,
    CLOSE_UP_CHOICES
} close_up_choice;

typedef struct looks {
    glyph_set glyphs;
    colour_theme theme;
    colour_depth depth;
    colour_depth shown_depth; // the depth in use; DEPTH_AUTO without a terminal
    lane_choice lanes;
    bool pixels; // pictures are drawn if the terminal has them
    close_up_choice close_up;
    double bending; // factor by which bending is enlarged
    bool mouse;     // mouse reports are on
    bool redraw;    // the whole screen must be redrawn
} looks;

// The words for each value of the enumerations, in their order.
extern const char *const glyph_set_words[GLYPH_SETS];
extern const char *const colour_theme_words[COLOUR_THEMES];
extern const char *const colour_depth_words[COLOUR_DEPTHS];
extern const char *const lane_choice_words[LANE_CHOICES];
extern const char *const close_up_words[CLOSE_UP_CHOICES];
extern const char *const mouse_words[2];
extern const char *const pixel_words[2];

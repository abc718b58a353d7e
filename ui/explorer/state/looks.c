#include "ui/explorer/state/looks.h"

const char *const glyph_set_words[GLYPH_SETS] = {
    [GLYPHS_BRAILLE] = "braille", [GLYPHS_BLOCKS] = "blocks", [GLYPHS_ASCII] = "ascii"};

const char *const colour_theme_words[COLOUR_THEMES] = {
    [COLOURS_DARK] = "dark", [COLOURS_LIGHT] = "light", [COLOURS_MONO] = "mono"};

const char *const colour_depth_words[COLOUR_DEPTHS] = {[DEPTH_AUTO] = "auto",
                                                       [DEPTH_TRUE] = "true",
                                                       [DEPTH_256] = "256",
                                                       [DEPTH_16] = "16",
                                                       [DEPTH_MONO] = "mono"};

const char *const lane_choice_words[LANE_CHOICES] = {
    [LANES_AUTO] = "auto", [LANES_ALL] = "all", [LANES_OFF] = "off"};

const char *const close_up_words[CLOSE_UP_CHOICES] = {
    [CLOSE_UP_AUTO] = "auto", [CLOSE_UP_ON] = "on", [CLOSE_UP_OFF] = "off"};

const char *const pixel_words[2] = {"off", "auto"};

const char *const mouse_words[2] = {"off", "on"};

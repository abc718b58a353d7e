#include "ui/explorer/state/view.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// --- panels -----------------------------------------------------------------------------------

static const panel_place places[PANEL_IDS] = {
#define PANEL_PLACE(id, place, description) [id] = place,
    PANEL_LIST(PANEL_PLACE)
#undef PANEL_PLACE
};

panel_place panel_place_of(panel_id id)
{
    assert(id > PANEL_NONE && id < PANEL_IDS);
    return places[id];
}

panel_id panel_first_on_side(void)
{
    int id = PANEL_NONE + 1;
    while (places[id] != PLACE_SIDE) {
        id++;
    }
    return (panel_id)id;
}

// --- filters ----------------------------------------------------------------------------------

bool filter_passes(const char *filter, const char *text)
{
    char word[LINE_TEXT];
    while (*(filter += strspn(filter, " ")) != '\0') {
        const size_t length = strcspn(filter, " ");
        snprintf(word, sizeof word, "%.*s", (int)length, filter);
        if (strcasestr(text, word) == NULL) {
            return false;
        }
        filter += length;
    }
    return true;
}

// --- looks ------------------------------------------------------------------------------------

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

const char *const colour_by_words[2] = {"signal", "run"};

const char *const mouse_words[2] = {"off", "on"};

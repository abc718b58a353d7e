// Common to all pages: theme, rectangles on the page, a report of what was drawn where,
// colours.
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "src/tables/signals.h"

enum {
    FIGURE_PANELS = 16, // most panels of a figure
    FIGURE_TEXTS = 512, // most texts of a report
};

typedef enum figure_theme {
    THEME_COLOUR, // Okabe and Ito's colours on white
    THEME_MONO,   // black and greys on white
    THEME_DARK    // Okabe and Ito's colours on near black
} figure_theme;

// The look of a page; fields that are zero leave it to the page.
typedef struct page_look {
    figure_theme theme;
    double width, height; // of the page [mm]
    double dpi;           // of a PNG; 0: 200
    const char *font;     // family; NULL: the default
    double letters;       // size of labels [pt]; 0: 8; all other letters in proportion
    bool bare;            // without title and caption
    bool transparent;     // without a background
} page_look;

// Sizes of letters [pt].
#define LETTERS_NORMAL 8.0 // of labels
#define LETTERS_LEAST  6.0 // of anything but indices

// Size of letters that are `size` where labels have 8 pt, for labels of `letters` (0: 8);
// never less than is readable.
double page_letters(double letters, double size);

// A rectangle on the page [pt], y downwards.
typedef struct figure_rect {
    double x, y, width, height;
} figure_rect;

typedef struct figure_text {
    figure_rect place; // upright, also round a rotated text
    double size;       // of its letters on the page [pt]; indices have 70 % of it
    char text[64];     // its beginning, without markup
} figure_text;

// The values at the edges of a panel.
typedef struct figure_range {
    double x_low, x_high, y_low, y_high;
    bool x_logarithmic, y_logarithmic;
} figure_range;

// Positions of everything that was drawn.
typedef struct figure_report {
    figure_rect page;
    figure_range ranges[FIGURE_PANELS];
    figure_rect panels[FIGURE_PANELS];  // inside the axes
    figure_rect legends[FIGURE_PANELS]; // width 0: none
    figure_rect insets[FIGURE_PANELS];  // with their labels; width 0: none
    int panel_count;
    figure_text texts[FIGURE_TEXTS];
    int text_count;
} figure_report;

// Adds a text with letters of a size on the page [pt] and its place on the page to a
// report (may be NULL).
void report_add_text(figure_report *report, const char *markup, double size,
                     figure_rect place);

// --- colours and line patterns of figures: palette.c

typedef struct colour {
    double red, green, blue;
} colour;

// The colours of everything but the curves.
typedef struct palette {
    colour page, text, faint_text, axis, grid, shade, mark;
} palette;

const palette *palette_of(figure_theme theme);

// Slots for the colours of series, as they are on white.
enum {
    SLOT_BLUE,
    SLOT_ORANGE,
    SLOT_GREEN,
    SLOT_SKY_BLUE,
    SLOT_PURPLE,
    SLOT_VERMILLION,
    SLOT_BLACK,
    SLOT_GREY,
    PALETTE_SLOTS
};

// The colour of a slot; in a mono figure by the series' place in its panel.
colour palette_series(figure_theme theme, int slot, int place);

// The slots in the order in which they differ most, again from the eighth on.
int palette_slot(int index);

// The colour at share 0 ... 1 of the colour scale. Mono: greys from dark to nearly white.
// Else viridis of van der Walt and Smith (2015, public domain), straight lines between
// nine of its colours. Perceptually uniform, from dark blue to yellow, with lightness
// increasing throughout, so that it is readable when printed in grey.
colour palette_shade(figure_theme theme, double share);

// The colour at a share of the way from a to b.
colour colour_between(colour a, colour b, double share);

void set_colour(cairo_t *cr, colour c);

// Sets the dash pattern for a line of the given width.
void set_line_style(cairo_t *cr, line_style style, double width);

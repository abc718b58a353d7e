// Pictures on a screen of cells: pixels in the place of some cells, drawn by cairo. What is written
// over a picture afterwards, letter or blank, is seen in its place; the rest of the picture stays.
#pragma once

#include <cairo.h>

#include "ui/terminal/ink_colours.h"
#include "ui/terminal/screen.h"

enum { PICTURES = 16, PICTURE_REGIONS = 128 };

typedef struct screen_picture {
    int x, y, width, height;  // [cells]
    cairo_surface_t *surface; // RGB24, width x height cells
} screen_picture;

// The pictures of a screen, kept from one drawing to the next so that their surfaces are.
typedef struct picture_layer {
    int cell_width, cell_height; // [pixels]
    rgb ground;                  // of the terminal
    screen_picture items[PICTURES];
    int count;
} picture_layer;

// A rectangle of cells in which a picture is seen.
typedef struct picture_region {
    int picture;
    int x, y, width, height; // on the screen [cells]
} picture_region;

// Gives back the surfaces.
void pictures_finish(picture_layer *layer);

// Begins another drawing: no cell shows a picture yet. Nothing to do for a screen without them.
void pictures_clear(screen *s);

// Begins a picture that covers a rectangle of cells, kept within the screen: the context has pixels
// as its unit and its origin in the upper left corner, the ground is painted. NULL if the screen
// has no pictures, or for want of memory; then the cells are as they were. picture_end is due.
cairo_t *picture_begin(screen *s, int x, int y, int width, int height);

// Ends the picture that was begun last on that screen. Where cairo could not draw all of it, which
// only a lack of memory prevents, words in its middle say so in its place.
void picture_end(screen *s, cairo_t *cr);

// The rectangles in which pictures are seen, at most PICTURE_REGIONS, none wider or higher than
// `most_width` x `most_height` cells; returns how many.
int pictures_regions(const screen *s, int most_width, int most_height,
                     picture_region regions[PICTURE_REGIONS]);

// An ink as pictures show it; what has the terminal's own text colour is black or white there.
rgb picture_ink(const screen *s, colour_theme theme, ink i);

// Pictures on a screen of cells: pixels instead of some cells, drawn by cairo. Characters
// and blanks written over a picture afterwards replace it in their cells.
#pragma once

#include <cairo.h>

#include "ui/terminal/ink_colours.h"
#include "ui/terminal/pixels.h"
#include "ui/terminal/screen.h"

enum { PICTURES = 16, PICTURE_REGIONS = 128 };

typedef struct screen_picture {
    int x, y, width, height;  // [cells]
    cairo_surface_t *surface; // RGB24, width x height cells
} screen_picture;

// The pictures of a screen, kept from one drawing to the next so that their surfaces are
// reused.
typedef struct picture_layer {
    int cell_width, cell_height; // [pixels]
    rgb ground;                  // of the terminal
    screen_picture items[PICTURES];
    int count;
} picture_layer;

// A rectangle of cells in which a picture is visible.
typedef struct picture_region {
    int picture;
    int x, y, width, height; // on the screen [cells]
} picture_region;

// Frees the surfaces.
void pictures_finish(picture_layer *layer);

// Begins a new drawing: no cell shows a picture yet. Does nothing for a screen without
// pictures.
void pictures_clear(screen *s);

// Begins a picture that covers a rectangle of cells, clipped to the screen. The context
// has pixels as its unit and its origin in the upper left corner; the background is
// painted. NULL if the screen has no pictures or without memory; the cells are then
// unchanged. To be ended with picture_end.
cairo_t *picture_begin(screen *s, int x, int y, int width, int height);

// Ends the picture that was begun last on that screen. If cairo could not draw all of it,
// which happens only without memory, a message in its middle replaces it.
void picture_end(screen *s, cairo_t *cr);

// The rectangles in which pictures are visible, at most PICTURE_REGIONS, none wider or
// higher than `most_width` x `most_height` cells; returns how many.
int pictures_regions(const screen *s, int most_width, int most_height,
                     picture_region regions[PICTURE_REGIONS]);

// The part of a picture that a region shows.
pixel_block picture_block(const screen *s, const picture_region *r);

// The colour of an ink in pictures; the terminal's default text colour becomes black or
// white.
rgb picture_ink(const screen *s, colour_theme theme, ink i);

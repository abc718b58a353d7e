// An image of opaque pixels in memory, drawn on again and again.
#pragma once

#include <cairo.h>
#include <stdbool.h>
#include <stdint.h>

#include "render/page/page.h"

// Gives *image (NULL: none yet) a size [pixels]; one that fits is kept, unless cairo met
// an error in it. False without memory.
bool pixel_image_fit(cairo_surface_t **image, int width, int height);

// Begins a drawing on an image that is filled with a colour. The unit is a pixel, the
// origin the upper left corner. To be ended with pixel_image_end.
cairo_t *pixel_image_begin(cairo_surface_t *image, colour ground);

// Ends a drawing; false if cairo could not draw all of it, for want of memory.
bool pixel_image_end(cairo_t *cr);

// Its pixels 0xRRGGBB (higher bits are undefined), *stride of them from row to row.
const uint32_t *pixel_image_rows(cairo_surface_t *image, int *stride);

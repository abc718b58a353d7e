// Triangles as samples: several colours and depths for every pixel of a picture, whose means are
// painted over it. Nearer triangles hide farther ones.
#pragma once

#include <cairo.h>
#include <stdbool.h>
#include <stdint.h>

#include "render/scene/gl_offscreen.h"

enum { SAMPLE_TILE = 16 }; // edge of a tile [pixels]

// The samples of a picture of width by height pixels. Tiles that nothing touched are skipped.
typedef struct sample_buffer {
    int width, height; // of the picture [pixels]
    int samples;       // of a pixel along each edge
    // 0xAARRGGBB; if triangles are filled without OpenGL, 0 and empty depths between pictures
    uint32_t *pixels;
    float *depths; // NULL: OpenGL fills the pixels
    unsigned char *touched;
    int tiles_across, tiles_down;
} sample_buffer;

// Empty samples, with depths if triangles are filled without OpenGL. False without memory;
// samples_finish must be called in either case.
bool samples_init(sample_buffer *b, int width, int height, int samples);
bool samples_add_depths(sample_buffer *b);
void samples_finish(sample_buffer *b);

// Adds a new set of triangles, of closed solids: records the tiles that they touch and, if there
// are depths, fills them. Back faces are omitted.
void samples_take(sample_buffer *b, const gl_triangles *t);

// Paints the means of the samples over the image surface (RGB24 or ARGB32, of the picture's size)
// with the given opacity (0 to 1). `region` is the part of the picture in `pixels`, with contiguous
// rows. Samples filled without OpenGL are empty afterwards.
void samples_lay_over(sample_buffer *b, gl_region region, double opacity, cairo_surface_t *onto);

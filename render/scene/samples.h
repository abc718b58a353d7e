// Triangles as samples: several colours and depths for every pixel of a picture, and their means
// laid over it. Nearer triangles hide what lies behind them.
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
    // 0xAARRGGBB; between pictures 0 where triangles are filled by hand, with depths of nothing
    uint32_t *pixels;
    float *depths; // NULL: OpenGL fills the pixels
    unsigned char *touched;
    int tiles_across, tiles_down;
} sample_buffer;

// Empty samples; with depths where triangles are to be filled by hand. False without memory;
// samples_finish in either case.
bool samples_init(sample_buffer *b, int width, int height, int samples);
bool samples_add_depths(sample_buffer *b);
void samples_finish(sample_buffer *b);

// Takes a new set of triangles, of closed solids: remembers the tiles that they touch, and where
// there are depths fills them. Those seen from behind are left out.
void samples_take(sample_buffer *b, const gl_triangles *t);

// Lays the means of the samples over the image surface (RGB24 or ARGB32, of the picture's size), as
// much of them as the opacity (0 to 1) lets through. `region` is the part of the picture that
// `pixels` holds, its rows without gaps. Samples filled by hand are empty again afterwards.
void samples_lay_over(sample_buffer *b, gl_region region, double opacity, cairo_surface_t *onto);

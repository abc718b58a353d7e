// Triangles as samples of a picture, filled by OpenGL or without it.
#pragma once

#include <cairo.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "src/base/fault.h"

typedef enum gl_library { GL_OSMESA, GL_EGL } gl_library;

typedef struct gl_offscreen gl_offscreen;

// A vertex of a triangle for OpenGL.
typedef struct gl_vertex {
    float place[4];  // clip coordinates, y down
    float colour[4]; // red, green, blue, opacity
} gl_vertex;

// A renderer of pictures of up to width by height pixels. STATUS_CANNOT_WRITE if the library is
// missing or has no OpenGL 3.3, with what to install in f.
status gl_offscreen_create(gl_offscreen **out, gl_library library, int width, int height, fault *f);
void gl_offscreen_destroy(gl_offscreen *g);

// Library, renderer and version, "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits), ...".
const char *gl_offscreen_renderer(const gl_offscreen *g);

// Triangles, three corners each, as numbers of vertices.
typedef struct gl_triangles {
    const gl_vertex *vertices;
    size_t vertex_count;
    const unsigned *corners;
    size_t corner_count;
} gl_triangles;

// A rectangle of pixels.
typedef struct gl_region {
    int x, y, width, height;
} gl_region;

// Draws triangles on a transparent background with a depth test and stores the region as rows of
// 0xAARRGGBB with premultiplied opacity.
status gl_offscreen_draw(gl_offscreen *g, const gl_triangles *t, gl_region region, uint32_t *pixels,
                         fault *f);

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

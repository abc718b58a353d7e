// OpenGL without a screen: a software renderer that is loaded when first used.
//
// Neither library is linked. OSMesa alone would add 20 ms and 50 MB to the start of every command.
#pragma once

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

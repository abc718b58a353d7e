// Paints lit triangles onto a cairo picture: by OpenGL without a screen, or with a depth buffer of
// our own if OpenGL is missing.
#pragma once

#include "render/scene/geometry.h"
#include "src/base/fault.h"

// The requested renderer.
typedef enum scene_renderer { RENDER_AUTO, RENDER_OSMESA, RENDER_EGL, RENDER_CAIRO } scene_renderer;

typedef struct scene_painter scene_painter;

// "auto", "osmesa", "egl" or "cairo"; false for any other word.
bool scene_renderer_find(const char *name, scene_renderer *which);

// Samples of a pixel along each of its edges.
enum { SAMPLES_QUICK = 2, SAMPLES_FINE = 4 };

// A painter of pictures of width by height pixels, each made of samples x samples. RENDER_AUTO
// takes the first of OSMesa, EGL and cairo that is available. STATUS_CANNOT_WRITE if a named one is
// not.
status scene_painter_create(scene_painter **out, scene_renderer which, int width, int height,
                            int samples, fault *f);
void scene_painter_destroy(scene_painter *p);

// Name of the renderer, for the picture's metadata.
const char *scene_painter_name(const scene_painter *p);

// The mesh to be painted, with camera and light.
typedef struct painting {
    const mesh *mesh;
    const camera *camera;
    vector light;   // unit vector towards the lamp
    double opacity; // of the whole mesh, 0 to 1
} painting;

// Paints the mesh over the contents of the image surface (RGB24 or ARGB32, of the painter's size).
// STATUS_NO_MEMORY or STATUS_CANNOT_WRITE on failure.
status scene_painter_paint(scene_painter *p, const painting *what, cairo_surface_t *onto, fault *f);

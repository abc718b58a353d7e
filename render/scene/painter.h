// Paints lit triangles onto a cairo picture: by OpenGL without a screen, or with a depth buffer of
// our own where there is none.
#pragma once

#include "render/scene/camera.h"
#include "src/base/fault.h"

// Which renderer is asked for.
typedef enum scene_renderer { RENDER_AUTO, RENDER_OSMESA, RENDER_EGL, RENDER_CAIRO } scene_renderer;

typedef struct scene_painter scene_painter;

// "auto", "osmesa", "egl" or "cairo"; false if it is none of them.
bool scene_renderer_find(const char *name, scene_renderer *which);

// A painter of pictures of width by height pixels, each made of 2 x 2 samples. RENDER_AUTO takes
// the first of OSMesa, EGL and cairo that is there. STATUS_CANNOT_WRITE if the one that was named
// is not.
status scene_painter_create(scene_painter **out, scene_renderer which, int width, int height,
                            fault *f);
void scene_painter_destroy(scene_painter *p);

// What paints, for the picture's metadata.
const char *scene_painter_name(const scene_painter *p);

// Paints the mesh over what the image surface (RGB24, of the painter's size) shows. `light` is the
// unit vector towards the lamp. STATUS_NO_MEMORY or STATUS_CANNOT_WRITE if it cannot.
status scene_painter_paint(scene_painter *p, const mesh *m, const camera *c, vector light,
                           cairo_surface_t *onto, fault *f);

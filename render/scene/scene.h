// Pictures of a recorded run: the arm in space, once or at many instants in one picture.
//
// The arm swings in the x-y plane; z points up, towards the reader of a plan. The beam is
// drawn as the curve that starts at the hub along the first link, ends at the tip along
// the last one and touches every other link at its middle (a quadratic B-spline over the
// joints): it bends nowhere more than the links do.
#pragma once

#include <glib.h>

#include "render/scene/geometry.h"
#include "src/run/run.h"

// The requested renderer.
typedef enum scene_renderer {
    RENDER_AUTO,
    RENDER_OSMESA,
    RENDER_EGL,
    RENDER_CAIRO
} scene_renderer;

// "auto", "osmesa", "egl" or "cairo"; false for any other word.
bool scene_renderer_find(const char *name, scene_renderer *which);

// A rectangle of pixels.
typedef struct pixel_box {
    int x, y, width, height;
} pixel_box;

// Samples of a pixel along each of its edges.
enum { SAMPLES_QUICK = 2, SAMPLES_FINE = 4 };

enum { SCENE_INSTANTS = 32 }; // most instants in one picture

#define SCENE_LETTERS 16.0 // letters at a scale of 1 [pixels]

typedef struct scene_options {
    camera_view camera;
    scene_renderer renderer;
    int width, height; // [pixels]; 0: 1280 x 720
    int samples;       // of a pixel along each edge; 0: SAMPLES_FINE
    bool plain;        // no text
    bool keyless;      // no legend of the instants
    double letters; // scale of letters, 1 for a picture 720 pixels high; 0: by its size
    // factor by which bending is enlarged, said in the caption unless it is 1; 0: that of
    // scene_bending_auto
    double exaggerate;
    int rank;           // of a run among others, whose colour its arm has; 0: alone
    double force;       // of the longest arrow [N], at least the run's own largest
    double impulse;     // of the largest flash [N s], likewise
    bool inset;         // close-up of the contact in a corner, at least twice as large
    double least_scale; // of CAMERA_TIP at the contact [pixels/m]; 0: none
    double dpi;         // of a file; 0: 144
    figure_theme theme; // in THEME_MONO all is grey
    bool transparent;   // without floor and background, for a surface ARGB32
} scene_options;

typedef struct scene scene;

// Raises the options' force and impulse to the largest of a run, so that pictures of
// several runs have one scale.
void scene_options_scale(scene_options *o, const trace *t);

// Prepares pictures of a run, which must outlive them and have its trace.
// STATUS_BAD_ARGUMENT for a size out of range or a run without rows, STATUS_CANNOT_READ
// if the font is missing, otherwise the status of scene_painter_create.
status scene_create(scene **out, const scenario *s, const run_result *result,
                    const scene_options *options, fault *f);
void scene_destroy(scene *sc);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(scene, scene_destroy)

// Name of the renderer, for metadata.
const char *scene_renderer_name(const scene *sc);

// Paints the arm at the instants [s], ascending, the last in full colour and earlier ones
// as ghosts behind it, fainter the earlier, over the whole image surface (RGB24, or
// ARGB32 where the scene is transparent, of the scene's size).
status scene_paint(scene *sc, const double *times, int count, cairo_surface_t *onto,
                   fault *f);

// Instants [s] for a picture of the whole approach: `count` of them, evenly spaced along
// the tip's path from the start to the largest force of the first pulse (or to the end
// without a contact).
void scene_instants(const run_result *result, double *times, int count);

// The joints of the arm at time t [s]: links + 1 places in the plane, hub first,
// interpolated between rows. Returns the row interpolated likewise.
sample scene_joints(const trace *t, const parameters *p, double time, vector *joints);

// How far a wall that moves is from its place at rest in a row, along its normal [m];
// else 0.
vector scene_wall_shift(const parameters *p, const sample *row);

// The factor 1, 2, 5, 10, 20, 50 or 100 by which a run's largest bending shows best: the
// beam's curve is then at most a twelfth of its length off the line from hub to tip.
double scene_bending_auto(const scenario *s, const run_result *result);

// Enlarges the bending: the distances of the joints from the line from hub to tip are
// multiplied by the factor (0 or 1: unchanged), so that hub and tip do not move.
void scene_exaggerate(vector *joints, int links, double factor);

// The beam's curve through the joints (see above), for which there must be room for
// scene_curve_length(links) points. Returns how many were written.
int scene_curve(const vector *joints, int links, vector *curve);
int scene_curve_length(int links);

// A picture for a file.
typedef struct scene_picture {
    const scenario *scenario;
    const run_result *result; // with its trace
    scene_options options;
    const double *times; // instants [s], ascending
    int count;           // of them, 1 to SCENE_INSTANTS
} scene_picture;

// Writes it as PNG, completely or not at all, with scenario, parameters, version and
// renderer in its metadata. STATUS_BAD_ARGUMENT for an instant outside the run, otherwise
// the status of scene_create and scene_paint, or STATUS_CANNOT_WRITE.
status scene_write(const scene_picture *p, const char *path, fault *f);

// Checks in advance whether scene_write can write to path.
status scene_check_path(const char *path, fault *f);

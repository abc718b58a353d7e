// Shared by the parts of a scene: scene_solids.c builds the meshes, scene_view.c places camera,
// light and floor, scene_paint.c paints, scene_file.c writes.
#pragma once

#include <pango/pangocairo.h>

#include "render/scene/floor.h"
#include "render/scene/scene.h"

enum { TRAIL_POINTS = 240 };

// Sizes in beam lengths, used by the solids and the view.
#define BEAM_HEIGHT    0.050
#define BEAM_THICKNESS 0.011
#define MOTOR_RADIUS   0.082
#define FLOOR_LEVEL    (-0.150)
#define PIN_TOP        0.062
#define SLAB_FROM      0.965 // of the flat wall, along the arm
#define SLAB_TO        1.10
#define SLAB_THICKNESS 0.030
#define ARROW_LENGTH   0.26 // of the largest force

// Colours of the arm's surroundings.
typedef struct surroundings {
    colour page, ground, line; // of the page, the floor and the grid
    colour far;                // colour of the distant past
    colour strong, faint;      // of letters
} surroundings;

struct scene {
    const scenario *scenario;
    const run_result *result;
    scene_options options;
    int links;
    double length; // of the beam [m]
    double grid;   // [m]
    camera camera;
    vector light;
    scene_floor floor;
    scene_painter *painter;
    PangoContext *context;
    const surroundings *around;
    struct scene *tip; // the inset's own scene, or NULL
    mesh mesh, ghost;
    vector *joints, *curve;
    vector trail[TRAIL_POINTS];
    material trail_of[TRAIL_POINTS];
};

// The point at distance x along a direction [rad] in the plane, y across it, and z above.
vector at_angle(double angle, double x, double y, double z);

// A material blended with the colour of the distant past, by a share of 0 to 1.
material scene_paler(const scene *sc, material m, double share);

// The steel of the beam.
extern const material beam_steel;

// Sets sc->joints to the joints at an instant [s], with the bending as drawn. Returns the row of
// that instant.
sample scene_shape(scene *sc, double time);

// The point of action of the force: the contact point, on the near side of the beam.
vector scene_contact(const scene *sc, const vector *joints);

// The wall's force on the beam, as an arrow from the contact point away from the wall, for
// sc->joints of that row. False if it is not visible.
bool scene_force_arrow(const scene *sc, const sample *row, vector *start, vector *end);

// Adds to sc->mesh the motor with the hub at an angle [rad], the wall, and the tip's path from one
// instant [s] to another, paler for earlier times.
void scene_build_hub(scene *sc, double angle);
void scene_build_wall(scene *sc);
void scene_build_trail(scene *sc, double from, double time);

// Adds the arm at an instant [s] and the wall's force on it to a mesh of the scene.
void scene_build_arm(scene *sc, mesh *into, double time);

// The largest of 1, 2 or 5 times a power of ten that is at most a tenth of the length [m].
double scene_grid_of(double length);

// Places camera, light and floor so that the whole run is visible. STATUS_NO_MEMORY if there is no
// room for the floor.
status scene_set_view(scene *sc, fault *f);

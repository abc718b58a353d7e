// Geometry of scenes: vectors, solids of arm, wall and arrow as triangles, and the
// camera.
//
// Lengths are in metres. Triangles are opaque; solids are closed, so that back faces are
// not needed.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "render/page/page.h"
#include "src/base/fault.h"

typedef struct vector {
    double x, y, z;
} vector;

vector vector_add(vector a, vector b);
vector vector_scaled(vector a, double factor);
vector vector_sum(vector a, double factor, vector b); // a + factor b
double vector_dot(vector a, vector b);
vector vector_unit(vector a);

typedef struct material {
    colour colour; // as on a screen
    double shine;  // of highlights, 0 to 1
} material;

typedef struct mesh_vertex {
    vector place, normal; // [m], [-]
    material material;
} mesh_vertex;

typedef struct mesh {
    mesh_vertex *vertices;
    unsigned *corners; // three of each triangle
    size_t vertex_count, vertex_capacity;
    size_t corner_count, corner_capacity;
} mesh;

void mesh_finish(mesh *m);

// A circle of a solid of revolution.
typedef struct lathe_ring {
    double along, radius; // [m]
} lathe_ring;

// A solid of revolution about the axis (a unit vector) through base, from one circle to
// the next.
void mesh_lathe(mesh *m, vector base, vector axis, const lathe_ring *rings, int count,
                material of);

// A box: its centre and half edges.
typedef struct box {
    vector centre, u, v, w; // [m]
} box;

// A box whose faces are divided into cells of about the given size, because light is
// computed only at vertices.
void mesh_box(mesh *m, const box *b, double cell, material of);

// A strip standing on its edge along the points: thickness in the x-y plane, height along
// z.
void mesh_ribbon(mesh *m, const vector *places, int count, double height,
                 double thickness, material of);

// A tube along the points, with a material for each.
void mesh_tube(mesh *m, const vector *places, const material *of, int count,
               double radius);

// An arrow from start along a unit vector.
void mesh_arrow(mesh *m, vector start, vector direction, double length, double radius,
                material of);

// --- the viewpoint, and the projection of points onto the picture

typedef enum camera_kind {
    CAMERA_THREE_QUARTER,
    CAMERA_TOP,
    CAMERA_SIDE,
    CAMERA_TIP, // close-up of the contact
    CAMERA_FREE // by its own angles
} camera_kind;

// The viewpoint of a scene.
typedef struct camera_view {
    camera_kind kind;
    double azimuth, elevation; // of CAMERA_FREE: from the arm's heading to the left, and
                               // above the floor [degrees]
} camera_view;

typedef struct camera {
    vector eye;               // [m]
    vector right, up, back;   // unit vectors; back points from the scene to the eye
    double focal_x, focal_y;  // distance over half the size of the picture [-]
    double nearest, farthest; // depths of the nearest and farthest visible point [m]
    double width, height;     // of the picture [pixels]
} camera;

// The rectangle of the picture for the scene, as shares of its width and height.
typedef struct camera_window {
    double left, top, right, bottom;
} camera_window;

// "three-quarter", "top", "side", "tip", or two angles "-60,40" (azimuth -360 to 360,
// elevation 1 to 90); false if it is neither.
bool camera_read(const char *text, camera_view *view);

// The camera of a view that shows all points inside the window, as large as possible.
// `heading` [rad] is the direction of the arm, so that every arm is seen from the same
// side.
camera camera_fit(camera_view view, double heading, const vector *points, int count,
                  int width, int height, camera_window window);

// The position of a point on the picture: x to the right and y down [pixels], and its
// depth [m].
vector camera_project(const camera *c, vector point);

// The ray through a point of the picture: eye + s * returned vector, s > 0.
vector camera_ray(const camera *c, double x, double y);

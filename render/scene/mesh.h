// Solids of a scene as triangles: parts of arm, wall and arrow.
//
// Lengths are in metres. Triangles are opaque; solids are closed, so that back faces are not
// needed.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "render/page/palette.h"
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
    bool out_of_memory; // once true, nothing more is added
} mesh;

void mesh_finish(mesh *m);
// Clears the mesh and keeps its memory for the next picture.
void mesh_clear(mesh *m);

// A circle of a solid of revolution.
typedef struct lathe_ring {
    double along, radius; // [m]
} lathe_ring;

// A solid of revolution about the axis (a unit vector) through base, from one circle to the next.
void mesh_lathe(mesh *m, vector base, vector axis, const lathe_ring *rings, int count, material of);

// A box: its centre and half edges.
typedef struct box {
    vector centre, u, v, w; // [m]
} box;

// A box whose faces are divided into cells of about the given size, because light is computed only
// at vertices.
void mesh_box(mesh *m, const box *b, double cell, material of);

// A strip standing on its edge along the points: thickness in the x-y plane, height along z.
void mesh_ribbon(mesh *m, const vector *places, int count, double height, double thickness,
                 material of);

// A tube along the points, with a material for each.
void mesh_tube(mesh *m, const vector *places, const material *of, int count, double radius);

// An arrow from start along a unit vector.
void mesh_arrow(mesh *m, vector start, vector direction, double length, double radius, material of);

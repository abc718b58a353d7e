// The floor of a scene: a pale plane with a grid that fades into the page, and soft shadows on it.
#pragma once

#include "render/scene/camera.h"
#include "src/base/fault.h"

typedef struct scene_floor {
    double level;                     // height of the floor [m]
    double grid;                      // distance of the lines [m]
    vector middle;                    // point about which the floor fades out
    double reach;                     // distance from there at which it has faded completely [m]
    colour page, ground_colour, line; // colours of the page, the floor and the grid
    vector light;                     // unit vector towards the light
    int width, height;                // of the picture [pixels]
    camera camera;                    // camera of the picture
    unsigned *ground;                 // the floor without shadows, 0xFFRRGGBB
    float *x, *y;                     // position of every pixel on the floor [m]
    unsigned char *mask;              // shadow on a map of the floor, and room for smoothing
    unsigned char *spare;
    double map_left, map_low, map_cell; // corner of the map and size of its cells [m]
} scene_floor;

// Prepares the floor of a picture: level, grid, middle, reach and light and colours are set by the
// caller. STATUS_NO_MEMORY if there is no room.
status scene_floor_init(scene_floor *floor, const camera *c, fault *f);
void scene_floor_finish(scene_floor *floor);

// Paints the floor with the mesh's shadow over the whole image surface (RGB24, of the picture's
// size). STATUS_NO_MEMORY if cairo has none.
status scene_floor_paint(scene_floor *floor, const mesh *m, cairo_surface_t *onto, fault *f);

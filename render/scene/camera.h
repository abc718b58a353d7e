// Where a scene is seen from, and how its points come to lie on the picture.
#pragma once

#include "render/scene/mesh.h"

typedef enum camera_kind {
    CAMERA_THREE_QUARTER,
    CAMERA_TOP,
    CAMERA_SIDE,
    CAMERA_TIP, // the contact from near by
    CAMERA_FREE // by its own angles
} camera_kind;

// Where a scene is seen from.
typedef struct camera_view {
    camera_kind kind;
    double azimuth, elevation; // of CAMERA_FREE: from the arm's heading to the left, and above the
                               // floor [degrees]
} camera_view;

typedef struct camera {
    vector eye;               // [m]
    vector right, up, back;   // unit vectors; back points from the scene to the eye
    double focal_x, focal_y;  // half the picture over the distance, inverted [-]
    double nearest, farthest; // depth of what is to be seen [m]
    double width, height;     // of the picture [pixels]
} camera;

// A rectangle of the picture that the scene has to itself, as shares of its width and height.
typedef struct camera_window {
    double left, top, right, bottom;
} camera_window;

// "three-quarter", "top", "side", "tip", or two angles "-60,40" (azimuth -360 to 360, elevation 1
// to 90); false if it is none of them.
bool camera_read(const char *text, camera_view *view);

// The camera of a view that shows all of the points inside the window, as large as it can.
// `heading` [rad] is the direction in which the arm points, so that every arm is seen alike.
camera camera_fit(camera_view view, double heading, const vector *points, int count, int width,
                  int height, camera_window window);

// A point's place on the picture: x to the right and y down [pixels], and its depth [m].
vector camera_project(const camera *c, vector point);

// The ray through a place on the picture: eye + s * returned vector, s > 0.
vector camera_ray(const camera *c, double x, double y);

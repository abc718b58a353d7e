// The viewpoint of a scene, and the projection of its points onto the picture.
#pragma once

#include "render/scene/mesh.h"

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
    double azimuth, elevation; // of CAMERA_FREE: from the arm's heading to the left, and above the
                               // floor [degrees]
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

// "three-quarter", "top", "side", "tip", or two angles "-60,40" (azimuth -360 to 360, elevation 1
// to 90); false if it is neither.
bool camera_read(const char *text, camera_view *view);

// The camera of a view that shows all points inside the window, as large as possible. `heading`
// [rad] is the direction of the arm, so that every arm is seen from the same side.
camera camera_fit(camera_view view, double heading, const vector *points, int count, int width,
                  int height, camera_window window);

// The position of a point on the picture: x to the right and y down [pixels], and its depth [m].
vector camera_project(const camera *c, vector point);

// The ray through a point of the picture: eye + s * returned vector, s > 0.
vector camera_ray(const camera *c, double x, double y);

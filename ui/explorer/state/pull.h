// The tip pulled by the mouse through a spring from the tip to the pointer. While it is held the
// run plays, and every few milliseconds the spring's force is added to the run as a push. The pull
// is thus recorded as a list of timed inputs and is repeated when the run is computed again.
#pragma once

#include <stdbool.h>

#include "src/tables/parameters.h"
#include "src/run/trace.h"

#define PULL_STIFFNESS 10.0  // of the spring [N/m]
#define PULL_STEP      0.005 // of the run between two pushes [s]

// The area in which the arm was drawn last.
typedef struct arm_stage {
    int x, y, width, height; // [cells]; width 0: not drawn
    double left, bottom;     // of it [m]
    double across, up;       // [cells/m]
} arm_stage;

// A place in the plane, or a direction.
typedef struct plane_vector {
    double x, y; // [m]
} plane_vector;

typedef struct tip_pull {
    bool held;
    double x, y;      // of the pointer [m]
    double force;     // of the spring across the last link, towards growing angle [N]
    double next;      // when the next push is due [s]
    bool was_playing; // before it was held
    unsigned gesture; // number of this pull in the session's inputs
} tip_pull;

// The place of a cell's middle on the stage [m].
plane_vector stage_place(const arm_stage *g, int x, int y);

// The cell in which a place [m] is shown, which may be outside.
void stage_cell(const arm_stage *g, plane_vector place, int *x, int *y);

// The tip and the direction across the last link, towards growing angle, in a recorded row.
void recorded_tip(const trace *t, const arm_parameters *beam, size_t row, plane_vector *tip,
                  plane_vector *across);

// The spring's force across the last link [N].
double pull_force(const tip_pull *p, plane_vector tip, plane_vector across);

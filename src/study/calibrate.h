// The look-up table of (5.26), measured on the rig: how stiff the arm is under which
// force.
//
// The arm is pressed against the wall under one constant command after the other. Where
// it has come to rest, force sensor and encoder give K2 = f l / (2 (theta_2 -
// theta_imp)), the stiffness of the two-link beam's joint that stands for the whole beam.
// Nothing but what the sensors read is used.
#pragma once

#include <jansson.h>

#include "src/tables/k2_table.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// One command and what the sensors read under it: means over the end of the run.
typedef struct calibration_point {
    double command;      // [V]
    double force;        // [N]
    double angle;        // of the hub, from the wall as the controller believes it [rad]
    double k2;           // [N m/rad]
    double k2_over_arm;  // over arm.k2
    double force_spread; // standard deviation of the readings [N]
    double angle_spread; // the same [rad]
    double drift;        // of K2 from the first half of the window to the second, a share
} calibration_point;

typedef struct calibration {
    int count;
    calibration_point points[K2_TABLE_MOST];
} calibration;

// Presses the arm of the scenario, at rest where it touches the wall, with each of
// `count` commands [V] (at most K2_TABLE_MOST), on the scenario's rig but under the
// open-loop law and without its script. Each run lasts run.duration, at least 5 s, of
// which the last two fifths count. Press i has the seed control.seed + i. Fails with a
// sentence where a run fails (its status) and, with STATUS_BAD_ARGUMENT, where the arm
// does not press: the force reads zero or the hub stands at or before the wall's angle.
// STATUS_STOPPED if `monitor` (NULL: nobody looks on) asked for it; *c holds the presses
// before the failure or the stop in any case.
status calibrate(const scenario *s, const double *commands, int count,
                 run_monitor *monitor, calibration *c, fault *f);

// The table by growing force. STATUS_BAD_ARGUMENT if two commands press alike.
status calibration_table(const calibration *c, k2_table *t, fault *f);

// {"scenario": ..., "k2_table": text of control.k2_table, "points": [{"command_V",
// "force_N", "hub_angle_rad", "k2_Nm_per_rad", "k2_over_arm", "force_spread_N",
// "angle_spread_rad", "drift_percent"} ...]}. NULL without memory.
json_t *calibration_json(const calibration *c, const char *name, const char *table);

// One header row of the same keys, one row a command.
void calibration_csv(FILE *stream, const calibration *c);

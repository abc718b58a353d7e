// What the driver (src/run/run_driver.h) asks of a model of the arm: the corrected one
// (src/run/arm_run.h) and the printed one (src/run/printed_run.h) each fill in this table
// of functions, and the driver knows them by nothing else. `run` is the model's own
// storage, an arm_run or a printed_run.
#pragma once

#include "src/run/recording.h"

typedef struct run_model {
    bool takes_pushes;  // else a push is refused
    bool stops_at_rows; // it can be observed at the ends of its steps only

    // Begins the run. Whatever it returns, with f saying why, finish is due.
    status (*open)(void *run, recording *r, fault *f);

    // Carries out what is due of script and rig before the next step; *ended is true if
    // the run is complete instead.
    status (*prepare_step)(void *run, bool *ended, fault *f);

    // One step, recorded, to `until` [s] at the most if it can be cut there.
    status (*step)(void *run, double until, fault *f);

    // Carries out now an action that belongs to no script.
    status (*act)(void *run, const action *todo, fault *f);

    // Sums up what is known of the run, which continues afterwards. The caller saves and
    // restores the summary and recording.state.
    void (*sum_up)(void *run, status failed);

    // Sums the run up, `failed` being what ended it, and frees it.
    void (*finish)(void *run, status failed);

    // The present: its instant [s], whether that is the end, what the sensors are fixed
    // to, the row, and all angles [rad] followed by their velocities [rad/s], in place.
    double (*time)(const void *run);
    bool (*has_ended)(const void *run);
    sensed_motion (*sensed)(const void *run);
    sample (*row)(const void *run);
    const double *(*state)(const void *run, int *angle_count);

    // The whole state but for recording and rig as bytes; and back, after recording and
    // rig were restored.
    size_t (*saved_size)(const void *run);
    void (*save)(const void *run, void *bytes);
    void (*restore)(void *run, const void *bytes);
} run_model;

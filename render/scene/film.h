// Films of recorded runs: the arm in space with its traces in step beside it, or several arms side
// by side, slowed down round every impact.
#pragma once

#include <signal.h>

#include "render/scene/scene.h"

enum { FILM_RUNS = 4 }; // most runs in one film

typedef struct film_options {
    scene_options view;    // of the arm; its size is the film's to choose
    int width, height;     // [pixels], even numbers; 0: 1280 x 720
    int frames_per_second; // 0: 30
    double seconds;        // length of the film [s]; 0: 10
    int ghosts;            // earlier arms behind the present one, 20 ms apart
    double slow;           // impacts are slowed down by this, against the rest; 0: 8
    int threads;           // that paint; 0: as many as there are processors, two at most
    // called after each frame, or NULL
    void (*progress)(void *context, int done, int total);
    void *context;
    const volatile sig_atomic_t *stop; // not 0: give up; may be NULL
} film_options;

// A run of a film, with its trace.
typedef struct film_run {
    const scenario *scenario;
    const run_result *result;
    const char *name; // in the key of the traces; shown if there are several
} film_run;

// Writes a film of 1 to FILM_RUNS runs over the time that all of them have (see film_file_open for
// path), frame by frame in bounded memory; its bytes do not depend on the threads.
// STATUS_BAD_ARGUMENT for options out of range or a run without rows, STATUS_CANNOT_WRITE with the
// reason, STATUS_STOPPED where `stop` said so.
status film_write(const film_run *runs, int run_count, const film_options *options,
                  const char *path, fault *f);

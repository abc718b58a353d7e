// Films of a recorded run: the arm in space with its traces in step beside it, slowed down round
// the first impact.
#pragma once

#include <signal.h>

#include "render/scene/scene.h"

typedef struct film_options {
    scene_options view;    // of the arm; its size and samples are the film's to choose
    int width, height;     // [pixels], even numbers; 0: 1280 x 720
    int frames_per_second; // 0: 30
    double seconds;        // length of the film [s]; 0: 10
    int ghosts;            // earlier arms behind the present one, GHOST_TIME apart
    double slow;           // the first impact is slowed down by this, against the rest; 0: 8
    // called after each frame, or NULL
    void (*progress)(void *context, int done, int total);
    void *context;
    const volatile sig_atomic_t *stop; // not 0: give up; may be NULL
} film_options;

// When in the run each moment of a film is.
typedef struct film_clock {
    double start, end;         // of the run [s]
    double slow_from, slow_to; // where it is slowed down fully [s]
    double taper;              // the time over which that comes and goes [s]
    double slow;
    double seconds; // of the film
} film_clock;

// A clock of the run: `seconds` of film, and the time from shortly before the first contact until
// the force has risen `slow` times slower than the rest.
film_clock film_clock_of(const run_result *result, double seconds, double slow);

// The same for a run from `start` to `end` [s] and what happens at an instant of it [s]; the film's
// length is left open.
film_clock film_clock_round(double start, double end, double instant, double slow);

// How many times slower the run goes at an instant [s] than where it is not slowed down: between,
// half a cosine.
double film_clock_slowness(const film_clock *c, double time);

// The instant of the run [s] shown at a film's time [s], and how many seconds of the run pass in a
// second of film there.
double film_clock_time(const film_clock *c, double film_time, double *speed);

// Writes the film (see film_file_open for path), frame by frame in bounded memory.
// STATUS_BAD_ARGUMENT for options out of range, STATUS_CANNOT_WRITE with the reason.
status film_write(const scenario *s, const run_result *result, const film_options *options,
                  const char *path, fault *f);

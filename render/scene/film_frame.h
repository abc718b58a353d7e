// Frames of a film: the arms of one or more runs in space, each in its own view, with synchronous
// traces. What all frames share is computed once; every painting thread has its own painter.
#pragma once

#include <signal.h>

#include "render/page/page.h"
#include "render/scene/film_clock.h"
#include "render/scene/scene.h"

enum { FILM_RUNS = 4 }; // most runs in one film

typedef struct film_options {
    scene_options view;    // of the arm; its size is set by the film
    int width, height;     // [pixels], even numbers; 0: 1280 x 720
    int frames_per_second; // 0: 30
    double seconds;        // length of the film [s]; 0: 10
    int ghosts;            // number of earlier positions shown behind the present one, 20 ms apart
    double slow;           // factor of slow motion at impacts; 0: 8
    int threads;           // painting threads; 0: one per processor, at most two
    // called after each frame, or NULL
    void (*progress)(void *context, int done, int total);
    void *context;
    const volatile sig_atomic_t *stop; // not 0: give up; may be NULL
} film_options;

// A run of a film, with its trace.
typedef struct film_run {
    const scenario *scenario;
    const run_result *result;
    const char *name; // in the legend of the traces; shown if there are several
} film_run;

// A view's place on the frame [pixels].
typedef struct film_view {
    int x, y, width, height;
} film_view;

// Shared by all frames of a film; not changed while they are painted.
typedef struct film_plan {
    const film_run *runs;
    int run_count;
    film_options options; // complete, without defaults
    film_clock clock;
    film_view views[FILM_RUNS], strip; // areas of the arms and of the traces
    cairo_surface_t *traces;           // of the whole time, painted once
    figure_report *report;             // positions of their panels
    double trace_scale;                // pixels per point in them
} film_plan;

typedef struct film_painter film_painter;

// Prepares a film of runs with rows. The options must be complete and in range. Fails as
// figure_paint does. film_plan_finish must be called in either case.
status film_plan_init(film_plan *plan, const film_run *runs, int run_count,
                      const film_options *options, fault *f);
void film_plan_finish(film_plan *plan);

// A painter of a film's frames, to be used and destroyed by the thread that creates it. Fails as
// scene_create does.
status film_painter_create(film_painter **out, const film_plan *plan, fault *f);
void film_painter_destroy(film_painter *p);

// Name of the renderer, for the film's metadata.
const char *film_painter_name(const film_painter *p);

// Paints the frame at a film's time [s] onto a surface RGB24 of the film's size.
status film_painter_frame(film_painter *p, double film_time, cairo_surface_t *onto, fault *f);

// Paints a frame with every colour of the film: just after the first impact, with flash, arrow and
// all of the traces.
status film_painter_palette(film_painter *p, cairo_surface_t *onto, fault *f);

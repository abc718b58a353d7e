// Films of recorded runs: the arm in space with synchronous traces, or several arms side
// by side, in slow motion near every impact.
#pragma once

#include <signal.h>

#include "render/page/text.h"
#include "render/page/picture_file.h"
#include "render/scene/scene.h"
#include "src/run/run_result.h"

enum { FILM_IMPACTS = 64 }; // most impacts shown in slow motion

typedef struct film_clock {
    double start, end;            // of the run [s]
    double impacts[FILM_IMPACTS]; // instants of slow motion [s], ascending
    int impact_count;
    double before, after; // full slow motion from `before` until `after` each of them [s]
    double taper;         // duration of the transitions [s]
    double slow;          // factor of slow motion
    double seconds;       // of the film
} film_clock;

// A clock of runs that are shown together: `seconds` of film, and the time from shortly
// before every impact of any of them until the force has risen `slow` times slower than
// the rest. Impacts with less than a twentieth of the largest impulse are left out; in a
// run without impulses every beginning of contact is used.
film_clock film_clock_of(const run_result *const *results, int count, double seconds,
                         double slow);

// The same for a time from `start` to `end` [s] and a single event at an instant [s]; the
// length of the film is not set.
film_clock film_clock_round(double start, double end, double instant, double slow);

// The factor of slow motion at an instant [s], 1 outside; the transitions are half a
// cosine.
double film_clock_slowness(const film_clock *c, double time);

// The instant of the run [s] shown at a film's time [s], and how many seconds of the run
// pass in a second of film there.
double film_clock_time(const film_clock *c, double film_time, double *speed);

enum { FILM_RUNS = 4 }; // most runs in one film

typedef struct film_options {
    scene_options view;    // of the arm; its size is set by the film
    int width, height;     // [pixels], even numbers; 0: 1280 x 720
    int frames_per_second; // 0: 30
    double seconds;        // length of the film [s]; 0: 10
    int ghosts;  // number of earlier positions shown behind the present one, 20 ms apart
    double slow; // factor of slow motion at impacts; 0: 8
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

// What paints the frames of a film.
typedef struct film_painter {
    const film_run *runs;
    int run_count;
    film_options options; // complete, without defaults
    film_clock clock;
    pixel_box views[FILM_RUNS], strip;    // of the arms and of the traces, on the frame
    scene *scenes[FILM_RUNS];             // of the arms
    cairo_surface_t *pictures[FILM_RUNS]; // of the arms, painted anew for each frame
    cairo_surface_t *traces;              // of the whole time, painted once
    figure_report report;                 // positions of their panels
    double trace_scale;                   // pixels per point in them
    PangoContext *context;
} film_painter;

// A painter of a film of runs with rows, which outlive it. The options must be complete
// and in range. Fails as figure_paint and scene_create do.
status film_painter_create(film_painter **out, const film_run *runs, int run_count,
                           const film_options *options, fault *f);
void film_painter_destroy(film_painter *p); // may be NULL
G_DEFINE_AUTOPTR_CLEANUP_FUNC(film_painter, film_painter_destroy)

// Paints the frame at a film's time [s] onto a surface RGB24 of the film's size.
status film_painter_frame(film_painter *p, double film_time, cairo_surface_t *onto,
                          fault *f);

// Paints a frame with every colour of the film: just after the first impact, with flash,
// arrow and all of the traces.
status film_painter_palette(film_painter *p, cairo_surface_t *onto, fault *f);

// Writes a film of 1 to FILM_RUNS runs over the time that all of them have (see
// film_file_open for path), frame by frame in bounded memory. STATUS_BAD_ARGUMENT for
// a size out of range or a run without rows, STATUS_CANNOT_WRITE with the reason,
// STATUS_STOPPED if `stop` requested it.
status film_write(const film_run *runs, int run_count, const film_options *options,
                  const char *path, fault *f);

// --- films as files: made from frames with the ffmpeg program, or a folder of PNG
// frames: film_file.c

typedef struct film_file film_file;

// Checks in advance whether a film can be written: STATUS_BAD_ARGUMENT for an unknown
// extension, STATUS_CANNOT_WRITE if the path cannot be written, if the ffmpeg program is
// missing, or if a folder of frames is not empty.
status film_file_check(const char *path, fault *f);

// Opens a film: path ends in .mp4, .webm, .gif or .webp, or names a folder that is
// created for PNG frames; size and rate of the frames and `stop` are the options', which
// outlive it, as do the notes for the metadata.
status film_file_open(film_file **out, const char *path, const film_options *options,
                      const png_note *notes, int note_count, fault *f);

// True if the first frame is not shown but defines the colours of all others: it should
// contain every colour of the film.
bool film_file_wants_palette(const film_file *film);

// Appends a frame (RGB24). STATUS_CANNOT_WRITE with the encoder's message if it failed,
// STATUS_STOPPED if `stop` became true while it accepted nothing.
status film_file_add(film_file *film, cairo_surface_t *frame, fault *f);

// Completes the film and moves it to its path if the encoder reported no error and the
// file has the mark of its format. Otherwise fails and leaves no film (frames in a folder
// are kept). Frees it in either case.
status film_file_commit(film_file *film, fault *f);
void film_file_abandon(film_file *film);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(film_file, film_file_abandon)

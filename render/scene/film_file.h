// Films as files: made from frames with the ffmpeg program, or a folder of PNG frames.
#pragma once

#include <cairo.h>
#include <signal.h>
#include <stdbool.h>

#include "render/page/picture_file.h"

typedef struct film_facts {
    int width, height; // of each frame [pixels]
    int frames_per_second;
    const png_note *notes; // for the metadata
    int note_count;
    const volatile sig_atomic_t *stop; // not 0: stops waiting; may be NULL
} film_facts;

typedef struct film_file film_file;

// Checks in advance whether a film can be written: STATUS_BAD_ARGUMENT for an unknown extension,
// STATUS_CANNOT_WRITE if the path cannot be written, if the ffmpeg program is missing, or if a
// folder of frames is not empty.
status film_file_check(const char *path, fault *f);

// Opens a film: path ends in .mp4, .webm, .gif or .webp, or names a folder that is created for PNG
// frames.
status film_file_open(film_file **out, const char *path, const film_facts *facts, fault *f);

// True if the first frame is not shown but defines the colours of all others: it should contain
// every colour of the film.
bool film_file_wants_palette(const film_file *film);

// Appends a frame (RGB24). STATUS_CANNOT_WRITE with the encoder's message if it failed,
// STATUS_STOPPED if `stop` became true while it accepted nothing.
status film_file_add(film_file *film, cairo_surface_t *frame, fault *f);

// Completes the film and moves it to its path if the encoder reported no error and the file has the
// mark of its format. Otherwise fails and leaves no film (frames in a folder are kept). Frees it in
// either case.
status film_file_commit(film_file *film, fault *f);
void film_file_abandon(film_file *film);

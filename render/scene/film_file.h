// Where the frames of a film go: into a film by the ffmpeg program, or into a folder of PNG files.
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "render/scene/film_encoder.h"

typedef struct film_file film_file;

// Tells early whether a film could be written: STATUS_BAD_ARGUMENT for an extension that is not
// known, STATUS_CANNOT_WRITE if the path cannot be written, if the ffmpeg program is missing, or if
// a folder of frames is not empty.
status film_file_check(const char *path, fault *f);

// Opens a film: path ends in .mp4, .webm, .gif or .webp, or names a folder to be made for PNG
// frames.
status film_file_open(film_file **out, const char *path, const film_facts *facts, fault *f);

// True if the first frame added is not shown, but gives the colours of all others: it should show
// every colour of the film.
bool film_file_wants_palette(const film_file *film);

// Appends a frame (RGB24). STATUS_CANNOT_WRITE with the encoder's own words if it gave up,
// STATUS_STOPPED if `stop` became true while it took nothing.
status film_file_add(film_file *film, cairo_surface_t *frame, fault *f);

// Completes the film and puts it in its place, which needs an encoder that complained of nothing
// and a file that begins and ends as its kind does. Or gives up and leaves nothing of a film behind
// (frames in a folder stay). Frees it in either case.
status film_file_commit(film_file *film, fault *f);
void film_file_abandon(film_file *film);

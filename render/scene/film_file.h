// Makes a film from frames with the ffmpeg program.
#pragma once

#include <cairo.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "render/page/picture_file.h"

enum { FILM_MARKS = 2 }; // most marks of a kind of film

// A kind of film.
typedef struct film_format {
    const char *ending; // of its files' names
    const char *codec;  // ffmpeg's arguments for it
    bool palette;       // the first frame defines the colours of all others and is not shown
    // bytes of a complete file at these offsets from its beginning or (negative) from its end
    struct {
        long offset;
        const char *bytes; // NULL: end of the list
    } marks[FILM_MARKS];
} film_format;

// The format that a path's ending names, or NULL.
const film_format *film_format_of(const char *path);

typedef struct film_facts {
    int width, height; // of each frame [pixels]
    int frames_per_second;
    const png_note *notes; // for the metadata
    int note_count;
    const volatile sig_atomic_t *stop; // not 0: stops waiting; may be NULL
} film_facts;

typedef struct film_encoder {
    pid_t process; // 0: not running
    int pipe;      // to the process; -1 if closed
    FILE *words;   // its messages
    const volatile sig_atomic_t *stop;
} film_encoder;

// Whether the program is installed.
bool film_encoder_is_there(void);

// Starts it: raw frames (0xAARRGGBB without the alpha) become the file `target`.
// STATUS_CANNOT_WRITE if that fails. film_encoder_finish must be called in
// either case.
status film_encoder_start(film_encoder *e, const film_format *format, const film_facts *facts,
                          const char *target, fault *f);

// Sends bytes of a frame. STATUS_CANNOT_WRITE if the program accepts no more, STATUS_STOPPED if
// stop became true while it accepted nothing; no fault is set.
status film_encoder_send(film_encoder *e, const unsigned char *bytes, size_t length);

// Ends the frames, waits for the program and reads its first error message. True if it succeeded
// without any.
bool film_encoder_end(film_encoder *e, char *said, size_t size);

// Stops it at once, if it is running, and frees its storage.
void film_encoder_finish(film_encoder *e);

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

// Completes the film and moves it to its path if the encoder reported no error and the file begins
// and ends as its format requires. Otherwise fails and leaves no film (frames in a folder are
// kept). Frees it in either case.
status film_file_commit(film_file *film, fault *f);
void film_file_abandon(film_file *film);

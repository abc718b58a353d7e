// Makes a film from frames with the ffmpeg program.
#pragma once

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "render/page/png_file.h"

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
// STATUS_CANNOT_WRITE or STATUS_NO_MEMORY if that fails. film_encoder_finish must be called in
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

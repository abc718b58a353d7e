// Pictures as files: PNG, PDF or SVG of anything that cairo can draw. A file appears whole or not
// at all, and the same picture gives the same bytes.
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "src/base/fault.h"

typedef enum picture_format { FORMAT_NONE, FORMAT_PNG, FORMAT_PDF, FORMAT_SVG } picture_format;

typedef struct picture {
    double width, height;    // of the page [pt]
    double dpi;              // of a PNG; 0: 200
    const char *title;       // for the file's metadata, all plain and NULL for none
    const char *software;    // "impactlab 0.1.0"
    const char *parameters;  // what the picture was made with
    const char *command;     // that made it
    const char *alternative; // what it shows, for those who cannot see it
    bool transparent;        // it has no ground
    // draws it with the page's top left corner at the origin of cr, in points
    status (*paint)(cairo_t *cr, const void *what, fault *f);
    const void *what; // for paint
} picture;

// Strokes the path and forgets it, as cairo_stroke does. Where cairo gets no memory for the outline
// of a long line it leaves a piece of it out and keeps that to itself: picture_end_drawing knows.
void picture_stroke(cairo_t *cr);

// Whether this thread strokes a path, where cairo crashes if it gets no memory. For a handler of
// signals.
bool picture_is_stroking(void);

// Ends a drawing: destroys cr and returns `code`, what drawing came to, or STATUS_NO_MEMORY if
// cairo met an error and from then on drew nothing, or a line lacks a piece. An error of writing is
// left to whoever closes the stream.
status picture_end_drawing(cairo_t *cr, status code, fault *f);

// The format that a path's extension (.png, .pdf, .svg) or a bare word (png) names.
picture_format picture_format_of(const char *path);

// Tells early whether picture_write could write to path: STATUS_BAD_ARGUMENT for an extension it
// does not know, STATUS_CANNOT_WRITE for a folder that is not there.
status picture_check_path(const char *path, fault *f);

// Draws the picture into a file; the extension chooses the format. Returns what paint returns,
// STATUS_BAD_ARGUMENT for an unknown extension or a resolution out of range, STATUS_CANNOT_WRITE
// with path and reason.
status picture_write(const picture *p, const char *path, fault *f);

// The picture as the text of an SVG file, to be freed with g_free; NULL if it cannot be drawn.
char *picture_svg(const picture *p, fault *f);

// Draws pictures as the pages of one PDF, whose metadata are the first one's. Returns what
// picture_write does.
status picture_write_pages(const picture *pages, int count, const char *path, fault *f);

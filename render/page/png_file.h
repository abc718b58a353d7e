// PNG files with resolution and metadata.
#pragma once

#include <cairo.h>
#include <stdio.h>

#include "src/base/fault.h"

// A text of a PNG: keyword as in the PNG specification ("Title"), text in UTF-8 (NULL: left out).
typedef struct png_note {
    const char *keyword;
    const char *text;
} png_note;

// Writes an image surface (RGB24, or ARGB32 for a PNG with transparency) with `dpi` dots per inch
// in a pHYs chunk and the notes in iTXt chunks. The same picture gives the same bytes. Errors of
// the stream stay in the stream (ferror); others are returned.
status png_file_write(FILE *stream, cairo_surface_t *surface, double dpi, const png_note *notes,
                      int note_count, fault *f);

// Pictures as files: PNG, PDF or SVG of anything that cairo can draw. A file is written
// completely or not at all, and the same picture gives the same bytes.
#pragma once

#include <cairo.h>
#include <glib.h>
#include <stdbool.h>
#include <stdio.h>

#include "render/page/picture_path.h"

G_DEFINE_AUTOPTR_CLEANUP_FUNC(cairo_surface_t, cairo_surface_destroy)

typedef struct picture {
    const char
        *title; // this and other texts: for the file's metadata, plain, NULL for none
    double width, height;    // of the page [pt]
    double dpi;              // of a PNG; 0: 200
    const char *software;    // "impactlab 0.1.0"
    const char *parameters;  // parameters with which the picture was made
    const char *command;     // that made it
    const char *alternative; // alternative text
    bool transparent;        // it has no background
    // draws it with the page's upper left corner at the origin of cr, in points
    status (*paint)(cairo_t *cr, const void *what, fault *f);
    const void *what; // for paint
} picture;

// The program and its version, as files of pictures name what made them.
const char *picture_software(void);

// Strokes a straight line.
void picture_line(cairo_t *cr, double x0, double y0, double x1, double y1);

// Ends a drawing: destroys cr and returns `code`, the status of drawing, or
// STATUS_NO_MEMORY if cairo met an error, after which it draws nothing. Errors of writing
// are found by the caller when closing the stream.
status picture_end_drawing(cairo_t *cr, status code, fault *f);

// Draws the picture into a file; the extension chooses the format. Returns the status of
// paint, STATUS_BAD_ARGUMENT for an unknown extension or a resolution out of range,
// STATUS_CANNOT_WRITE with path and reason.
status picture_write(const picture *p, const char *path, fault *f);

// Draws the picture as a PNG into a stream, which keeps its own errors.
status picture_write_png(const picture *p, FILE *stream, fault *f);

// The picture as the text of an SVG file, to be freed with g_free; NULL if it cannot be
// drawn.
char *picture_svg(const picture *p, fault *f);

// Draws pictures as the pages of one PDF with the metadata of the first. Returns the same
// as picture_write.
status picture_write_pages(const picture *pages, int count, const char *path, fault *f);

// --- PNG files with resolution and metadata

// A text of a PNG: keyword as in the PNG specification ("Title"), text in UTF-8 (NULL:
// left out).
typedef struct png_note {
    const char *keyword;
    const char *text;
} png_note;

// Writes an image surface (RGB24, or ARGB32 for a PNG with transparency) with `dpi` dots
// per inch in a pHYs chunk and the notes in iTXt chunks. The same picture gives the same
// bytes. Errors of the stream stay in the stream (ferror); others are returned.
status png_file_write(FILE *stream, cairo_surface_t *surface, double dpi,
                      const png_note *notes, int note_count, fault *f);

// --- SVG text: ids that follow from the picture alone, and fewer bytes: svg.c

// cairo makes ids from counters of the whole process ("surface96"), so that the second
// figure of a program differs from the first. Returns the SVG with every id, and every
// reference to it, replaced by a prefix and its place in the order of the ids. Free the
// result with g_free.
char *svg_renumber_ids(const char *svg, const char *prefix);

// The same with a prefix from the SVG's content, so that different SVGs share no id and
// can stand in one page, where an id holds for the whole page; the same picture has the
// same bytes.
char *svg_own_ids(const char *svg);

// The SVG as an element of a page with others, in fewer bytes: without the XML
// declaration and metadata; with a prefix before every id; lengths to a hundredth of a
// point (those of lines to a tenth), colours as #rrggbb, without default attributes,
// successive lines of one style in one path. Outlines of letters (symbols) that an
// earlier SVG of the page contains are omitted and referred to there: `known` has outline
// to id, both owned by it; new ones are added. Texts between tags stay as they are. The
// report of the whole thesis has 1.9 MB by it instead of 6 (tests/test_figures.c). Free
// the result with g_free.
char *svg_for_page(const char *svg, const char *prefix, GHashTable *known);

// A picture for a page, with the numbers it shows and its origin.
#pragma once

#include <glib.h>

#include "render/page/picture_file.h"
#include "render/page/table_page.h"
#include "render/plot/figure_description.h"

// Options that apply to all pictures.
typedef struct figure_options {
    page_look look;
    const char *overlay; // data over recorded signals (overlay_read), NULL for none
    const char
        *signals;    // recorded signals to show instead of the usual ones, NULL for those
    double from, to; // ends of the horizontal axis; from >= to: automatic
    figure_interval zoom; // stretch of the first panel in an inset; empty: none
    const char *latex;    // file for the figure environment, NULL for none
    const char
        *command; // command that makes the picture, for its metadata; NULL if not known
} figure_options;

typedef struct artwork {
    const char *title;       // plain
    const char *caption;     // markup, NULL for none
    const char *parameters;  // plain, for the file's metadata
    double width, height;    // of the page [pt]
    char *alternative;       // plain: alternative text; owned
    const table_page *table; // of a table, else NULL
    const figure *plotted;   // of a plotted figure, else NULL
    // of anything else: what the functions below do of its owner
    status (*paint)(cairo_t *cr, const void *owner, figure_report *report, fault *f);
    void (*write_csv)(const void *owner, csv_writer *csv);
    figure_report *seen;          // filled when its picture is painted; NULL: nobody asks
    void *owner;                  // holds all of it
    void (*release)(void *owner); // NULL: nothing to free
} artwork;

// Draws it with the page's top left corner at the origin of cr, in points; *report (may
// be NULL) is filled. Writes the numbers that are drawn.
status artwork_paint(const artwork *a, cairo_t *cr, figure_report *report, fault *f);
status artwork_write_csv(const artwork *a, const char *path, fault *f);

// The picture of an artwork, valid as long as the artwork.
picture artwork_picture(const artwork *a, const figure_options *options);

static inline void artwork_finish(artwork *a)
{
    if (a->release != NULL) {
        a->release(a->owner);
    }
    g_free(a->alternative);
    *a = (artwork){0};
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(artwork, artwork_finish)

// An artwork of a plotted figure, which is borrowed; and of one that it owns from now on.
artwork artwork_of_figure(const figure *fig);
artwork artwork_of_owned(owned_figure *o);

// A table as an artwork, which owns it.
artwork artwork_of_table(table_page *t);

// Creates a folder unless it exists. STATUS_CANNOT_WRITE with the reason.
status make_folder(const char *folder, fault *f);

// --- publications: the file, a file with its caption if the picture has none, and LaTeX
// for both

// Writes a plotted figure according to the options: the picture at path, with a bare look
// a .txt with its caption, the figure environment at o->latex, and with `with_csv` its
// numbers. Returns the status of figure_write; STATUS_BAD_ARGUMENT also if the options
// name recorded signals, because the figure has none.
status figure_publish(const figure *fig, const figure_options *o, const char *path,
                      bool with_csv, fault *f);

// The same for any artwork that was opened with o.
status artwork_publish(const artwork *a, const figure_options *o, const char *path,
                       bool with_csv, fault *f);

// Writes its numbers beside the picture at `path`. Nobody named this CSV: where there is
// one of other numbers than a figure's, measured ones maybe, it is kept;
// STATUS_CANNOT_WRITE.
status artwork_publish_csv(const artwork *a, const char *path, fault *f);

// Sets the ends of a figure's horizontal axis to --from and --to.
void figure_take_range(figure *fig, const figure_options *o);

// Writes the PDF beside an SVG at the path (picture_for_latex), and makes the text of a
// figure environment for o->latex: the path of the picture relative to the folder of that
// file, its width, alternative text, caption and the label fig:NAME with the name of the
// picture. Free *environment with g_free.
status artwork_publish_latex(const artwork *a, const figure_options *o, const char *path,
                             char **environment, fault *f);

// Anything the lab can put on a page: a picture, the numbers it shows, and what it was made from.
#pragma once

#include "render/page/picture_file.h"
#include "render/plot/plot.h"
#include "render/page/table_page.h"

// How pictures are to look.
typedef struct figure_options {
    figure_theme theme;
    double width_mm;     // of the page; 0: as designed
    double dpi;          // of a PNG; 0: 200
    const char *overlay; // CSV to draw over recorded signals (render/plot/overlay.h), NULL for none
} figure_options;

typedef struct artwork {
    double width, height;           // of the page [pt]
    const char *title, *parameters; // plain, for the file's metadata
    const table_page *table;        // of a table, else NULL
    void *what;                     // owned; for the functions below
    // draws it with the page's top left corner at the origin of cr, in points; *report (may be
    // NULL) is filled
    status (*paint)(cairo_t *cr, const void *what, figure_report *report, fault *f);
    // writes the numbers that are drawn
    status (*write_csv)(const void *what, const char *path, fault *f);
    void (*release)(void *what);
} artwork;

// The picture of an artwork, good as long as it lives.
picture artwork_picture(const artwork *a, const figure_options *options);

void artwork_finish(artwork *a);

// Ends and complains about a format that is none of png, pdf and svg.
status artwork_check_formats(char *const *formats, fault *f);

// Writes FOLDER/FILE.png ... for every format and FOLDER/FILE.csv. The folder is created if it is
// not there. STATUS_CANNOT_WRITE with path and reason.
status artwork_write(const artwork *a, const figure_options *options, const char *folder,
                     const char *file, char *const *formats, fault *f);

// An artwork of a plotted figure. `owner` holds what the figure borrows and the figure itself;
// release frees it.
artwork artwork_of_figure(const figure *fig, void *owner, void (*release)(void *owner));

// Creates a folder unless it is there. STATUS_CANNOT_WRITE with the reason.
status make_folder(const char *folder, fault *f);

// Figures: panels of curves above one another that share the horizontal axis.
//
// A figure is a description in plain data that borrows everything it points to; nothing here
// changes or frees it. figure_paint draws it, figure_write (render/plot/figure_file.h) makes files.
// Unless said otherwise a text is Pango markup and NULL stands for none.
#pragma once

#include <cairo.h>
#include <stdbool.h>
#include <stddef.h>

#include "src/quantities/signals.h"
#include "src/base/fault.h"

enum {
    FIGURE_PANELS = 8,  // most panels
    PANEL_SERIES = 16,  // most series of a panel
    FIGURE_TEXTS = 512, // texts a report remembers
};

typedef enum figure_theme {
    THEME_COLOUR, // Okabe and Ito's colours on white
    THEME_MONO,   // black and greys on white
    THEME_DARK    // Okabe and Ito's colours on near black
} figure_theme;

typedef enum marker_kind { MARKER_NONE, MARKER_CIRCLE, MARKER_SQUARE, MARKER_TRIANGLE } marker_kind;

typedef enum legend_kind {
    LEGEND_AUTO, // of two or more curves, inside the panel where no data are, else in a row above
    LEGEND_ENDS, // each label at the right end of its curve
    LEGEND_NONE
} legend_kind;

// A curve. A point that is not finite leaves a gap.
typedef struct figure_series {
    const char *name;    // plain, for the CSV, "force"
    const char *label;   // for the legend
    const double *x, *y; // count values each
    size_t count;
    size_t stride;      // bytes from one value to the next, in x and y alike; 0: sizeof(double)
    int colour;         // slot in the palette, 0-7
    line_style style;   // changed where an earlier series of the panel has the same
    marker_kind marker; // at every point
    bool secondary;     // thinner and dashed, for a second run of the same quantity
    bool no_line;       // markers only
} figure_series;

// A horizontal line across a panel.
typedef struct figure_level {
    double y;
    const char *label; // at its right end
} figure_level;

// A vertical hairline across all panels.
typedef struct figure_mark {
    double x;
    const char *label;
} figure_mark;

// A shaded stretch across all panels.
typedef struct figure_interval {
    double from, to;
} figure_interval;

// An impulse: something that has no place on the panel's own axis. It is drawn as an arrow in a
// strip above the panel.
typedef struct figure_impulse {
    double x, size;
} figure_impulse;

typedef struct figure_panel {
    const char *name;  // plain, for the CSV, "force"
    const char *label; // of the vertical axis, without its unit
    const char *unit;  // plain, as in the signal table: "rad/s2"; "" or NULL for a pure number
    const figure_series *series;
    int series_count;
    const figure_level *levels;
    int level_count;
    const figure_impulse *impulses;
    int impulse_count;
    const char *impulse_label; // of the strip, without its unit
    const char *impulse_unit;
    double weight;             // share of the height, 0 counts as 1
    double y_low, y_high;      // ends of the vertical axis; y_low >= y_high: from the data
    bool with_zero;            // an axis from the data includes 0
    double zoom_from, zoom_to; // range of x shown once more in an inset; from >= to: no inset
    legend_kind legend;
} figure_panel;

typedef struct figure {
    const char *title;   // plain
    const char *caption; // small, at the bottom
    const char *x_name;  // plain, for the CSV, "time"
    const char *x_label; // without its unit
    const char *x_unit;
    double x_low, x_high; // ends of the horizontal axis; x_low >= x_high: from the data
    const figure_panel *panels;
    int panel_count;
    const figure_mark *marks;
    int mark_count;
    const figure_interval *intervals;
    int interval_count;
    double width, height; // of the page [mm]; 0: 170 wide, as high as the panels want
    double dpi;           // of a PNG; 0: 200
    figure_theme theme;
    const char *software;   // plain, for the file's metadata, "impactlab 0.1.0"
    const char *parameters; // plain, for the file's metadata
} figure;

// A rectangle on the page [pt], y downwards.
typedef struct figure_rect {
    double x, y, width, height;
} figure_rect;

typedef struct figure_text {
    figure_rect place; // upright, also round a rotated text
    char text[64];     // its beginning, without markup
} figure_text;

// What was drawn where.
typedef struct figure_report {
    figure_rect page;
    figure_rect panels[FIGURE_PANELS];  // inside the axes
    figure_rect legends[FIGURE_PANELS]; // width 0: none
    figure_rect insets[FIGURE_PANELS];  // with their labels; width 0: none
    int panel_count;
    figure_text texts[FIGURE_TEXTS];
    int text_count;
} figure_report;

// Page size [pt] of a figure.
void figure_size(const figure *fig, double *width, double *height);

// Draws the figure with the page's top left corner at the origin of cr, in points. *report (may be
// NULL) is filled. STATUS_BAD_ARGUMENT for a page that is too small or a description that makes no
// sense, STATUS_CANNOT_READ if the font is missing.
status figure_paint(cairo_t *cr, const figure *fig, figure_report *report, fault *f);

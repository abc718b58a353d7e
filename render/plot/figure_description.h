// Figures: panels of axes with layers of data.
//
// A figure is a description in plain data that borrows everything it points to; it is not
// changed or freed here. figure_paint draws it, figure_write writes files. Panels are
// arranged in rows of `columns`; all share the horizontal axis. Traces, studies, sweeps
// and maps are all described in this way, so that their axes, ticks, legends and colours
// have the same style. Unless stated otherwise a text is Pango markup, and NULL means
// none.
#pragma once

#include <cairo.h>
#include <glib.h>
#include <string.h>

#include "render/page/page.h"
#include "src/base/csv.h"
#include "src/base/fault.h"
#include "src/tables/signals.h"

typedef enum scale_kind { SCALE_LINEAR, SCALE_LOGARITHMIC } scale_kind;

enum { PANEL_SERIES = 36 }; // most series of a panel

typedef enum marker_kind {
    MARKER_NONE,
    MARKER_CIRCLE,
    MARKER_SQUARE,
    MARKER_TRIANGLE,
    MARKER_DIAMOND,
    MARKER_CROSS
} marker_kind;

// A tick given explicitly.
typedef struct figure_tick {
    double value;
    const char *label;
} figure_tick;

// An axis. A value that a logarithmic axis cannot show, zero or below, counts as missing.
typedef struct figure_axis {
    const char *name;  // plain, for the CSV, "force"
    const char *label; // without its unit
    const char
        *unit; // plain, as in the signal table: "rad/s2"; "" or NULL for a pure number
    const char *symbol; // markup, replaces the label if that does not fit; NULL: none
    scale_kind scale;
    double low, high;         // its ends; low >= high: from the data
    double room;              // share of the data's range kept free at both ends
    bool with_zero;           // an axis from the data includes 0
    const figure_tick *ticks; // NULL: round values
    int tick_count;
} figure_axis;

// A layer of points, joined by a line or not. A point that is not finite leaves a gap.
typedef struct figure_series {
    const char *name;    // plain, for the CSV, "force"
    const char *label;   // for the legend
    const double *x, *y; // count values each
    size_t count;
    const char *symbol; // for the legend of a narrow page; NULL: the label
    const double
        *shade; // values on the panel's colour scale for the markers; NULL: in `colour`
    size_t
        stride; // bytes from one value to the next, in x, y and shade; 0: sizeof(double)
    int colour; // slot in the palette, 0-7
    line_style style; // changed if an earlier series of the panel has the same
    int run; // from 1 on: of one of several runs, whose look it has (run_style_of); or
             // RUN_BEHIND
    marker_kind marker; // at every point
    double radius;      // of markers [pt]; 0: the style's
    bool secondary;     // thinner and dashed, for a second run of the same quantity
    bool no_line;       // markers only
    bool own_style;     // keeps its style whatever other series have
    bool rim;           // with a rim of the page's colour, so that it is visible on a map
} figure_series;

// A layer of coloured cells over a grid of points: z[column * rows + row].
typedef struct figure_map {
    const double *x, *y; // ascending: of the columns and of the rows, in the axes' values
    size_t columns, rows;
    const double *z; // a cell whose value is not finite is hatched
    bool contours;   // lines at the ticks of the colour scale, smooth within each cell
    bool zero;       // a strong one where the values change their sign
} figure_map;

// A colour scale from low (dark) to high (bright).
typedef struct figure_colours {
    figure_axis axis;
    bool reversed; // bright for low values
    bool bar;      // shown at the right of the panel
} figure_colours;

// A horizontal line across a panel.
typedef struct figure_level {
    double y;
    const char *label; // at its right end
} figure_level;

// A vertical hairline across all panels.
typedef struct figure_mark {
    double x;
    const char *label;
    bool onwards; // the label names what begins there: it is not put on the line's other
                  // side
    bool pointed; // the label stands at the point (x, y) of the first panel, which has a
                  // dot
    double y;
} figure_mark;

// A horizontal measure from one x to another in the first panel, with its label above.
typedef struct figure_measure {
    double from, to, y;
    const char *label;
} figure_measure;

// A shaded stretch across all panels.
typedef struct figure_interval {
    double from, to;
} figure_interval;

// A text at a point of a panel.
typedef struct figure_note {
    double x, y;
    const char *text;
    bool optional; // left out where nothing near its point is free
} figure_note;

// An impulse, which cannot be shown on the panel's own axis. It is drawn as an arrow in a
// strip above the panel.
typedef struct figure_impulse {
    double x, size;
    int run;        // from 1 on: of one of several runs, whose colour it has
    const char *of; // its name, plain, for the CSV
} figure_impulse;

typedef struct figure_panel {
    const char *heading; // above it
    const char *remark;  // in its middle: reason for an empty panel
    figure_axis y;
    const figure_map *map; // below all other layers
    const figure_colours *colours;
    const figure_series *series;
    int series_count;
    const figure_level *levels;
    int level_count;
    const figure_note *notes;
    int note_count;
    const figure_impulse *impulses;
    int impulse_count;
    const char *impulse_label; // of the strip, without its unit
    const char *impulse_unit;
    double weight; // share of the height, 0 counts as 1
    double zoom_from,
        zoom_to;     // range of x shown once more in an inset; from >= to: no inset
    bool zoom_asked; // an inset that finds no place fails; else it is left out
    // without the legend that two or more curves have: inside the panel where there are
    // no data, otherwise in a row above
    bool keyless;
    // its legend stands in a row above it, at its left, with one entry, too
    bool key_above;
} figure_panel;

// What stands across the page between its title and its panels, painted by who knows it.
typedef struct figure_scene {
    double height; // [pt]
    // Paints it into so many points from the origin on.
    void (*paint)(cairo_t *cr, const void *of, double width, double height,
                  figure_theme theme);
    const void *of;
} figure_scene;

typedef struct figure {
    const char *title;         // plain
    const char *caption;       // small, at the bottom
    const figure_scene *scene; // NULL: none
    figure_axis x;
    const figure_panel *panels;
    int panel_count;
    int columns;        // panels in a row; 0 counts as 1
    bool common_legend; // one legend for all panels stands above them: the first one's,
    const figure_panel *key; // or that of these series, which are not drawn themselves
    const figure_mark *marks;
    int mark_count;
    bool marks_above; // their labels stand above the panels even where they would fit
                      // inside
    const figure_measure *measure;
    const figure_interval *intervals;
    int interval_count;
    double width, height; // of the page [mm]; 0: 170 wide, as high as the panels need
    double dpi;           // of a PNG; 0: 200
    figure_theme theme;
    const char *font; // family; NULL: the default
    double letters;   // size of labels [pt]; 0: 8
    bool bare;        // without title and caption
    bool transparent; // without a background
    bool equal_axes;  // a unit is as long on the one axis as on the other; both linear
    double zoom_from, zoom_to; // the same of the first panel, asked for
    bool shared_y;      // all panels have one vertical axis, labelled in the first column
    bool common_scales; // panels of one quantity have one vertical range
    const char *parameters; // plain, for the file's metadata
} figure;

// A figure with all that it borrows: panels, series, texts and numbers made for it.
typedef struct owned_figure {
    figure figure;
    figure_panel panels[FIGURE_PANELS];
    figure_series series[FIGURE_PANELS][PANEL_SERIES]; // of each panel
    GArray *kept;                                      // whatever ends with it
} owned_figure;

// A figure of empty panels with a plain title printed as by text_printf; to be destroyed,
// NULL is accepted.
owned_figure *owned_figure_create(int panels, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void owned_figure_destroy(void *owned);

// Adds a series to a panel, and returns it.
figure_series *owned_figure_add(owned_figure *o, int panel, figure_series s);

// Gives something to the figure, which ends it by `end`, and returns it; a block from
// g_malloc; room for numbers; and a text as text_printf makes it.
void *owned_figure_own(owned_figure *o, void *thing, GDestroyNotify end);
void *owned_figure_keep(owned_figure *o, void *block);
double *owned_figure_numbers(owned_figure *o, size_t count);
const char *owned_figure_printf(owned_figure *o, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// A copy of what an initialiser says, kept by the figure: OWNED(o, figure_level, angle,
// "wall").
#define OWNED(o, type, ...)                                                              \
    ((type *)memcpy(owned_figure_keep(o, g_new(type, 1)), &(type){__VA_ARGS__},          \
                    sizeof(type)))

// Applies the given look to a figure; fields that are zero have no effect.
void figure_take_look(figure *fig, const page_look *look);

// Page size [pt] of a figure.
void figure_size(const figure *fig, double *width, double *height);

// Draws the figure with the page's upper left corner at the origin of cr, in points.
// *report (may be NULL) is filled. STATUS_BAD_ARGUMENT for a page that is too small or an
// invalid description, such as a logarithmic axis without a value above zero,
// STATUS_CANNOT_READ if the font is missing; errors of cairo stay in cr.
status figure_paint(cairo_t *cr, const figure *fig, figure_report *report, fault *f)
    __attribute__((warn_unused_result));

// --- files

// Draws the figure into a file as picture_write does. Title and parameters go into the
// file's metadata.
status figure_write(const figure *fig, const char *path, fault *f);

// Writes what the figure shows as CSV in long form: the panel with its unit (its heading
// where all panels show one quantity), the series, and two columns headed by the axes'
// names and units ("time[s]", "force[N]"; "value" where the panels show different
// quantities, whose units stand beside the panels' names). Every point of every curve (y
// empty where the curve has a gap), cells of maps as the series "map", impulses as the
// series impulse[unit], then marks and shaded intervals with an empty y. Where there is a
// colour scale its value stands in a last column.
void figure_write_csv(const figure *fig, csv_writer *csv);

// Inside the figure library: where everything on a page goes.
#pragma once

#include "render/plot/curve.h"
#include "render/page/palette.h"
#include "render/plot/plot.h"
#include "render/page/text.h"
#include "render/plot/ticks.h"

enum { MARKS_LABELLED = 64, MARK_ROWS = 4 };

// Sizes of letters [pt].
#define TITLE_SIZE 9.0
#define LABEL_SIZE 8.0
#define TICK_SIZE  7.0
#define SMALL_SIZE 6.5

// Lengths [pt].
#define PAGE_MARGIN   6.0
#define TICK_LENGTH   3.0
#define MINOR_LENGTH  1.7
#define TICK_SPACE    2.0  // between a tick and its label
#define LABEL_SPACE   4.0  // between tick labels and the axis' label
#define PANEL_SPACE   8.0  // between panels
#define MARK_ROW      9.0  // height of a row of event labels
#define STRIP_HEIGHT  20.0 // of the strip for impulses
#define STRIP_SPACE   5.0  // between it and its panel
#define SWATCH        18.0 // length of a line in a legend
#define SWATCH_SPACE  4.0
#define LEGEND_MARGIN 5.0

typedef struct panel_layout {
    const figure_panel *panel;
    plane plane;
    ticks y_ticks;
    double strip_top;   // of the strip for impulses, if there are any
    bool legend_row;    // the legend stands above the panel
    bool legend_column; // it does, with its entries one above the other
    bool legend_inside; // it stands within the panel
    figure_rect legend; // width 0: none
    figure_rect inset;  // with its labels; width 0: none
    plane inset_plane;
    ticks inset_x_ticks, inset_y_ticks;
    double end_label_y[PANEL_SERIES]; // top of the labels at the curves' ends
} panel_layout;

typedef struct drawing {
    cairo_t *cr;
    PangoContext *context;
    const figure *fig;
    const palette *colours;
    figure_report *report;
    figure_rect page;
    double left, right; // of all panels
    double title_y, caption_y, x_label_y;
    double marks_bottom; // of the lowest row of event labels
    ticks x_ticks;
    double x_low, x_high;
    int mark_row[MARKS_LABELLED]; // counted upwards; -1: no label
    double mark_text_x[MARKS_LABELLED];
    panel_layout panels[FIGURE_PANELS];
} drawing;

// Fills everything from d->x_ticks on, and the vertical places. STATUS_BAD_ARGUMENT if the page is
// too small.
status layout_figure(drawing *d, fault *f);

// A label with its unit and a factor of 10^exponent, as markup. Give it to g_free.
char *axis_label(const char *label, const char *unit, int exponent);

// The text of a level, a legend entry, a mark ... in the figure's sizes.
text_block figure_text_of(const char *markup, double size);

// Number of series of the panel that have a label.
int labelled_series(const figure_panel *panel);

// True if the panel's legend stands at the ends of its curves.
bool has_end_labels(const figure_panel *panel);

// Whether a level's label stands above its line, or below because there is no room.
bool level_label_above(const panel_layout *l, int index);

// y of a series' last finite point inside the horizontal axis; false if there is none.
bool series_end(const drawing *d, const figure_series *s, double *y);

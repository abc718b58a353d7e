// Internal to the figure library: the layout of a figure, and the strokes used by all
// layers.
#pragma once

#include "render/page/page.h"
#include "render/page/text.h"
#include "render/plot/axis.h"
#include "render/plot/figure_description.h"

// --- free places in a panel, by a grid of cells with the ink in each: placement.c

enum { PLACEMENT_COLUMNS = 160, PLACEMENT_ROWS = 96 };

// The cost of covering a cell.
enum { INK_FAINT = 1, INK_CURVE = 1000 };

typedef struct placement {
    figure_rect box; // the area divided into cells [pt]
    // ink[r + 1][c + 1] belongs to cell (r, c)
    double ink[PLACEMENT_ROWS + 1][PLACEMENT_COLUMNS + 1];
} placement;

// Adds the ink of a line, or of a filled rectangle.
void placement_line(placement *g, double x0, double y0, double x1, double y1, int weight);
void placement_block(placement *g, figure_rect r, int weight);

// The ink under a rectangle.
double placement_ink(const placement *g, figure_rect r);

// --- the layout

enum { MARKS_LABELLED = 64, MARK_ROWS = 4, LEVELS_LABELLED = 8, NOTES_PLACED = 24 };

// Lengths [pt].
#define POINTS_PER_MM (72 / 25.4)
#define DEFAULT_WIDTH 170.0                 // of a page [mm]
#define NARROW_PAGE   (100 * POINTS_PER_MM) // below it legends have only symbols
#define PAGE_MARGIN   6.0
#define TICK_LENGTH   3.0
#define MINOR_LENGTH  1.7
#define TICK_SPACE    2.0  // between a tick and its label
#define LABEL_SPACE   4.0  // between tick labels and the axis' label
#define LABEL_GAP     3.0  // least distance of labels of ticks
#define PANEL_SPACE   8.0  // between panels
#define HEADING_ROW   11.0 // height of a panel's heading
#define LEGEND_ROW    11.0 // height of a legend above its panel
#define MARK_ROW      9.0  // height of a row of event labels
#define STRIP_HEIGHT  20.0 // of the strip for impulses
#define STRIP_SPACE   5.0  // between it and its panel
#define SWATCH        18.0 // length of a line in a legend
#define SWATCH_SPACE  4.0
#define LEGEND_MARGIN 5.0

// Sizes of letters where labels have 8 pt [pt].
#define TITLE_LETTERS 9.0
#define TICK_LETTERS  7.0
#define SMALL_LETTERS 6.5

// Line widths [pt].
#define CURVE_WIDTH     0.95
#define SECONDARY_WIDTH 0.65
#define AXIS_WIDTH      0.55
#define GRID_WIDTH      0.4
#define MARK_WIDTH      0.45

// The look of a figure, derived once from its description.
typedef struct plot_style {
    figure_theme theme;
    const palette *colours;
    const char *font;                 // family
    double title, label, tick, small; // sizes of letters [pt]
} plot_style;

typedef struct panel_layout {
    const figure_panel *panel;
    int row, column;
    plane plane;
    axis y;
    axis colours;                             // of the colour scale, if the panel has one
    figure_rect level_place[LEVELS_LABELLED]; // of the labels of levels; width 0: none
    figure_rect note_place[NOTES_PLACED];     // of the texts of notes; width 0: none
    double strip_top;   // of the strip for impulses, if there are any
    bool legend_row;    // the legend stands above the panel
    bool legend_column; // it does, with its entries one above the other
    bool legend_inside; // it stands within the panel
    figure_rect legend; // width 0: none
    figure_rect inset;  // with its labels; width 0: none
    plane inset_plane;
    axis inset_x, inset_y;
    bool busy[PANEL_SERIES]; // lines that turn too often for dashes
} panel_layout;

typedef struct column_layout {
    double edge;        // left end of everything
    double left, right; // of its panels
} column_layout;

typedef struct drawing {
    cairo_t *cr;
    PangoContext *context;
    const figure *fig;
    plot_style style;
    figure_report *report;
    figure_rect page;
    int rows, columns; // of panels
    axis x;
    double left, right; // of all panels
    column_layout column[FIGURE_PANELS];
    double title_y, scene_y, legend_y, caption_y, x_label_y;
    double marks_bottom;            // of the lowest row of event labels
    int mark_row[MARKS_LABELLED];   // counted upwards; -1: no label
    bool marks_inside;              // labels of marks are inside the first panel
    bool mark_away[MARKS_LABELLED]; // there is no room for its label at its point
    figure_rect point_label[MARKS_LABELLED]; // of a label at its point; width 0: none
    double mark_text_x[MARKS_LABELLED];      // in the first column
    double mark_text_y[MARKS_LABELLED];      // inside the panel
    panel_layout panels[FIGURE_PANELS];
} drawing;

// Title and caption as wide as the panels, on a narrow page as the page; *left is their
// left end. The title's markup is freed by the caller. Without markup there is none.
text_block frame_title(const drawing *d, double *left);
text_block frame_caption(const drawing *d, double *left);

// The width of the page [mm].
double figure_width(const figure *fig);

// The number of columns of panels that fit the page.
int figure_columns(const figure *fig);

// Computes the layout. STATUS_BAD_ARGUMENT if the page is too small or an axis has no
// values.
status layout_figure(drawing *d, fault *f);

// A panel's share of the height, where it gives none 1.
double panel_weight(const figure_panel *panel);

// Whether the panel's vertical axis has labels of its own, not only those of the first
// column.
bool has_y_labels(const drawing *d, const panel_layout *l);

// --- text: drawing.c

// A text in the figure's font.
text_block figure_text_of(const drawing *d, const char *markup, double size);

double width_of(const drawing *d, const char *markup, double size);
double height_of(const drawing *d, text_block t);

void draw_text(drawing *d, text_block t, double x, double y, anchor at, colour c);
void draw_markup(drawing *d, const char *markup, double size, double x, double y,
                 anchor at);
// Draws t vertically, upwards; (x, y) is the middle of its upper edge, which is on the
// left.
void draw_rotated(drawing *d, text_block t, double x, double y, colour c);

// --- strokes: drawing.c

void set_plain_line(cairo_t *cr, colour c, double width);
void clip_to(cairo_t *cr, const figure_rect *box);
void fill_box(cairo_t *cr, const figure_rect *box, colour c);
// Whether two rectangles lie over each other, or less than `space` apart sideways.
bool rects_meet(const figure_rect *a, const figure_rect *b, double space);

// --- axes: drawing.c

double widest_tick(const drawing *d, const axis *a, double size);
// The axis' title as it fits along an axis of the given length: with the label, or with
// its symbol alone where the label would need two lines. Free it with g_free.
char *fitting_title(const drawing *d, const axis *a, double length);
// Height of that title, wrapped beside the axis; 0 without a title.
double axis_title_height(const drawing *d, const axis *a, double length);
// The length that the title of a panel's vertical axis may have [pt].
double y_title_room(const panel_layout *l);
void draw_grid(const drawing *d, const plane *p, const axis *x, const axis *y);
// Axis lines, ticks and their labels, on the left and below.
typedef struct axes_look {
    bool x_labels, y_labels;
    bool framed; // with lines on the right and above
    double size; // of the labels
} axes_look;
void draw_axes(drawing *d, const plane *p, const axis *x, const axis *y, axes_look look);
void draw_y_title(drawing *d, const panel_layout *l);

// --- series: series.c

void draw_series(const drawing *d, const panel_layout *l, const plane *p);
// The sample of a series in a legend: a short line and a marker.
void draw_swatch(drawing *d, const panel_layout *l, int index, double x, double y);
// Whether a series' line turns so often that a dash pattern would not be visible.
bool series_is_busy(const plane *p, const figure_series *s);
// Sets colour and pattern of a series; returns the line's width.
double set_series(const drawing *d, const panel_layout *l, int index);

// --- maps: map.c

// Chooses the range of a panel's colour scale.
void map_choose_scale(panel_layout *l);
// Widens the axes to include the map's cells.
void map_include(const figure_map *map, axis_scale *x, axis_scale *y);
double colour_bar_width(const drawing *d, const panel_layout *l);
void set_shade(const drawing *d, const panel_layout *l, double value);
void draw_panel_map(drawing *d, const panel_layout *l);
void draw_colour_bar(drawing *d, const panel_layout *l);

// --- marks: marks.c

// Assigns rows to the labels of marks; returns how many.
int place_marks(drawing *d);
void draw_intervals(const drawing *d, const plane *p);
void draw_marks(drawing *d);
// Keeps hairlines out of the legends that stand inside panels, and of labels at points.
void clip_out_labels(const drawing *d);
// The dots of marks with a point, and the labels at them.
void draw_points(drawing *d);
void draw_measure(drawing *d);
void draw_panel_levels(drawing *d, const panel_layout *l);
void draw_notes(drawing *d, const panel_layout *l);
// Adds the ink of levels and marks to the placement.
void ink_of_marks(const drawing *d, panel_layout *l, placement *grid);
// Finds places for labels at the points of their marks; false if one that had one has
// none now.
bool place_pointed_marks(drawing *d, placement *grid);
// Finds places for the labels of all other marks free of curves of the first panel; false
// if there is none for one of them.
bool place_marks_inside(drawing *d, placement *grid);

// --- impulses: series.c

void draw_impulses(drawing *d, const panel_layout *l);

// Quantity and unit of the strip, in two lines, to be freed; the panel must have an
// impulse_label.
char *impulse_strip_label(const figure *fig, const figure_panel *panel);

// --- legends: legend.c

// Returns false if there is no room inside the panel.
bool place_legend(drawing *d, panel_layout *l, const placement *grid);
void draw_panel_legend(drawing *d, const panel_layout *l);
// The legend for all panels, in rows that are wrapped where they are too long, drawn or
// only measured. Returns its height; 0: none.
double common_legend(drawing *d, bool draw);

// --- the inset: legend.c

void place_inset(const drawing *d, panel_layout *l, placement *grid);
void draw_inset(drawing *d, const panel_layout *l);
// STATUS_BAD_ARGUMENT where an inset that was asked for found no place.
status check_inset(const drawing *d, const panel_layout *l, fault *f);

// --- contour lines of values over a grid: map.c

// A piece of a contour line. Coordinates count grid points: x from 0 to columns - 1.
typedef struct contour_piece {
    double x0, y0, x1, y1;
} contour_piece;

// The contour of z = level within the square of four neighbouring grid points, by
// marching squares with straight lines: z[0] at (0, 0), z[1] at (1, 0), z[2] at (0, 1),
// z[3] at (1, 1). A saddle is decided by the mean of the four. Returns the number of
// pieces, 0 to 2; 0 if a corner is not finite.
int contour_square(const double z[4], double level, contour_piece pieces[2]);

// Values between the points of a map, on a finer grid: z[column * rows + row] at places
// on the page [pt], as coordinates of the values' scale.
typedef struct fine_grid {
    size_t columns, rows;
    double *x, *y, *z;
} fine_grid;

// Divides every cell of a map of two columns and rows or more into parts by parts, with
// monotone cubics along columns and rows: within a cell no value lies outside those of
// its four corners, so that no contour line enters a cell that its corners do not ask
// for. Beside a missing value there are none. To be freed with fine_grid_finish.
fine_grid map_refine(const figure_map *map, const plane *p, scale_kind kind,
                     size_t parts);
void fine_grid_finish(fine_grid *g);

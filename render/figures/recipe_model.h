// A recipe after reading: the contents of a figure and their sources.
#pragma once

#include <glib.h>

#include "render/plot/trace_plot.h"
#include "src/scenario/reader.h"

enum { RECIPE_SOURCES = 16, RECIPE_CHANGES = 16, RECIPE_NOTES = 8, RECIPE_MARKS = 16 };

// A source of curves: a run, measured data, or a table with a column for each axis.
typedef enum source_kind { SOURCE_RUN, SOURCE_DATA, SOURCE_TABLE } source_kind;

typedef struct recipe_source {
    source_kind kind;
    const char *name, *label;           // label NULL: the name
    const char *scenario;               // of a run
    const char *change[RECIPE_CHANGES]; // of a run, "arm.k2=3"
    int change_count;
    const char *file;   // of data (CSV), of a table (a sweep's database)
    const char *column; // of data; NULL: all columns that are signals
    const char *x, *y;  // of a table: columns
    const char *z;      // of a table: the column of a map's colours; NULL: a curve
    double shift;       // of data [s]
    place at;           // its place in the recipe
} recipe_source;

// A text at a point of a panel.
typedef struct recipe_note {
    double x, y;
    const char *text;
} recipe_note;

typedef struct recipe_panel {
    const char *signals[TRACE_SIGNALS];
    int signal_count;
    int sources[RECIPE_SOURCES]; // indices, in the order of the recipe
    int source_count;
    int of, less; // indices of a difference; -1: none
    const char *heading, *label;
    double weight, low, high; // 0; low >= high: from the data
    bool zero, logarithmic;
    recipe_note notes[RECIPE_NOTES];
    int note_count;
    place at;
} recipe_panel;

typedef struct recipe_mark {
    double x;
    const char *label;
} recipe_mark;

typedef struct recipe {
    const char *title, *caption;
    recipe_source sources[RECIPE_SOURCES];
    int source_count;
    recipe_panel panels[FIGURE_PANELS];
    int panel_count;
    recipe_mark marks[RECIPE_MARKS];
    int mark_count;
    const char *x_label, *x_unit;
    double from, to; // of the horizontal axis; from >= to: from the data
    bool logarithmic;
    int columns;
    bool shared;      // all panels have one vertical axis
    bool contact;     // the first run's contact is shaded
    GPtrArray *owned; // texts
} recipe;

// Reads a recipe's text. Every fault is reported with file:line:column; false if there is one.
// recipe_finish in both cases.
bool recipe_read(recipe *r, const char *path, const char *text, size_t length, fault_handler report,
                 void *context);
void recipe_finish(recipe *r);

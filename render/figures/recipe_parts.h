// Internal to recipes: what a recipe says, how its text is read, and the figure made of it.
#pragma once

#include <glib.h>

#include "render/figures/run_figure.h"
#include "render/plot/trace_plot.h"
#include "src/scenario/reader.h"
#include "src/study/store/sweep_store.h"

// --- a recipe after reading

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

typedef struct recipe_panel {
    const char *signals[TRACE_SIGNALS];
    int signal_count;
    int sources[RECIPE_SOURCES]; // indices, in the order of the recipe
    int source_count;
    int of, less; // indices of a difference; -1: none
    const char *heading, *label;
    double weight, low, high; // 0; low >= high: from the data
    bool zero, logarithmic;
    figure_note notes[RECIPE_NOTES];
    int note_count;
    place at;
} recipe_panel;

typedef struct recipe {
    const char *title, *caption;
    recipe_source sources[RECIPE_SOURCES];
    int source_count;
    recipe_panel panels[FIGURE_PANELS];
    int panel_count;
    figure_mark marks[RECIPE_MARKS];
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

// --- reading: values, maps and lists, used by every section: recipe_sources.c

typedef struct recipe_context {
    reader reader;
    recipe *recipe;
} recipe_context;

// Reads a value, or an item of a list, into the object to which the map or the list belongs.
typedef void recipe_taker(recipe_context *c, const tree_node *node, void *into);

// The type of a key's value.
typedef enum value_kind {
    VALUE_OWN,    // read by a function of its own
    VALUE_LIST,   // of items that the function reads
    VALUE_TEXT,   // const char *
    VALUE_TRUTH,  // bool
    VALUE_NUMBER, // double
    VALUE_PAIR,   // two doubles, [a, b]
    VALUE_TAKEN   // read already
} value_kind;

// A key of a map.
typedef struct recipe_key {
    const char *key;
    value_kind kind;
    size_t offset, second; // of its field, or of both fields of a pair, in the object of the map
    recipe_taker *take;    // VALUE_OWN, VALUE_LIST
} recipe_key;

enum { RECIPE_KEYS = 13 }; // most keys of a map, with one that is NULL after the last

// A map: what sentences call it, an example of a line, and its keys.
typedef struct recipe_form {
    const char *what, *example;
    recipe_key keys[RECIPE_KEYS];
} recipe_form;

#define FIELD_KEY(name, value, type, field)                                                        \
    {                                                                                              \
        name, value, offsetof(type, field)                                                         \
    }
#define PAIR_KEY(name, type, one, other)                                                           \
    {                                                                                              \
        name, VALUE_PAIR, offsetof(type, one), offsetof(type, other)                               \
    }
#define OWN_KEY(name, taker)                                                                       \
    {                                                                                              \
        name, VALUE_OWN, .take = taker                                                             \
    }
#define LIST_KEY(name, taker)                                                                      \
    {                                                                                              \
        name, VALUE_LIST, .take = taker                                                            \
    }

// A function that reads a value; its object gets a name for readability.
#define TAKE(name, what) static void name(recipe_context *c, const tree_node *node, void *into)

// Keeps a text from g_malloc with the recipe, and returns it.
const char *recipe_keep(recipe_context *c, char *text);

// A text, kept by the recipe; NULL after a fault.
const char *recipe_text(recipe_context *c, const tree_node *node, const char *what);
void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value);

// Reads every key of a map by its form; unknown keys are reported with the most similar one.
void recipe_map(recipe_context *c, const tree_node *map, const recipe_form *form, void *into);

// Room for the items that a list is read into.
typedef struct recipe_room {
    const char *holder, *things; // "a figure", "panels"
    int most;
} recipe_room;

// Adds one and returns its index; -1 after a fault if there is no room.
int recipe_add(recipe_context *c, const tree_node *node, int *count, recipe_room room);

// The node under a key of a map, or NULL.
const tree_node *recipe_child(const tree_node *map, const char *key);

// --- sources: recipe_sources.c

// Reads the lists of runs, data and tables, in any position in the recipe.
void recipe_take_sources(recipe_context *c, const tree_node *root);

// Whether a parameter has that path; reports if none has.
bool recipe_knows_parameter(recipe_context *c, const tree_node *node, const char *path);

// The index of a source that a panel names, or -1 after a fault.
int recipe_find_source(recipe_context *c, const tree_node *node);

// --- drawing: a figure with everything it borrows

// A source with its run or data.
typedef struct opened_source {
    opened_run run;                       // of a run
    bool ran;                             // the run must be finished
    run_result data;                      // of data: its trace alone
    double *columns[SWEEP_TABLE_COLUMNS]; // of a table: x, y and z
    size_t count;                         // of their values
} opened_source;

typedef struct recipe_figure {
    recipe recipe;
    char *path;
    opened_source sources[RECIPE_SOURCES];
    owned_figure plot;
    figure_map maps[FIGURE_PANELS];
    figure_colours colours[FIGURE_PANELS];
} recipe_figure;

// --- panels: recipe_panels.c

// The axis of a table's column: label and unit of a parameter or summary quantity, otherwise the
// key itself.
figure_axis recipe_column_axis(recipe_figure *fig, const char *key);

// Describes a panel with its curves.
void recipe_describe_panel(recipe_figure *fig, int panel);

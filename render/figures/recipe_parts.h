// Internal to recipes: what a recipe says, and how its text is read.
#pragma once

#include <glib.h>

#include "render/figures/figures.h"
#include "render/plot/trace_plot.h"
#include "src/scenario/reader.h"
#include "src/study/store/sweep_store.h"

// --- a recipe after reading

enum { RECIPE_SOURCES = 48, RECIPE_CHANGES = 16, RECIPE_NOTES = 8, RECIPE_MARKS = 40 };
enum { RECIPE_LEVELS = 8 };

// A source of curves: a run, measured data, or a table with a column for each axis.
typedef enum source_kind { SOURCE_RUN, SOURCE_DATA, SOURCE_TABLE } source_kind;

typedef struct recipe_source {
    source_kind kind;
    const char *name, *label; // label NULL: the name
    const char *scenario; // of a run: a name, a file, or where it has lines its own text
    const char *change[RECIPE_CHANGES]; // of a run, "arm.k2=3"
    int change_count;
    const char *file;   // of data (CSV), of a table (a sweep's database)
    const char *column; // of data; NULL: all columns that are signals
    const char *x, *y;  // of a table: columns
    const char *z;      // of a table: the column of a map's colours; NULL: a curve
    double shift;       // of data [s]
    double look;        // of a run, from 1, 0: by its place
    int rank;           // the same
    place at;           // its place in the recipe

    // once it is opened
    const opened_run *run;                // of a run; of data with its trace alone
    double *columns[SWEEP_TABLE_COLUMNS]; // of a table: x, y and z
    size_t count;                         // of their values
} recipe_source;

typedef struct recipe_panel {
    figure_panel
        shown; // heading, weight, number of notes; label, zero and ends of its axis
    bool logarithmic;
    figure_note notes[RECIPE_NOTES];
    const char *signals[TRACE_SIGNALS];
    int signal_count;
    figure_level levels[RECIPE_LEVELS];
    bool impulses;               // of its runs, in a strip above it
    int round;                   // run with a band on both sides of its curve, -1: none
    double tolerance;            // of that band
    int sources[RECIPE_SOURCES]; // indices, in the order of the recipe
    int source_count;
    bool compared; // shows a difference, of two sources
    int of, less;
} recipe_panel;

typedef struct recipe {
    figure
        shown; // title, caption, width, numbers of panels and marks, its horizontal axis
    bool logarithmic;
    int over;        // signal across the panels, of the table; time unless it is said
    bool spectrum;   // the panels show amplitudes over frequency
    double from, to; // stretch of the runs that a signal across or a spectrum takes [s]
    double columns;
    bool contact; // the first run's contact is shaded
    double arm; // instant at which the first run's arm stands above the panels [s]; NaN:
                // at none
    recipe_source sources[RECIPE_SOURCES];
    int source_count;
    recipe_panel panels[FIGURE_PANELS];
    figure_mark marks[RECIPE_MARKS];
    owned_figure *plot; // the figure made of it, which owns its texts
} recipe;

// Reads a recipe's text. Every fault is reported with file:line:column; false if there is
// one. In both cases r->plot is to be destroyed.
bool recipe_read(recipe *r, const char *path, const char *text, size_t length,
                 fault_handler report, void *context);

// --- reading: values, maps and lists, used by every section: recipe_values.c

typedef struct recipe_context {
    reader reader;
    recipe *recipe;
} recipe_context;

// Reads a value into the object to which the map belongs; or completes one that was read
// and looks whether its parts go together.
typedef void recipe_value_reader(recipe_context *c, const tree_node *node, void *into);

// The type of a key's value.
typedef enum value_kind {
    VALUE_OWN,    // read by a function of its own
    VALUE_ITEMS,  // a list of maps of a form
    VALUE_MAP,    // a map of a form, into the same object
    VALUE_TEXT,   // const char *
    VALUE_TRUTH,  // bool
    VALUE_NUMBER, // double
    VALUE_PAIR    // two doubles, [a, b]
} value_kind;

typedef struct recipe_form recipe_form;

// A key of a map.
typedef struct recipe_key {
    const char *key;
    value_kind kind;
    size_t offset; // of its field, or of the array of items, in the object of the map
    size_t second; // of a pair's second number, or of the number of items
    recipe_value_reader *read; // VALUE_OWN
    const recipe_form *form;   // VALUE_ITEMS, VALUE_MAP
    // of a number: its unit (NULL: none), and between what it must lie (NULL: anywhere)
    const char *unit, *expected;
    double low, high;
    bool whole;
} recipe_key;

enum { RECIPE_KEYS = 16 }; // most keys of a map, with one that is NULL after the last

// A map: what sentences call it, an example of a line, and its keys, which are read in
// this order.
struct recipe_form {
    const char *what, *example;
    recipe_key keys[RECIPE_KEYS];
    // of the items of a list: "a figure" and its "panels", their size and most, and what
    // completes one that was read (NULL: nothing)
    const char *holder, *things;
    size_t size;
    int most;
    recipe_value_reader *complete;
    const void *blank; // what an item is before it is read; NULL: zeros
};

#define FIELD_KEY(name, value, type, field)                                              \
    {                                                                                    \
        name, value, offsetof(type, field)                                               \
    }
#define PAIR_KEY(name, type, one, other)                                                 \
    {                                                                                    \
        name, VALUE_PAIR, offsetof(type, one), offsetof(type, other)                     \
    }
#define ITEMS_KEY(name, items, type, array, count)                                       \
    {                                                                                    \
        name, VALUE_ITEMS, offsetof(type, array), offsetof(type, count), .form = items   \
    }

// Keeps a text from g_malloc with the recipe, and returns it.
const char *recipe_keep(recipe_context *c, char *text);

// A text, kept by the recipe; NULL after a fault.
const char *recipe_text(recipe_context *c, const tree_node *node, const char *what);

// Whether a node is a list of two items.
bool recipe_is_pair(const tree_node *node);

// The first item of a list; NULL if there is none, or after a fault.
const tree_node *recipe_first(recipe_context *c, const tree_node *list, const char *what);

// Reads every key of a map by its form; unknown keys are reported with the most similar
// one.
void recipe_map(recipe_context *c, const tree_node *map, const recipe_form *form,
                void *into);

// The node under a key of a map, or NULL.
const tree_node *recipe_child(const tree_node *map, const char *key);

// --- small multiples: recipe_multiples.c

// Reads `multiples` and repeats runs and panels for each of its values, after both are
// read.
recipe_value_reader recipe_read_multiples;

// --- sources: recipe_sources.c

// The items of the lists of runs, data and tables.
extern const recipe_form recipe_runs, recipe_data, recipe_tables;

// Whether a run's scenario is the text of one.
bool recipe_is_text(const recipe_source *s);

// Whether a parameter has that path; reports if none has.
bool recipe_knows_parameter(recipe_context *c, const tree_node *node, const char *path);

// The index of a source that a panel names, or -1 after a fault.
int recipe_find_source(recipe_context *c, const tree_node *node);

// Inside the reading of recipes: values, maps and lists, and what every section shares.
#pragma once

#include "render/figures/recipe_model.h"

typedef struct recipe_context {
    reader reader;
    recipe *recipe;
} recipe_context;

// Takes a value, or an item of a list, into what the map or the list belongs to.
typedef void recipe_taker(recipe_context *c, const tree_node *node, void *into);

// What stands under a key.
typedef enum value_kind {
    VALUE_OWN,    // what a function of its own takes
    VALUE_TEXT,   // const char *
    VALUE_TRUTH,  // bool
    VALUE_NUMBER, // double
    VALUE_PAIR,   // two doubles, [a, b]
    VALUE_TAKEN   // taken already
} value_kind;

// A key of a map; the list of keys ends with one that is NULL.
typedef struct recipe_key {
    const char *key;
    value_kind kind;
    size_t offset, second; // of its field, or of both of a pair, in what the map goes into
    recipe_taker *take;    // VALUE_OWN
    const char *example;   // of a line, for the first key of a map
} recipe_key;

// Rows of such lists: a key whose value goes into a field, and one with a function of its own.
#define FIELD_KEY(name, value, type, field)                                                        \
    {                                                                                              \
        .key = (name), .kind = (value), .offset = offsetof(type, field)                            \
    }
#define PAIR_KEY(name, type, one, other)                                                           \
    {                                                                                              \
        .key = (name), .kind = VALUE_PAIR, .offset = offsetof(type, one),                          \
        .second = offsetof(type, other)                                                            \
    }
#define OWN_KEY(name, taker, line)                                                                 \
    {                                                                                              \
        .key = (name), .take = (taker), .example = (line)                                          \
    }

// A function that takes a value; what it goes into is named for the reader.
#define TAKE(name, what) static void name(recipe_context *c, const tree_node *node, void *into)

// A text, kept by the recipe; NULL after a fault.
const char *recipe_text(recipe_context *c, const tree_node *node, const char *what);
void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value);

// Every key of a map by the table; unknown ones are reported with the nearest.
void recipe_map(recipe_context *c, const tree_node *map, const char *what, const recipe_key *keys,
                void *into);

// Each item of a list.
void recipe_list(recipe_context *c, const tree_node *list, const char *what, recipe_taker *take,
                 void *into);

// Room for one more of what a list is read into.
typedef struct recipe_room {
    const char *holder, *things; // "a figure", "panels"
    int most;
} recipe_room;

// Counts one more and returns its index; -1 after a fault where there is no room.
int recipe_add(recipe_context *c, const tree_node *node, int *count, recipe_room room);

// The node under a key of a map, or NULL.
const tree_node *recipe_child(const tree_node *map, const char *key);

// --- sources: recipe_sources.c

// Takes the lists of runs, data and tables, wherever they stand in the recipe.
void recipe_take_sources(recipe_context *c, const tree_node *root);

// The index of a source that a panel names, or -1 after a fault.
int recipe_find_source(recipe_context *c, const tree_node *node);

// --- small multiples: recipe_multiples.c

// Takes `multiples` and repeats runs and panels for each of its values, once both are read.
void recipe_take_multiples(recipe_context *c, const tree_node *node);

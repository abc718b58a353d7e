// Internal to the reading of recipes: values, maps and lists, used by every section.
#pragma once

#include "render/figures/recipe_model.h"

typedef struct recipe_context {
    reader reader;
    recipe *recipe;
} recipe_context;

// Reads a value, or an item of a list, into the object to which the map or the list belongs.
typedef void recipe_taker(recipe_context *c, const tree_node *node, void *into);

// The type of a key's value.
typedef enum value_kind {
    VALUE_OWN,    // read by a function of its own
    VALUE_TEXT,   // const char *
    VALUE_TRUTH,  // bool
    VALUE_NUMBER, // double
    VALUE_PAIR,   // two doubles, [a, b]
    VALUE_TAKEN   // read already
} value_kind;

// A key of a map; the list of keys ends with one that is NULL.
typedef struct recipe_key {
    const char *key;
    value_kind kind;
    size_t offset, second; // of its field, or of both fields of a pair, in the object of the map
    recipe_taker *take;    // VALUE_OWN
    const char *example;   // example of a line, for the first key of a map
} recipe_key;

// Rows of such lists: a key with a value for a field, and a key with a function of its own.
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

// A function that reads a value; its object gets a name for readability.
#define TAKE(name, what) static void name(recipe_context *c, const tree_node *node, void *into)

// A text, kept by the recipe; NULL after a fault.
const char *recipe_text(recipe_context *c, const tree_node *node, const char *what);
void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value);

// Reads every key of a map by the table; unknown keys are reported with the most similar one.
void recipe_map(recipe_context *c, const tree_node *map, const char *what, const recipe_key *keys,
                void *into);

// Each item of a list.
void recipe_list(recipe_context *c, const tree_node *list, const char *what, recipe_taker *take,
                 void *into);

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

// The index of a source that a panel names, or -1 after a fault.
int recipe_find_source(recipe_context *c, const tree_node *node);

// --- small multiples: recipe_multiples.c

// Reads `multiples` and repeats runs and panels for each of its values, after both are read.
void recipe_take_multiples(recipe_context *c, const tree_node *node);

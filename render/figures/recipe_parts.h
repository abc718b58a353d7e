// Inside the reading of recipes: values, maps and lists, and what every section shares.
#pragma once

#include "render/figures/recipe_model.h"

typedef struct recipe_context {
    reader reader;
    recipe *recipe;
} recipe_context;

// What may stand under a key: how its value is taken.
typedef struct recipe_key {
    const char *key;
    void (*take)(recipe_context *c, const tree_node *node, void *into);
    const char *example; // of a value
} recipe_key;

// A function that takes a value; what it goes into is named for the reader.
#define TAKE(name, what) static void name(recipe_context *c, const tree_node *node, void *into)

// A text, kept by the recipe; NULL after a fault.
const char *recipe_text(recipe_context *c, const tree_node *node, const char *what);
bool recipe_truth(recipe_context *c, const tree_node *node, const char *what);
void recipe_number(recipe_context *c, const tree_node *node, const char *what, double *value);
// Two numbers, [a, b].
bool recipe_pair(recipe_context *c, const tree_node *node, const char *what, double *a, double *b);

// Every key of a map by the table; unknown ones are reported with the nearest.
void recipe_map(recipe_context *c, const tree_node *map, const char *what, const recipe_key *keys,
                void *into);

// Each item of a list.
void recipe_list(recipe_context *c, const tree_node *list, const char *what,
                 void (*take)(recipe_context *c, const tree_node *node));

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

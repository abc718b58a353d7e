// A YAML file as a small tree whose nodes know their line and column.
//
// Only what a scenario needs: one document of maps, lists and scalars. Every scalar is
// text; what it means is decided by the reader of the tree ("no" is a word, not a truth
// value). Anchors, aliases, tags, further documents and NUL are refused, and so is what
// is too large or too deep.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

enum {
    TREE_MAX_DEPTH = 64,      // maps and lists inside one another
    TREE_MAX_NODES = 10000,   // keys included
    TREE_MAX_BYTES = 1 << 20, // of the text
};

typedef enum tree_kind { TREE_SCALAR, TREE_LIST, TREE_MAP } tree_kind;

typedef struct tree_node {
    tree_kind kind;
    int line, column;        // of its first character, from 1; columns count characters
    bool plain;              // TREE_SCALAR: written without quotes and not as a block
    char *text;              // TREE_SCALAR: UTF-8, never NULL; otherwise NULL
    struct tree_node *key;   // the key this node is the value of, NULL outside a map
    struct tree_node *first; // TREE_LIST, TREE_MAP: first child
    struct tree_node *next;  // next child of the same parent
} tree_node;

// Parses `length` bytes of text. Returns the root, to be given to tree_free, or NULL with
// a fault that has its place: STATUS_BAD_SCENARIO, or STATUS_NO_MEMORY.
tree_node *tree_parse(const char *text, size_t length, fault *f);

// The value of a key in a map, the first if it is there twice; NULL without one.
tree_node *tree_child(const tree_node *map, const char *key);

// Frees a node with all below it; NULL is fine.
void tree_free(tree_node *node);

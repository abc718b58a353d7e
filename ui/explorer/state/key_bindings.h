// Which key carries out what: the explorer's own table, the user's keys over it, and the names of
// keys.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "ui/explorer/state/prompt.h"

enum { USER_KEYS = 64, KEY_NAME = 16 };

// A key of the user's own.
typedef struct user_key {
    int key;
    char line[LINE_TEXT]; // what it carries out, "" for nothing
} user_key;

typedef struct key_bindings {
    user_key own[USER_KEYS];
    int count;
} key_bindings;

// The key of a name of `length` bytes ("Space", "C-r", "x"), 0 if there is none.
int key_of_name(const char *name, size_t length);
// The name of a key.
void key_name(int key, char *text, size_t size);

// What a key carries out, NULL for nothing.
const char *key_line(const key_bindings *b, int key);
// What it carries out where it is no key of the user's own, NULL for nothing.
const char *key_built_in_line(int key);

// The user's key, NULL if it is none.
user_key *key_find_own(key_bindings *b, int key);
// Makes a key the user's own, or finds the one it is; NULL if no more fit.
user_key *key_add_own(key_bindings *b, int key);
// Takes a key of the user's own out; the explorer's meaning of it holds again.
void key_remove_own(key_bindings *b, user_key *own);

// The names of the keys that carry a command out, blanks between them.
void key_names_of(const key_bindings *b, const char *command, char *text, size_t size);

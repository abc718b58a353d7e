// Key bindings: the explorer's own table, the user's keys, which take precedence, and the names of
// keys.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "ui/explorer/state/prompt.h"

enum { USER_KEYS = 64, KEY_NAME = 16 };

// A key bound by the user.
typedef struct user_key {
    int key;
    char line[LINE_TEXT]; // the line it executes, "" for none
} user_key;

typedef struct key_bindings {
    user_key own[USER_KEYS];
    int count;
} key_bindings;

// The key of a name of `length` bytes ("Space", "C-r", "x"), 0 if there is none.
int key_of_name(const char *name, size_t length);
// The name of a key.
void key_name(int key, char *text, size_t size);

// The line that a key executes, NULL for none.
const char *key_line(const key_bindings *b, int key);
// The line that the explorer's own table gives it, NULL for none.
const char *key_built_in_line(int key);

// The user's binding of a key, NULL if there is none.
user_key *key_find_own(key_bindings *b, int key);
// Finds or adds the user's binding of a key; NULL if there is no room for another.
user_key *key_add_own(key_bindings *b, int key);
// Removes the user's binding of a key, so that the explorer's own applies again.
void key_remove_own(key_bindings *b, user_key *own);

// The names of the keys that execute a command, separated by blanks.
void key_names_of(const key_bindings *b, const char *command, char *text, size_t size);

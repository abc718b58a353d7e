// The text of the help page, made from the tables of keys and commands.
#pragma once

#include "ui/explorer/state/key_bindings.h"

typedef struct help_line {
    char text[LINE_TEXT];
    int keys; // cells at its beginning that are keys
    bool heading;
} help_line;

// Writes the help page, wrapped to a width; returns how many lines it has, not more than `most`.
int help_write(const key_bindings *b, int width, help_line *lines, int most);

// A line of text that is edited: a cursor in it, and the keys that shells have for it.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// What a key did to a line.
typedef enum line_edit {
    LINE_UNTOUCHED, // it is no key of the editor
    LINE_EDITED,    // text or cursor changed, or the cursor is at an end
    LINE_FULL       // there is no room for the character
} line_edit;

// Gives a key to a line of UTF-8 in `size` bytes, of which the first `fixed` are not the
// value that is edited; *cursor is the byte before which the cursor stands. Characters
// are put in; Left, Right, Home and C-a, End and C-e move; Backspace and Delete take a
// character, C-k all behind the cursor, C-u the value before it, or if there is none the
// whole line before it, C-w a word before it up to a blank; Alt-b and Alt-f move by words
// of letters and digits, Alt-d and Alt-Backspace take one.
line_edit line_edit_key(char *text, size_t size, int fixed, int *cursor, int key);

// The prompt: a line that is being typed.
#pragma once

#include <stdbool.h>

enum { LINE_TEXT = 256 }; // of a command, a filter, a name

typedef struct prompt {
    bool open; // keys go to it
    char text[LINE_TEXT];
    char history[LINE_TEXT]; // the last line that was entered
} prompt;

// Opens the prompt with a text to go on with.
void prompt_open(prompt *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Puts a key's character at the end of a text of LINE_TEXT bytes, or takes the last one off. False
// if the key does neither.
bool text_type(char *text, int key);

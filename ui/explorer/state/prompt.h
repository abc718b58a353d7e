// The prompt: a line that is being typed.
#pragma once

#include <stdbool.h>

enum { LINE_TEXT = 256 }; // of a command, a filter, a name

typedef struct prompt {
    bool open; // keys go to it
    char text[LINE_TEXT];
    int fixed;               // bytes of it that stand before a value
    bool searches;           // it takes words for the palette, not a command
    bool replaces;           // the value is as it was, and what is typed takes its place
    bool cycling;            // Tab goes through what fits to `stem`
    int cycle;               // number of the one that is shown, -1 for none
    int stem_at;             // byte where the word begins that is completed
    char stem[LINE_TEXT];    // as it was typed
    char history[LINE_TEXT]; // the last line that was entered
} prompt;

// Opens the prompt with a text to go on with.
void prompt_open(prompt *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The same with a value behind the text, which typing replaces.
void prompt_open_value(prompt *p, const char *text, const char *value);
// Types a key into an open prompt: C-u clears the value first, then everything. False if the key
// types nothing.
bool prompt_type(prompt *p, int key);

// Puts a key's character at the end of a text of LINE_TEXT bytes, or takes the last one off. False
// if the key does neither.
bool text_type(char *text, int key);

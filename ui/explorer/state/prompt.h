// The prompt: a line of input.
#pragma once

#include <stdbool.h>

enum { LINE_TEXT = 256 }; // bytes of a command, a filter or a name

typedef struct prompt {
    bool open; // it receives the keys
    char text[LINE_TEXT];
    int fixed;               // bytes before an editable value
    bool searches;           // it contains words for the palette, not a command
    bool replaces;           // the value is unchanged and is replaced by the next input
    bool cycling;            // Tab cycles through the completions of `stem`
    int cycle;               // number of the completion shown, -1 for none
    int stem_at;             // index of the first byte of the completed word
    char stem[LINE_TEXT];    // the word as it was typed
    char history[LINE_TEXT]; // the last line that was entered
} prompt;

// Opens the prompt with an initial text.
void prompt_open(prompt *p, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The same with a value after the text, which typing replaces.
void prompt_open_value(prompt *p, const char *text, const char *value);
// Enters a key into an open prompt: C-u clears the value first, then everything. False if the key
// has no effect.
bool prompt_type(prompt *p, int key);

// Appends a key's character to a text of LINE_TEXT bytes, or deletes the last one. False if the key
// does neither.
bool text_type(char *text, int key);

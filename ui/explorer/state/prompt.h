// The prompt: a line of input.
#pragma once

#include <stdbool.h>

#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/scenario_menu.h"

enum { HISTORY_LINES = 200 };

typedef struct prompt {
    bool open; // it receives the keys
    char text[LINE_TEXT];
    int cursor;           // byte before which the cursor stands
    int fixed;            // bytes before an editable value
    bool searches;        // it contains words for the palette, not a command
    bool replaces;        // the value is unchanged and is replaced by the next input
    bool cycling;         // Tab cycles through the completions of `stem`
    int cycle;            // number of the completion shown, -1 for none
    int stem_at;          // index of the first byte of the completed word
    char stem[LINE_TEXT]; // the word as it was typed

    // the lines that were entered, the oldest first
    char history[HISTORY_LINES][LINE_TEXT];
    int history_count;
    int recalled;            // number of lines that Up has gone back, 0: none
    char typed[LINE_TEXT];   // before it did
    char history_path[1024]; // of the file that keeps them, "" for none
} prompt;

// Opens the prompt with an initial text, and after it a value, which typing replaces;
// NULL: none.
void prompt_open(prompt *p, const char *value, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
// Enters a key into an open prompt, by line_edit_key; a character takes the place of a
// value that is to be replaced. False if there is no room for it.
bool prompt_type(prompt *p, int key);

// Goes to the line that was entered before (-1) or after (1) the one that is shown.
void prompt_recall(prompt *p, int direction);
// Keeps a line that was entered, in the file, too.
void prompt_remember(prompt *p, const char *line);
// Keeps lines in a file from now on, and takes those it has.
void prompt_use_history(prompt *p, const char *path);

// Appends a key's character to a text of LINE_TEXT bytes, or deletes the last one. False
// if there is no room for it.
bool text_type(char *text, int key);

// --- the palette -----------------------------------------------------------------------

// What the palette lists: all there is, or what can be opened.
typedef enum palette_scope { SCOPE_ALL, SCOPE_SCENARIOS, SCOPE_LESSONS } palette_scope;

// Which entry of the palette is selected.
typedef struct palette_view {
    int selected; // -1: none, and Enter executes the line as typed
    bool picked;  // the selected entry was chosen with the mouse
    palette_scope scope;
} palette_view;

// Whether an open prompt shows the palette: it searches, or its first word is being
// typed.
bool palette_shows(const prompt *p);

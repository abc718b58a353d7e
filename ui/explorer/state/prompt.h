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
// The palette: one searchable list of commands with their keys, parameters, signals,
// scenarios and lessons.

enum { PALETTE_ENTRIES = 1024 };

typedef enum palette_kind {
    PALETTE_COMMAND,
    PALETTE_PARAMETER,
    PALETTE_SIGNAL,
    PALETTE_QUANTITY,
    PALETTE_SCENARIO,
    PALETTE_LESSON,
    PALETTE_KINDS
} palette_kind;

typedef struct palette_entry {
    palette_kind kind;
    int index; // index in the table or list of its kind
    int rank;  // how well it matches; 0 is best
} palette_entry;

// Which entry of those shown is selected.
typedef struct palette_view {
    int selected; // -1: none, and Enter executes the line as typed
    bool picked;  // the selected entry was chosen with the mouse
} palette_view;

// What an entry is ("command", "parameter", ...), its name and description.
typedef struct palette_text {
    const char *kind, *name, *about;
    char keys[32]; // keys of a command, "" for none
} palette_text;

// The entries whose names or descriptions contain all the words, best matches first;
// returns how many. Without words all entries.
int palette_find(const scenario_menu *menu, const key_bindings *keys, const char *words,
                 palette_entry entries[PALETTE_ENTRIES]);

palette_text palette_describe(const scenario_menu *menu, const key_bindings *keys,
                              palette_entry entry);

// The command line of an entry; whether it still needs an argument.
void palette_line(const scenario_menu *menu, const key_bindings *keys,
                  palette_entry entry, char line[LINE_TEXT], bool *needs_argument);

// Other words by which people look for a command or a quantity, "" for none.
const char *synonyms_of(const char *name);

// Whether an open prompt shows the palette: it searches, or its first word is being
// typed.
bool palette_shows(const prompt *p);

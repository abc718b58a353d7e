// The palette: everything that can be asked for by words, in one list: commands with their keys,
// parameters, signals, scenarios and lessons.
#pragma once

#include "ui/explorer/state/key_bindings.h"
#include "ui/explorer/state/prompt.h"
#include "ui/explorer/state/scenario_menu.h"

enum { PALETTE_ENTRIES = 768, PALETTE_NAME = 96 };

typedef enum palette_kind {
    PALETTE_COMMAND,
    PALETTE_PARAMETER,
    PALETTE_SIGNAL,
    PALETTE_SCENARIO,
    PALETTE_LESSON,
    PALETTE_KINDS
} palette_kind;

typedef struct palette_entry {
    palette_kind kind;
    int index; // in the table or the list of its kind
    int rank;  // how well it fits, the best is 0
} palette_entry;

// Which entry of those shown is selected.
typedef struct palette_view {
    int selected; // -1: none, Enter carries out the line as it stands
    bool picked;  // the mouse has chosen the selected one
} palette_view;

// What an entry is called, and what it is or does.
typedef struct palette_text {
    char name[PALETTE_NAME];
    char keys[32]; // that carry out a command, "" for none
    char about[LINE_TEXT];
} palette_text;

// "command", "parameter", ...
const char *palette_kind_name(palette_kind kind);

// The entries that have all words, or parts of words, in their names or in what is said of them,
// those that fit best first; returns how many. No words let everything through.
int palette_find(const scenario_menu *menu, const key_bindings *keys, const char *words,
                 palette_entry entries[PALETTE_ENTRIES]);

palette_text palette_describe(const scenario_menu *menu, const key_bindings *keys,
                              palette_entry entry);

// The line of a command that does what an entry is for; *goes_on: it wants an argument, which is
// typed behind it.
void palette_line(const scenario_menu *menu, palette_entry entry, char *line, size_t size,
                  bool *goes_on);

// Whether an open prompt shows the palette: it searches, or its first word is being typed.
bool palette_shows(const prompt *p);

// The palette: one searchable list of what there is in the lab, each with the command
// that deals with it.
#pragma once

#include "ui/explorer/state/state.h"

enum { PALETTE_ENTRIES = 2048 };

typedef enum palette_kind {
    PALETTE_COMMAND,
    PALETTE_PARAMETER,
    PALETTE_SIGNAL,
    PALETTE_QUANTITY,
    PALETTE_SCENARIO,
    PALETTE_LESSON,
    PALETTE_RUN,       // a pinned one
    PALETTE_EVENT,     // of the present run, as far as that was seen
    PALETTE_FILE,      // of the working folder, or the one whose path is typed
    PALETTE_RECORDING, // such a file, whose command the run is to play
    PALETTE_TOPIC,     // of the help
    PALETTE_KINDS
} palette_kind;

typedef struct palette_entry {
    palette_kind kind;
    int index; // index in the table or list of its kind
    int rank;  // how well it matches; 0 is best
} palette_entry;

// What an entry is ("command", "parameter", ...), its name and description.
typedef struct palette_text {
    const char *kind, *about;
    char name[LINE_TEXT];
    char keys[32]; // keys of a command, "" for none
} palette_text;

// Reads which files of the working folder the lab can open; to be called when the palette
// opens. And takes what is typed for the path of another one, if it is that.
void palette_read_files(file_list *files);
void palette_take_path(file_list *files, const char *typed);

// The entries whose names or descriptions contain all the words, best matches first;
// returns how many. Without words all entries.
int palette_find(const explorer_model *model, const explorer_view *view,
                 const char *words, palette_entry entries[PALETTE_ENTRIES]);

palette_text palette_describe(const explorer_model *model, const explorer_view *view,
                              palette_entry entry);

// The command line of an entry; whether it still needs an argument.
void palette_line(const explorer_model *model, const explorer_view *view,
                  palette_entry entry, char line[LINE_TEXT], bool *needs_argument);

// Other words by which people look for a command or a quantity, "" for none.
const char *synonyms_of(const char *name);

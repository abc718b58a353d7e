// How the explorer is looked at: panels, their filters, looks, the message line.
#pragma once

#include <stdbool.h>

#include "ui/explorer/state/command_list.h"
#include "ui/terminal/screen.h"

// --- panels ----------------------------------------------------------------------------
// One list gives each an identity, a place on the screen and the description in the
// panel's own file. A new panel needs one file, one line here and one in meson.build.

// The places of panels.
typedef enum panel_place {
    PLACE_STRIP, // below the title: results, and the step of a lesson
    PLACE_TOP,   // above the curves
    PLACE_MAIN,  // below that
    PLACE_SIDE,  // on the right; Tab selects one of these
    PLACE_BELOW, // below the selected one, where that has room
    PLACE_PAGE,  // opens over the others
    PLACE_PROMPT // above the prompt while that is open
} panel_place;

// identity, place, description; side panels in the order in which Tab selects them
#define PANEL_LIST(X)                                                                    \
    X(PANEL_RESULTS, PLACE_STRIP, results_panel)                                         \
    X(PANEL_LESSON, PLACE_STRIP, lesson_panel)                                           \
    X(PANEL_ARM, PLACE_TOP, arm_panel)                                                   \
    X(PANEL_CURVES, PLACE_MAIN, curves_panel)                                            \
    X(PANEL_PARAMETERS, PLACE_SIDE, parameters_panel)                                    \
    X(PANEL_VALUES, PLACE_SIDE, values_panel)                                            \
    X(PANEL_STATISTICS, PLACE_SIDE, statistics_panel)                                    \
    X(PANEL_SWEEP, PLACE_SIDE, sweep_panel)                                              \
    X(PANEL_PREDICTORS, PLACE_BELOW, predictors_panel)                                   \
    X(PANEL_HELP, PLACE_PAGE, help_panel)                                                \
    X(PANEL_COMPARISON, PLACE_PAGE, comparison_panel)                                    \
    X(PANEL_CHANGES, PLACE_PAGE, changes_panel)                                          \
    X(PANEL_RUN_LIST, PLACE_PAGE, run_list_panel)                                        \
    X(PANEL_INFO, PLACE_PAGE, info_panel)                                                \
    X(PANEL_EXPLAIN, PLACE_PAGE, explain_panel)                                          \
    X(PANEL_WHY, PLACE_PAGE, why_panel)                                                  \
    X(PANEL_POLES, PLACE_PAGE, poles_panel)                                              \
    X(PANEL_NOTES, PLACE_PAGE, notes_panel)                                              \
    X(PANEL_PALETTE, PLACE_PROMPT, palette_panel)

typedef enum panel_id {
    PANEL_NONE,
#define PANEL_ID(id, place, description) id,
    PANEL_LIST(PANEL_ID)
#undef PANEL_ID
        PANEL_IDS // one more than the last
} panel_id;

// The place of a panel; not for PANEL_NONE.
panel_place panel_place_of(panel_id id);

// --- filters ---------------------------------------------------------------------------
// A line of words for each panel that is a list.

typedef struct filters {
    panel_id typing; // keys go to this panel's filter; PANEL_NONE for none
    char text[PANEL_IDS][LINE_TEXT];
} filters;

// Whether a text passes a filter: every word of the filter is part of the text, whatever
// the case of letters. Every text passes an empty filter.
bool filter_passes(const char *filter, const char *text);

// --- files -----------------------------------------------------------------------------
// Files of the working folder that the lab can open, and the one whose path is typed.

enum { FILES_LISTED = 128, FILE_NAME = 128 };

typedef struct file_list {
    char names[FILES_LISTED][FILE_NAME];
    int count;
    char typed[LINE_TEXT]; // "" for none
} file_list;

// --- looks -----------------------------------------------------------------------------
// And the words for them in commands and settings.

// Choices are values of their enumerations.
typedef struct looks {
    int glyphs;     // glyph_set
    int theme;      // colour_theme
    int depth;      // colour_depth of the terminal; DEPTH_UNKNOWN without one
    int pixels;     // not 0: pictures are drawn if the terminal has them
    double rate;    // most that pictures may take [kB/s], 0: no limit
    double bending; // factor by which bending is enlarged
    int mouse;      // not 0: mouse reports are on
    bool redraw;    // the whole screen must be redrawn
} looks;

// A command that chooses one of a few words for how the lab looks.
enum { LOOK_WORDS = 5 };
typedef struct look_choice {
    const char *command;
    size_t place; // of the choice in struct looks
    const char *words[LOOK_WORDS +
                      1]; // of the values of its enumeration, in their order; then NULL
    const char *says[LOOK_WORDS]; // when one is chosen, or the first for any word (%s),
                                  // if anything
} look_choice;

// All of them; the last one has no command.
extern const look_choice look_choices[];

// The choice of a command, which has one; its present value.
const look_choice *look_choice_of(const char *command);
int *look_value(looks *l, const look_choice *c);
// The word for its present value.
const char *look_word(const looks *l, const look_choice *c);

// --- messages --------------------------------------------------------------------------

enum { MESSAGE_TEXT = 1024 };

// What was said last.
typedef struct message_line {
    char text[MESSAGE_TEXT]; // "" for none
    bool warning;
    int at; // of a line that failed: its characters before the mistake
} message_line;

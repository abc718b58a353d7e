// The list of scenarios: names, titles, filter and selection. And the progress in a lesson.
#pragma once

#include <stdbool.h>

#include "src/session/session.h"
#include "ui/explorer/state/runs.h"

// What a scenario says of itself.
typedef struct menu_text {
    char *title, *description; // NULL if it has none or could not be read
    bool is_lesson;
} menu_text;

typedef struct scenario_menu {
    char **names;     // of all scenarios
    menu_text *texts; // of each; NULL before they are read
    int count;
    char filter[LINE_TEXT];
    bool filtering; // the filter receives the keys
    int selected;   // index
} scenario_menu;

// Reads the names; the list stays empty if that fails.
void scenario_menu_read(scenario_menu *menu);
// Reads titles and descriptions, once.
void scenario_menu_read_titles(scenario_menu *menu);
void scenario_menu_finish(scenario_menu *menu);

// The index of a name, -1 if there is none.
int scenario_menu_find(const scenario_menu *menu, const char *name);
// What a scenario says of itself, "" where it has nothing or nothing was read.
menu_text scenario_menu_text(const scenario_menu *menu, int index);
// Whether a scenario passes the filter by its name or title.
bool scenario_menu_shows(const scenario_menu *menu, int index);
// The index of the scenario in a displayed line, -1 after the last.
int scenario_menu_in_line(const scenario_menu *menu, int line);

// Moves the selection to the next scenario shown (direction 1) or the previous one (-1).
void scenario_menu_move(scenario_menu *menu, int direction);
// Moves the selection to the first scenario shown if the filter hides the selected one.
void scenario_menu_keep_selection_shown(scenario_menu *menu);

// --- lessons ----------------------------------------------------------------------------------

typedef struct lesson_progress {
    bool on;
    int step;
    bool passed;   // the step is done, and its concluding text is shown
    bool answered; // an answer was given to this step
    double answer; // a number, or the number of a choice, from 1
} lesson_progress;

// Whether answers and actions meet the step's conditions.
bool lesson_step_is_done(const lesson_step *step, const lesson_progress *p, const session *s,
                         const run_list *pinned);

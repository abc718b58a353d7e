// The list of scenarios: their names and titles, which of them the filter lets through, and which
// one is selected.
#pragma once

#include <stdbool.h>

#include "ui/explorer/state/prompt.h"

typedef struct scenario_menu {
    char **names;  // of all scenarios
    char **titles; // theirs, where there is one; NULL before they are wanted
    char **descriptions;
    bool *lessons; // whether each is a lesson; NULL before that is wanted
    int count;
    char filter[LINE_TEXT];
    bool filtering; // keys go to the filter
    int selected;   // index
    int first;      // line shown first; negative: round the selected one
} scenario_menu;

// Reads the names; the list stays empty if that fails.
void scenario_menu_read(scenario_menu *menu);
// Reads titles and descriptions, once.
void scenario_menu_read_titles(scenario_menu *menu);
void scenario_menu_finish(scenario_menu *menu);

// The index of a name, -1 if there is none.
int scenario_menu_find(const scenario_menu *menu, const char *name);
// The title of a scenario, "" if there is none or none was read.
const char *scenario_menu_title(const scenario_menu *menu, int index);
// What a scenario is about, "" if it does not say or none was read.
const char *scenario_menu_description(const scenario_menu *menu, int index);
// Whether a scenario is a lesson, as far as it was read.
bool scenario_menu_is_lesson(const scenario_menu *menu, int index);
// Whether the filter lets a scenario through, by words of its name or title.
bool scenario_menu_shows(const scenario_menu *menu, int index);
// The index of the scenario in a line of those shown, -1 beyond them.
int scenario_menu_in_line(const scenario_menu *menu, int line);

// Moves the selection on to the next scenario shown (direction 1) or the one before it (-1).
void scenario_menu_move(scenario_menu *menu, int direction);
// Moves the selection to the first scenario shown if the filter hides the selected one.
void scenario_menu_keep_selection_shown(scenario_menu *menu);

// The list of scenarios: names and titles. And the progress in a lesson.
#pragma once

#include <stdbool.h>

#include "src/session/session.h"
#include "ui/explorer/state/run_list.h"

// What a scenario says of itself.
typedef struct menu_text {
    char *title; // NULL if it has none or could not be read
    bool is_lesson;
} menu_text;

typedef struct scenario_menu {
    char **names;     // of all scenarios
    menu_text *texts; // of each; NULL before they are read
    int count;
} scenario_menu;

// Reads the names; the list stays empty if that fails.
void scenario_menu_read(scenario_menu *menu);
// Reads their titles, once.
void scenario_menu_read_titles(scenario_menu *menu);
void scenario_menu_finish(scenario_menu *menu);

// The index of a name, -1 if there is none.
int scenario_menu_find(const scenario_menu *menu, const char *name);
// What a scenario says of itself, "" where it has nothing or nothing was read.
menu_text scenario_menu_text(const scenario_menu *menu, int index);

// --- lessons ---------------------------------------------------------------------------

typedef struct lesson_progress {
    bool on;
    int step;
    bool passed;   // the step is done, and its concluding text is shown
    bool answered; // an answer was given to this step
    double answer; // a number, or the number of a choice, from 1
} lesson_progress;

// Whether answers and actions meet the step's conditions.
bool lesson_step_is_done(const lesson_step *step, const lesson_progress *p,
                         const session *s, const run_list *pinned);

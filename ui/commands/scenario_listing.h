// The scenarios that the commands list and lesson go through.
#pragma once

#include "ui/commands/command.h"
#include "ui/commands/results.h"

// All scenarios, by name.
typedef struct scenario_listing {
    char **names;
    int count;
    json_t *entries; // what --json writes of them; NULL: they are printed
} scenario_listing;

// Finds the scenarios. Returns the exit status; unless it is EXIT_DONE, nothing has to be
// closed.
int scenario_listing_open(scenario_listing *l, const arguments *a);

// Writes the entries that --json asks for. Returns the exit status, `result` if that is
// worse.
int scenario_listing_close(scenario_listing *l, const arguments *a, int result);

// What a list says of a scenario.
typedef struct scenario_heading {
    bool faulty; // it has faults, which are reported when it is opened, and no title
    bool is_lesson;
    char title[SCENARIO_TITLE + 1];
} scenario_heading;

// Reads what a list says of a scenario. Returns the exit status; a scenario with faults
// is EXIT_DONE and `faulty`.
int scenario_heading_read(const char *name, scenario_heading *h);

// Which parameters have no effect in a run of a scenario: by the table of
// src/tables/features.h, the law, the script and the engine that takes the arm.
#pragma once

#include "src/scenario/scenario.h"

// Why a parameter has no effect on a run, whatever its value from the start on: half a
// sentence; NULL if it has one.
const char *effect_none(const scenario *s, int parameter);

// Why the value has none that a parameter gets from action `first` of the script on (-1:
// from the start) until it gets another one; NULL if it has one.
const char *effect_none_from(const scenario *s, int parameter, int first);

// A value that somebody gave, in a file or since, and that has no effect.
typedef struct idle_value {
    char path[ACTION_PATH];
    const char *why; // half a sentence
    int line;        // in the file that gave it, 0 if none did
} idle_value;

// The next of them: *place is 0 at first, and then left alone. Returns false behind the
// last one.
bool effect_next_idle(const scenario *s, int *place, idle_value *idle);

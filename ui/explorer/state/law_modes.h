// The modes of the control law that is on, by name.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/rig/rig.h"

enum { LAW_MODES = 12 };

typedef struct law_modes {
    unsigned long run; // whose law it is; 0: nothing is known
    int count;
    bool lockable; // the law can be held in one of them
    char names[LAW_MODES][MODE_NAME_SIZE];
} law_modes;

// Asks for the modes of the law of a run, once for each run.
void law_modes_update(law_modes *m, unsigned long run, const parameters *p);

// What a mode is called; "mode N" where the law has no name for it.
void law_mode_name(const law_modes *m, double mode, char *text, size_t size);

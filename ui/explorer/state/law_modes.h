// The modes of the present control law, by name.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/rig/rig.h"

enum { LAW_MODES = 12 };

typedef struct law_modes {
    unsigned long run; // the run of the law; 0: none
    int count;
    bool lockable; // the law can be held in one of them
    char names[LAW_MODES][MODE_NAME_SIZE];
} law_modes;

// Reads the modes of a run's law, once for each run.
void law_modes_update(law_modes *m, unsigned long run, const parameters *p);

// The name of a mode; "mode N" if the law gives none.
void law_mode_name(const law_modes *m, double mode, char *text, size_t size);

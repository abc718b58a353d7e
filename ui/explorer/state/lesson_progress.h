// Progress in a lesson.
#pragma once

#include <stdbool.h>

#include "src/session/session.h"
#include "ui/explorer/state/run_list.h"

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

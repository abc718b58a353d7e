// How far a lesson has come.
#pragma once

#include <stdbool.h>

#include "src/session/session.h"
#include "ui/explorer/state/run_list.h"

typedef struct lesson_progress {
    bool on;
    int step;
    bool passed;   // the step is done, and what is said then is shown
    bool answered; // an answer was given to this step
    double answer; // a number, or of a choice its number from 1
} lesson_progress;

// What has been answered and done is as the step wants it.
bool lesson_step_is_done(const lesson_step *step, const lesson_progress *p, const session *s,
                         const run_list *pinned);

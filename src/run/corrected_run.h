// A run of the corrected arm in progress.
#pragma once

#include "src/run/recording.h"
#include "src/solve/contact_machine.h"
#include "src/solve/pace.h"

// A point on the way along a step: the instant, and what the sensors see there.
typedef struct way {
    double time; // [s]
    sensed_motion at;
    double integral; // of the force [N s]
} way;

// A step that continues beyond instants at which the run is observed: samples of the rig that
// change nothing, stops of a program. The motion still stands at the step's start and knows how far
// the step goes (m->ahead; m->trial is a copy, as after a step); the run has come to an instant
// within it.
typedef struct step_under_way {
    bool goes_on;     // there is one
    double begun_for; // the stop that it was begun for [s]
    double now;       // the run's instant [s]
    way sensed;       // up to where the sensors have followed the arm
} step_under_way;

typedef struct corrected_run {
    recording *recording;
    motion *motion;

    // the stretch between two stops of script, rig or window that the motion is in
    double stop;       // where it ends at the latest, 0 before the first [s]
    double last_event; // in it, -1 if none [s]
    int at_once;       // events in a row without time passing
    pace pace;         // of the whole run
    step_under_way under_way;

    arm arm; // with the command in force
} corrected_run;

// The instant that the run has come to [s].
static inline double corrected_now(const corrected_run *c)
{
    return c->under_way.goes_on ? c->under_way.now : c->motion->state[SLOT_TIME];
}

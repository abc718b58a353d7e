// The arms that the law `observer` holds possible: the one that it is told of, beams of other
// numbers of links, and a hub that gives. Each has an observer and gains of its own; all observers
// follow the same readings, and the law goes on with the arm that foretells them best.
#pragma once

#include "src/rig/laws/observer_design.h"

enum { OBSERVER_MOST_ARMS = 5 };

typedef struct observer_arms {
    observer_design arms[OBSERVER_MOST_ARMS]; // the first is the one told of
    int count, on;                            // on: the one that the law goes by
} observer_arms;

// Designs for the arm that the setup describes and for those that it may be instead: two, three and
// six links and a hub that gives a sixth of what the beam does, but for those that are as stiff at
// the wall as the one told, within a quarter, and so are one with it. The law begins with the arm
// told of. NULL, or a sentence that says why that cannot be.
const char *observer_arms_init(observer_arms *a, const controller_setup *setup,
                               const observer_task *task);

// The design and the observer that the law goes by.
const observer_design *observer_arms_design(const observer_arms *a);
const arm_observer *observer_arms_observer(const observer_arms *a);

// What becomes of all observers: arm_observer_start, _know_wall, _sample, _touch and _leave.
void observer_arms_start(observer_arms *a, const controller_input *in);
void observer_arms_know_wall(observer_arms *a, double angle);
void observer_arms_sample(observer_arms *a, const controller_input *in, bool takes_force);
void observer_arms_touch(observer_arms *a, double time);
void observer_arms_leave(observer_arms *a, double time);

// Goes over to the arm that foretells the readings best, where they leave no doubt: by a
// likelihood ratio of a million, since the errors of a wrong parameter come many in a row. Returns
// whether that is another than before.
bool observer_arms_choose(observer_arms *a);

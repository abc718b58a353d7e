// What happens to a run of the corrected arm between its steps: events of the motion, the script's
// actions, and the commands of the rig.
#pragma once

#include "src/run/corrected_run.h"

// Derives the arm's constants from the parameters as they are now; the command in force stays.
void corrected_bind_arm(corrected_run *c);

// To be called of a run that begins: one that starts at rest on the wall is in its first contact,
// which no event begins. STATUS_NO_MEMORY.
status corrected_begin_in_contact(corrected_run *c);

// The first pulse is over: takes note of its length and of the largest force until now.
void corrected_close_first_pulse(corrected_run *c);

// The same of the landing's pulse.
void corrected_close_landing(corrected_run *c);

// The bounds [N] of a force into two numbers of the summary, which stay as they are where it is
// determined.
void corrected_tell_bounds(force_bounds bounds, double *low, double *high);

// Applies an event that the motion stopped at and records the rows on its both sides.
status corrected_pass_event(corrected_run *c, motion_report *report);

// Carries out one action now and records it as action `index` of the script (-1: of no script); the
// rows on its both sides show what it changed.
status corrected_act(corrected_run *c, const action *todo, int index, fault *f);

// Carries out the script's actions that are due. A failure is explained in f, or has a code only.
status corrected_run_script(corrected_run *c, fault *f);

// Puts a new command of the rig into effect: the torque jumps, and with it accelerations and force.
// Records the rows on both sides of the jump.
status corrected_apply_command(corrected_run *c);

// What a control law is not told: errors of arm, wall, sensors, computer and beliefs,
// drawn two or three at once from stated ranges.
#pragma once

#include <stdint.h>

#include "src/scenario/scenario.h"

// The kinds of errors, and at most so many in a case.
enum { LAW_ERRORS = 31, LAW_ERRORS_A_CASE = 3 };

enum { DRAWN_CASE_SETTINGS = 48, DRAWN_SETTING_LENGTH = 64 };

// A case: what differs from the scenario.
typedef struct drawn_case {
    char settings[DRAWN_CASE_SETTINGS][DRAWN_SETTING_LENGTH]; // "PATH=VALUE"
    int of[DRAWN_CASE_SETTINGS]; // kind of error that each belongs to, -1: none
    int setting_count;
    int errors[LAW_ERRORS_A_CASE]; // their kinds
    int error_count;
    double push, push_time; // an impulse at the tip [N s], 0: none, and its instant [s]
} drawn_case;

// The name of a kind of error, 0 <= kind < LAW_ERRORS: "tip mass".
const char *law_error_name(int kind);

// Draws a case around a scenario. Ranges of length, joint stiffness, hub inertia and
// start are those of the scenario's own values times a factor, or a distance from its
// wall; all others stand for themselves. The same seed and scenario give the same case.
//
// Around a scenario that was fitted to recordings each case has an arm that these leave
// possible (src/scenario/fitted_arm.h), of which the law is told the fitted one, and no
// other error of the arm.
drawn_case drawn_case_of(const scenario *around, uint64_t seed);

// The scenario of a case. It borrows all but its parameters and actions from `base`; the
// actions, those of the base and the push if there is one and `pushed` asks for it, lie
// in actions[base->action_count + 1] in the order of time. The run lasts
// DRAWN_CASE_DURATION at least. STATUS_BAD_ARGUMENT with a sentence if a setting does not
// go with the scenario.
#define DRAWN_CASE_DURATION 2.0 // [s]
status drawn_case_scenario(scenario *derived, const scenario *base, const drawn_case *c,
                           bool pushed, action *actions, fault *f);

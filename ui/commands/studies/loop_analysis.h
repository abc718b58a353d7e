// Poles, zeros and margins of one arm near rest, for the command linear.
#pragma once

#include "src/scenario/scenario.h"
#include "src/study/linear/linear.h"
#include "ui/commands/options.h"

// Linearises the arm of the scenario at a place of rest, with --law in its loop, and
// writes what is asked for. `place_name` is the word of --at. Returns the exit status.
int analyse_and_report(const arguments *a, const scenario *s, linear_place place,
                       const char *place_name);

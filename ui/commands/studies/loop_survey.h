// Where the loop of a control law is stable over varied parameters, for the command
// linear.
#pragma once

#include "src/scenario/scenario.h"
#include "src/study/linear/linear.h"
#include "ui/commands/options.h"

// Asks of each combination of the values of --vary whether its loop is stable, by its
// poles and by a run, and writes what is asked for. `place_name` is the word of --at.
// Returns the exit status.
int survey_and_report(const arguments *a, const scenario *s, linear_place place,
                      const char *place_name);

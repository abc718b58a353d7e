// impactlab robust --draw: control laws in cases that nobody chose.
#pragma once

#include "ui/commands/command.h"

// Examines laws (control_law) around a scenario, in as many cases as --draw says, and
// writes what was asked for. Returns the exit status.
int robust_exam(const arguments *a, const scenario *s, const int *laws, int law_count);

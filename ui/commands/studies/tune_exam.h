// impactlab tune --draw: the numbers of a law, found on an exam (law_exam.h).
#pragma once

#include "ui/commands/command.h"

// Searches, judges what was found on cases that the search did not see, and reports both.
// Returns the exit status.
int tune_over_exam(const arguments *a, const scenario *s);

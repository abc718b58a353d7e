// The program, whichever way it was started.
#pragma once

#include "src/study/ranks.h"

// Carries out what argv asks for, alone (ranks NULL) or as one of several processes that do so
// together. Returns the exit status. Sets up signals and the locale of the whole process.
int program_run(int argc, char **argv, const rank_group *ranks);

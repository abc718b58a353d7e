// The program, common to all executables.
#pragma once

#include "src/study/pool_ranks.h"

// Executes the command in argv, alone (ranks NULL) or as one of several cooperating processes.
// Returns the exit status. Sets up signals and the locale of the whole process.
int program_run(int argc, char **argv, const rank_group *ranks);

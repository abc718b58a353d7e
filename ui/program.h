// The program as its tests call it, too.
#pragma once

// Executes the command in argv. Returns the exit status. Sets up signals and the locale of the
// whole process.
int program_run(int argc, char **argv);

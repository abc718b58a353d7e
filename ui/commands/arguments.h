// Reads the command line by the rows of a command's options.
#pragma once

#include <stdbool.h>

#include "ui/commands/options.h"

// Reads argv (argv[0] is the command's name) by the rows of options of a->command, which
// may stand before or after the operands, and checks each value by its row; a->commands
// are all there are, the rest of `a` is zero. True with `a` filled, to be freed by
// arguments_finish; false if the command ends here, with the exit status in *exit_status:
// EXIT_DONE if help was asked for, else that of what was wrong, which has been reported.
bool arguments_read(arguments *a, int argc, char **argv, int *exit_status);
void arguments_finish(arguments *a);

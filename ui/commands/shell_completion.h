// What shells need to complete impactlab's command line, from the tables of commands,
// options, parameters and quantities. The names of scenarios are asked of the program
// when they are wanted.
#pragma once

#include <stdio.h>

#include "ui/commands/command.h"

// Writes the completions for "bash", "zsh" or "fish".
void write_completion(FILE *stream, const command_list *all, const char *shell);

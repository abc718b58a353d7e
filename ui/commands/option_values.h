// Values of options on the command line: checked by the rows of the options and stored.
#pragma once

#include "ui/commands/command.h"

// The place of an option's value in the arguments.
void *option_place(const arguments *a, const option_row *o);

// Checks a value by its row and stores it; lists have room for it. Returns EXIT_DONE, or reports
// what is wrong and returns EXIT_BAD_ARGUMENTS.
int option_store(arguments *a, const option_row *o, char *text);

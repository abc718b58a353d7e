// The lab on the terminal. The row of its command stands apart (lab.c), as the program without the
// rendering libraries has only that.
#pragma once

#include "ui/commands/command.h"

// Opens the lab with the scenario named, shows it live until it is left, or prints its screen where
// --keys, --script or --size ask for that. Returns the exit status.
int explore(const arguments *a);

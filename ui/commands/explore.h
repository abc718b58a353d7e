// The lab on the terminal. Its entry in the table of commands is in lab.c, because the program
// without the rendering libraries contains only that.
#pragma once

#include "ui/commands/command.h"

// Opens the lab with the named scenario and runs it until the user leaves; with --keys, --script or
// --size it prints the screen instead. Returns the exit status.
int explore(const arguments *a);

// The table of all commands, for the program and the tests. A command that needs the
// others finds them in its arguments.
#pragma once

#include "ui/commands/command.h"

extern const command_list command_table; // by group
extern const command lab_command;        // the command of impactlab if none is named

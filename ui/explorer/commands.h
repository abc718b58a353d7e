// Executes commands: lines typed after `:`, of scripts, of keys and of the settings.
#pragma once

#include "ui/explorer/explorer.h"

// Executes a line; an empty one or a comment does nothing. The result's `at` counts from the
// beginning of the line.
action_result explorer_execute(explorer_state *st, const char *line);

// The same, with the result's message shown on the message line. False if it failed.
bool explorer_carry_out(explorer *ex, const char *line);

// Done if the line begins with a command; otherwise refused, naming the most similar command.
action_result explorer_check_command(const char *line);

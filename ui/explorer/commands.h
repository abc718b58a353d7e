// Carrying out commands: lines of `:`, of scripts, of keys and of the settings.
#pragma once

#include "ui/explorer/explorer.h"

// Carries a line out; an empty one or a comment does nothing. The result's `at` counts from the
// line's beginning.
action_result explorer_execute(explorer_state *st, const char *line);

// The same, with what the result says on the message line. False if it failed.
bool explorer_carry_out(explorer *ex, const char *line);

// Done if a line begins with a command; refused, with the one that was probably meant, if not.
action_result explorer_check_command(const char *line);

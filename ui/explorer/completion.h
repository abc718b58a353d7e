// Completion of the input at the prompt.
#pragma once

#include "ui/explorer/actions/result.h"
#include "ui/explorer/state/state.h"

// Completes the prompt's last word as far as all candidates agree and lists them if there are
// several; called again it cycles through them.
action_result complete_prompt(explorer_state *st);

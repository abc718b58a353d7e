// Completion of what is typed at the prompt.
#pragma once

#include "ui/explorer/actions/result.h"
#include "ui/explorer/state/state.h"

// Completes the prompt's last word as far as its candidates agree and lists them if they are
// several; asked again it goes through them.
action_result complete_prompt(explorer_state *st);

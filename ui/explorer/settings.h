// What the explorer remembers between visits: a file of its own commands in the user's
// configuration folder.
#pragma once

#include "ui/explorer/explorer.h"

// Carries the settings file's commands out, if there is one. Faults are told on the message line
// and ignored.
void explorer_load_settings(explorer *ex);

// The explorer's settings: a file of its own commands in the user's configuration folder.
#pragma once

#include "ui/explorer/explorer.h"

// Executes the commands of the settings file, if there is one. Faulty lines are reported on the
// message line and ignored.
void explorer_load_settings(explorer *ex);

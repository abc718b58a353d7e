// Finds the panel under the mouse and passes the gesture to it.
#pragma once

#include "ui/explorer/explorer.h"

// Handles an event of the mouse.
void explorer_point(explorer *ex, pointer_event e);

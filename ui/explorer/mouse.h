// What the mouse does: it finds the panel that is pointed at and gives it the gesture.
#pragma once

#include "ui/explorer/explorer.h"

// The mouse did something.
void explorer_point(explorer *ex, pointer_event e);

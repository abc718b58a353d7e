// The explicit formula that engines are checked against: it knows no series and no modes,
// takes all arms and walls, and steps again for all that happens within a step.
#pragma once

#include "src/contact/engine.h"

extern const engine explicit_engine;

// The same in steps at most half as long, which follow the fastest decays as closely as
// vibrations.
extern const engine explicit_fine_engine;

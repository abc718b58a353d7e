// The built-in control laws. Each is written against src/rig/controller.h and nothing else of the
// rig; docs/control.md says where each comes from.
#pragma once

#include "src/quantities/control_laws.h"
#include "src/rig/controller.h"

// hybrid_law and so on, one for each in the list
#define LAW(name, prefix, word, description) extern const controller prefix##_law;
CONTROL_LAWS(LAW)
#undef LAW

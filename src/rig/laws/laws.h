// The built-in control laws. Each is written against src/rig/controller.h and
// src/rig/laws/law_parts.h and nothing else of the rig (tests/law_alone.c holds the laws
// without the lab). The start of `observer` alone needs the modes of an arm
// (src/arm/modes.h), and memory for the moment. docs/explanation/control-design.md says
// where each comes from.
#pragma once

#include "src/rig/controller.h"
#include "src/tables/control_laws.h"

// hybrid_law and so on, one for each in the list
#define LAW(name, prefix, ...) extern const controller prefix##_law;
CONTROL_LAWS(LAW)
#undef LAW

// The built-in control laws. Each is written against src/rig/controller.h and nothing else of the
// rig. Between its start and its end a law needs nothing of the lab: no file, no allocation, no
// table of parameters; what a sample computes with stands in its memory and in the values of its
// setup (tests/law_alone.c holds the laws without the lab). The start of `observer` alone needs the
// modes of an arm (src/arm/modes.h), and memory for the moment. docs/explanation/control-design.md
// says where each comes from.
#pragma once

#include <stddef.h>

#include "src/tables/control_laws.h"
#include "src/rig/controller.h"

// A controller: its word, names of modes, table of parameters, type of memory, and its functions
// and whatever else it has as .start = ..., .sample = ....
#define CONTROLLER_LAW(law, names, table, memory, ...)                                             \
    {                                                                                              \
        .interface = CONTROLLER_INTERFACE, .name = law, .modes = names, .parameters = table,       \
        .parameter_count = (int)(sizeof table / sizeof table[0]), .memory_size = sizeof(memory),   \
        __VA_ARGS__                                                                                \
    }

// What a law keeps of its setup: all but where the rig's values lie, because its memory may be put
// into another loop's.
static inline controller_setup setup_kept(const controller_setup *setup)
{
    controller_setup kept = *setup;
    kept.parameters = NULL;
    return kept;
}

// Coulomb friction of a hub that moves at a rate [rad/s] [N m].
static inline double coulomb_friction(const controller_setup *setup, double rate)
{
    return rate > 0 ? setup->stiction : rate < 0 ? -setup->stiction : 0;
}

// hybrid_law and so on, one for each in the list
#define LAW(name, prefix, word, description) extern const controller prefix##_law;
CONTROL_LAWS(LAW)
#undef LAW

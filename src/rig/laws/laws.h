// The built-in control laws. Each is written against src/rig/controller.h and nothing else of the
// rig; docs/control.md says where each comes from.
#pragma once

#include "src/rig/controller.h"

extern const controller open_loop_law, hybrid_law, force_pd_law, force_integral_law,
    reverse_torque_law, speed_limit_law, bang_bang_law, discontinuous_law, recovering_law,
    optimal_law, predictive_law, inverse_dynamics_law;

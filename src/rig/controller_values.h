// The values of a controller's parameters: from the scenario's control.* and
// control.settings.
#pragma once

#include "src/base/fault.h"
#include "src/tables/parameters.h"
#include "src/rig/controller.h"

// What is known of parameter `index` of a controller. One of which the controller gives
// the name alone is a parameter of the scenario, control.NAME: unit, range, description
// and default stand in the parameter table.
controller_parameter controller_parameter_at(const controller *law, int index);

// Fills values[law->parameter_count], in the order of the controller's parameters, each
// from the first of these that gives one: control.settings; control.NAME, where the
// scenario set it; the controller's initial value, or the default of control.NAME where
// the controller gives the name alone. STATUS_BAD_SCENARIO, with a sentence in f, on a
// setting that the controller does not have or a value out of its range.
status controller_values(const controller *law, const parameters *p, double *values,
                         fault *f);

// A controller with one mode; whatever else it has as .tune = ....
#define ONE_MODE_CONTROLLER(title, mode, memory, samples, ...)                           \
    {                                                                                    \
        .interface = CONTROLLER_INTERFACE, .name = title,                                \
        .modes = (const char *const[]){mode, NULL}, .memory_size = memory,               \
        .sample = samples, __VA_ARGS__                                                   \
    }

// A controller's `start` or `tune` that takes whatever it is told.
const char *controller_takes_anything(void *memory, const controller_setup *setup);

// Index of the controller's parameter of that name, -1 if it has none.
int controller_find_parameter(const controller *law, const char *name);

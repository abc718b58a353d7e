// A controller that was compiled with the header of an earlier version of the interface.
#include "src/rig/controller.h"

static void sample(void *memory, const controller_input *input, controller_output *output)
{
    (void)memory;
    output->command = input->voltage;
}

static const controller outdated = {.interface = CONTROLLER_INTERFACE - 1,
                                    .name = "outdated",
                                    .sample = sample};

const controller *impactlab_controller(void);

const controller *impactlab_controller(void)
{
    return &outdated;
}

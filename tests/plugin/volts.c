// A controller that commands VOLTS at every sample.
#include "src/rig/controller.h"

static void sample(void *memory, const controller_input *input, controller_output *output)
{
    (void)memory;
    (void)input;
    output->command = VOLTS;
}

static const controller volts = {.interface = CONTROLLER_INTERFACE,
                                 .name = "volts",
                                 .modes = (const char *const[]){"on", NULL},
                                 .sample = sample};

const controller *impactlab_controller(void);

const controller *impactlab_controller(void)
{
    return &volts;
}

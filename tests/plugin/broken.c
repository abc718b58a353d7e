// A controller that divides by zero after a while.
#include "src/rig/controller.h"

static void sample(void *memory, const controller_input *input, controller_output *output)
{
    double *zero = memory;
    output->command = input->time < 0.0999 ? 1 : *zero / *zero;
}

static const controller broken = {.interface = CONTROLLER_INTERFACE,
                                  .name = "broken",
                                  .memory_size = sizeof(double),
                                  .sample = sample};

const controller *impactlab_controller(void);

const controller *impactlab_controller(void)
{
    return &broken;
}

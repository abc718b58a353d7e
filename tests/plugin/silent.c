// A controller without an answer at a sample.
#include "src/rig/controller.h"

static const controller silent = {.interface = CONTROLLER_INTERFACE, .name = "silent"};

const controller *impactlab_controller(void);

const controller *impactlab_controller(void)
{
    return &silent;
}

// A controller as a plug-in: control.law: plugin, control.plugin: ./soft_push.so
//
//     cc -std=c17 -shared -fPIC -o soft_push.so soft_push.c $(pkg-config --cflags
//     impactlab)
#include <impactlab/controller.h>

typedef struct memory {
    double wanted, gain;
} memory;

static const char *start(void *m, const controller_setup *setup)
{
    *(memory *)m = (memory){.wanted = setup->parameters[0], .gain = setup->parameters[1]};
    return NULL;
}

static void sample(void *m, const controller_input *in, controller_output *out)
{
    const memory *own = m;
    out->command = 1 + 0.3 * (0.1 - in->encoder) + own->gain * (own->wanted - in->force);
    out->calculated_force = in->force;
}

static const controller_parameter parameters[] = {
    {.name = "force"}, // unit, range and default are those of control.force
    {.name = "gain",
     .unit = "V/N",
     .initial = 0.1,
     .minimum = 0,
     .maximum = 10,
     .description = "gain of the force error"},
};
static const char *const modes[] = {"push", NULL};
static const controller soft_push = {.interface = CONTROLLER_INTERFACE,
                                     .name = "soft-push",
                                     .modes = modes,
                                     .parameters = parameters,
                                     .parameter_count = 2,
                                     .memory_size = sizeof(memory),
                                     .start = start,
                                     .sample = sample};

const controller *impactlab_controller(void);
const controller *impactlab_controller(void)
{
    return &soft_push;
}

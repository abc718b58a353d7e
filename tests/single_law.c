// A law that was exported in single precision as a plug-in of the lab, which computes in
// double: it is told the same, reads the same and answers in single precision.
//
//     impactlab export SCENARIO --float -o DIR
//     cc -std=c17 -shared -fPIC -IDIR -I. -DLAW=touch_law -o single.so tests/single_law.c
//     -lm

// the names of the interface in single precision, beside the lab's own
#define CONTROLLER_INTERFACE SINGLE_INTERFACE
#define controller           single_controller
#define controller_entry     single_entry
#define controller_input     single_input
#define controller_output    single_output
#define controller_parameter single_parameter
#define controller_setup     single_setup
#include "law.c"
#undef CONTROLLER_INTERFACE
#undef CONTROLLER_ENTRY
#undef controller
#undef controller_entry
#undef controller_input
#undef controller_output
#undef controller_parameter
#undef controller_setup

#include <stdalign.h>

#include "src/rig/controller.h"

typedef struct single_memory {
    float parameters[LAW_PARAMETERS];
    alignas(max_align_t) char law[]; // what the law remembers
} single_memory;

// What the lab tells, in single precision. Its parameters stay in the memory.
static single_setup in_single(single_memory *m, const controller_setup *s)
{
    for (int i = 0; i < LAW_PARAMETERS; i++) {
        m->parameters[i] = (float)s->parameters[i];
    }
    return (single_setup){.period = (float)s->period,
                          .delay = (float)s->delay,
                          .voltage_limit = (float)s->voltage_limit,
                          .torque_per_volt = (float)s->torque_per_volt,
                          .hub_damping = (float)s->hub_damping,
                          .stiction = (float)s->stiction,
                          .hub_inertia = (float)s->hub_inertia,
                          .link_mass = (float)s->link_mass,
                          .link_length = (float)s->link_length,
                          .link_inertia = (float)s->link_inertia,
                          .k2 = (float)s->k2,
                          .wall_angle = (float)s->wall_angle,
                          .links = s->links,
                          .hub_spring = (float)s->hub_spring,
                          .damping_ratio = (float)s->damping_ratio,
                          .parameters = m->parameters};
}

static const char *start(void *memory, const controller_setup *setup)
{
    single_memory *m = memory;
    const single_setup told = in_single(m, setup);
    return LAW.start(m->law, &told);
}

static const char *tune_again(void *memory, const controller_setup *setup)
{
    single_memory *m = memory;
    const single_setup told = in_single(m, setup);
    return LAW.tune(m->law, &told);
}

static void answer(void *memory, const controller_input *in, controller_output *out)
{
    single_memory *m = memory;
    const single_input read = {.time = (float)in->time,
                               .encoder = (float)in->encoder,
                               .tachometer = (float)in->tachometer,
                               .force = (float)in->force,
                               .voltage = (float)in->voltage,
                               .piezo_force = (float)in->piezo_force,
                               .film = (float)in->film,
                               .accelerometer = (float)in->accelerometer,
                               .wanted_mode = in->wanted_mode,
                               .predicted_force = (float)in->predicted_force};
    single_output given = {0};
    LAW.sample(m->law, &read, &given);
    out->command = (double)given.command;
    out->mode = given.mode;
}

const controller *impactlab_controller(void);
const controller *impactlab_controller(void)
{
    static controller_parameter parameters[LAW_PARAMETERS];
    static controller law = {.interface = CONTROLLER_INTERFACE,
                             .parameters = parameters,
                             .parameter_count = LAW_PARAMETERS,
                             .start = start,
                             .sample = answer,
                             .tune = tune_again};
    for (int i = 0; i < LAW_PARAMETERS; i++) {
        const single_parameter *p = &LAW.parameters[i];
        parameters[i] = (controller_parameter){.name = p->name,
                                               .unit = p->unit,
                                               .initial = (double)p->initial,
                                               .minimum = (double)p->minimum,
                                               .maximum = (double)p->maximum,
                                               .description = p->description};
    }
    law.name = LAW.name;
    law.modes = LAW.modes;
    law.memory_size = sizeof(single_memory) + LAW.memory_size;
    return &law;
}

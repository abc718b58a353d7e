// A controller of one's own, complete: after contact the command rises slowly from a part
// of the static one to all of it, with damping from the tachometer.
// docs/howto/controller.md is about such.
#include <math.h>

#include "src/rig/controller.h"

enum { APPROACH, PUSH };
static const char *const modes[] = {"approach", "push", NULL};

enum { FORCE, APPROACH_VOLTAGE, RISE_TIME, DAMPING, PARAMETERS };
static const controller_parameter parameters[PARAMETERS] = {
    {"force", "N", 1, 0, 10, "wanted contact force"},
    {"approach_voltage", "V", 1, -10, 10, "constant command of the approach"},
    {"rise_time", "s", 0.2, 1e-3, 10, "time constant with which the command rises"},
    {"damping", "N m s/rad", 0.5, 0, 100, "damping torque per hub velocity"},
};

typedef struct soft_push {
    controller_setup rig;
    double force, approach_voltage, rise_time, damping;
    int mode;
    double touch_time;
} soft_push;

static const char *start(void *memory, const controller_setup *setup)
{
    soft_push *c = memory;
    c->rig = *setup;
    c->force = setup->parameters[FORCE];
    c->approach_voltage = setup->parameters[APPROACH_VOLTAGE];
    c->rise_time = setup->parameters[RISE_TIME];
    c->damping = setup->parameters[DAMPING];
    return setup->torque_per_volt > 0 ? NULL : "the motor gives no torque";
}

static void sample(void *memory, const controller_input *input, controller_output *output)
{
    soft_push *c = memory;
    // held in a mode, or free to choose: contact means to push from then on
    int mode = c->mode == PUSH || input->force > 0.05 ? PUSH : APPROACH;
    mode = input->wanted_mode >= 0 ? input->wanted_mode : mode;
    if (mode == PUSH && c->mode != PUSH) {
        c->touch_time = input->time;
    }
    output->mode = c->mode = mode;
    output->command = c->approach_voltage;
    if (mode == PUSH) {
        double share = 1 - 0.5 * exp(-(input->time - c->touch_time) / c->rise_time);
        double torque =
            share * 2 * c->force * c->rig.link_length - c->damping * input->tachometer;
        output->command = torque / c->rig.torque_per_volt;
    }
}

static const controller soft_push_controller = {
    .interface = CONTROLLER_INTERFACE,
    .name = "soft push",
    .modes = modes,
    .lockable = true,
    .parameters = parameters,
    .parameter_count = PARAMETERS,
    .memory_size = sizeof(soft_push),
    .start = start,
    .sample = sample,
};

const controller *impactlab_controller(void);

const controller *impactlab_controller(void)
{
    return &soft_push_controller;
}

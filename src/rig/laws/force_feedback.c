#include "src/rig/laws/force_feedback.h"

#include <assert.h>

const char *const force_feedback_modes[] = {"approach", "contact", NULL};

const controller_parameter force_feedback_parameters[PARAMETERS] = {
    [FORCE_WANTED] = {.name = "force"},
    [APPROACH_VOLTAGE] = {.name = "approach_voltage"},
    [KV] = {.name = "kv"},
    [THRESHOLD] = {.name = "contact_threshold"},
    [FORCE_GAIN] = {.name = "force_gain"},
    [INTEGRAL_GAIN] = {.name = "integral_gain"},
};

const char *force_feedback_tune(void *memory, const controller_setup *setup)
{
    assert(memory != NULL && setup != NULL && setup->parameters != NULL);
    force_memory *m = memory;
    m->rig = *setup;
    for (int i = 0; i < PARAMETERS; i++) {
        m->p[i] = setup->parameters[i];
    }
    return NULL;
}

const char *force_feedback_start(void *memory, const controller_setup *setup)
{
    force_memory *m = memory;
    const char *refusal = force_feedback_tune(memory, setup);
    m->integral = m->p[APPROACH_VOLTAGE];
    return refusal;
}

void force_feedback_choose_mode(force_memory *m, const controller_input *in)
{
    bool contact = m->mode == CONTACT || in->force > m->p[THRESHOLD];
    m->mode = in->wanted_mode >= 0 ? in->wanted_mode : contact ? CONTACT : APPROACH;
}

double force_feedback_command(const force_memory *m, const controller_input *in)
{
    double torque = 2 * m->p[FORCE_WANTED] * m->rig.link_length - m->p[KV] * in->tachometer;
    return torque / m->rig.torque_per_volt + m->p[FORCE_GAIN] * (m->p[FORCE_WANTED] - in->force);
}

// Until contact as the hybrid controller; then the largest command back for control.reverse_time;
// then its force mode.
#include "src/rig/laws/hybrid_modes.h"

static const controller_parameter parameters_of_law[] = {HYBRID_PARAMETERS,
                                                         {.name = "reverse_time"}};

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;

    // contact begins the pull back, its time ends it
    bool chooses = !hybrid_held(m, in);
    if (chooses && m->mode == APPROACH && in->force > m->threshold) {
        hybrid_begin(m, IMPACT, in);
    }
    if (chooses && m->mode == IMPACT && in->time - m->since >= m->own) {
        hybrid_begin(m, FORCE, in);
    }

    out->mode = m->mode;
    out->calculated_force = m->mode == APPROACH ? 0 : hybrid_calculated_force(m, in);
    out->command = m->mode == APPROACH ? m->approach_voltage
                   : m->mode == IMPACT ? -m->rig.voltage_limit
                                       : hybrid_force_command(m, in, out);
}

const controller reverse_torque_law =
    HYBRID_LAW("reverse-torque", hybrid_modes, parameters_of_law, hybrid_start_with_own, sample);

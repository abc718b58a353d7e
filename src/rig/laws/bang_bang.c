// Full command to control.switch_share of the way, full command back until the hub rests, then the
// plain approach and the hybrid controller.
#include "src/rig/laws/hybrid_modes.h"

static const controller_parameter parameters_of_law[] = {HYBRID_PARAMETERS,
                                                         {.name = "switch_share"}};

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    double limit = m->rig.voltage_limit, approach = limit;

    // the way is measured from where the run begins
    if (!m->started) {
        m->started = true;
        m->start_angle = in->encoder;
    }

    // on the last part the command brakes until the arm stands, then it is the plain approach
    double gone = in->encoder - m->start_angle, way = m->rig.wall_angle - m->start_angle;
    if (gone >= m->own * way) {
        m->reversed = m->reversed || in->tachometer <= 0;
        approach = m->reversed ? m->approach_voltage : -limit;
    }
    out->command = hybrid_command(m, in, out, m->reversed ? m->approach_voltage : approach);
}

const controller bang_bang_law =
    HYBRID_LAW("bang-bang", hybrid_modes, parameters_of_law, hybrid_start_with_own, sample);

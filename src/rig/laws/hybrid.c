// The thesis's hybrid impact and force controller, 5.2 to 5.4: approach, impact mode, force mode.
#include "src/rig/laws/hybrid_modes.h"

static const controller_parameter parameters_of_law[] = {HYBRID_PARAMETERS};

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    out->command = hybrid_command(m, in, out, m->approach_voltage);
}

const controller hybrid_law =
    HYBRID_LAW("hybrid", hybrid_modes, parameters_of_law, hybrid_start, sample);

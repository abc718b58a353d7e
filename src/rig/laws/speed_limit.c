// The hybrid controller with the hub kept below control.speed_limit on the way to the wall.
#include <math.h>

#include "src/rig/laws/hybrid_modes.h"

static const controller_parameter parameters_of_law[] = {HYBRID_PARAMETERS,
                                                         {.name = "speed_limit"}};

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    double limited = fmin(m->approach_voltage, hybrid_speed_command(m, in, m->own));
    out->command = hybrid_command(m, in, out, limited);
}

const controller speed_limit_law =
    HYBRID_LAW("speed-limit", hybrid_modes, parameters_of_law, hybrid_start_with_own, sample);

// The controller that 5.4 calls ideal: hybrid, but going back to position control where contact is
// lost, and through the impact mode again when it returns.
#include <math.h>

#include "src/rig/laws/hybrid_modes.h"

static const char *const modes[] = {"approach", "impact", "force", "recover", NULL};

static const controller_parameter parameters_of_law[] = {HYBRID_PARAMETERS};

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    const int lost = 2; // readings without contact in a row
    m->readings_without_contact = in->force > m->threshold ? 0 : m->readings_without_contact + 1;
    bool pressing = m->mode == IMPACT || m->mode == FORCE;
    if (!hybrid_held(m, in) && pressing && m->readings_without_contact >= lost) {
        hybrid_begin(m, RECOVER, in);
    }
    // a slow move towards the angle at which the beam would press
    double speed = fmin(0.3, 5 * (hybrid_final_angle(m) - in->encoder));
    double approach = m->mode == RECOVER ? hybrid_speed_command(m, in, speed) : m->approach_voltage;
    out->command = hybrid_command(m, in, out, approach);
}

const controller recovering_law =
    HYBRID_LAW("recovering", modes, parameters_of_law, hybrid_start, sample);

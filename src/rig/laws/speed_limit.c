// The hybrid controller with the hub kept below control.speed_limit on the way to the wall and,
// where there is a control.force_limit, to speeds at which the impact that the rig predicts for a
// touch at this instant (predicted_force, (4.20)-(4.22)) keeps to it.
#include <math.h>

#include "src/rig/laws/hybrid_modes.h"

// Command for each newton that the predicted force is off its limit [V/N]. The prediction has the
// command in it, by the torque at the hub over the arm's length: less than half a newton a volt.
#define VOLTS_PER_NEWTON 1
// Share of the limit that the predicted force is held to: it takes the command in effect to stay,
// while the impact mode goes on along its plan and comes to press up to a fifth harder.
#define SHARE 0.8
// Speed at which a resting hub is taken, for the sign of its friction [rad/s].
#define CREEP 1e-3

enum { OWN_FORCE_LIMIT = OWN + 1 };
static const controller_parameter parameters_of_law[] = {
    HYBRID_PARAMETERS, {.name = "speed_limit"}, {.name = "force_limit"}};

// Keeps the present speed up and adds what the predicted force leaves.
static double force_limited_command(const hybrid_memory *m, const controller_input *in)
{
    const double left = SHARE * m->rig.parameters[OWN_FORCE_LIMIT] - in->predicted_force;
    return hybrid_speed_command(m, in, fmax(in->tachometer, CREEP)) + VOLTS_PER_NEWTON * left;
}

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    hybrid_memory *m = memory;
    double limited = fmin(m->approach_voltage, hybrid_speed_command(m, in, m->own));
    if (m->rig.parameters[OWN_FORCE_LIMIT] > 0 && isfinite(in->predicted_force)) {
        limited = fmin(limited, force_limited_command(m, in));
    }
    out->command = hybrid_command(m, in, out, limited);
}

const controller speed_limit_law =
    HYBRID_LAW("speed-limit", hybrid_modes, parameters_of_law, hybrid_start_with_own, sample);

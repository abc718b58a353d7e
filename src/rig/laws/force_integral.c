// Explicit integral force control (Youcef-Toumi and Gutz): from contact on the command is the
// integral of the force's error, u' = integral_gain (f - reading), which filters the impact's
// spikes.
#include <math.h>

#include "src/rig/laws/force_feedback.h"

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    force_feedback_choose_mode(m, in);

    // the integral is the command itself, so that modes join without a jump
    if (m->mode == APPROACH) {
        // after a release the present command continues
        m->integral = m->p[APPROACH_VOLTAGE];
    } else {
        double error = m->p[FORCE_WANTED] - in->force, limit = m->rig.voltage_limit;
        m->integral += m->p[INTEGRAL_GAIN] * error * m->rig.period;
        m->integral = fmax(-limit, fmin(m->integral, limit)); // no windup
    }
    out->mode = m->mode;
    out->command = m->integral;
}

const controller force_integral_law = FORCE_FEEDBACK_LAW("force-integral", true, sample);

// One law while the sensor feels the wall and another while it does not, without memory (after
// Mills): force feedback here, the plain approach there.
#include "src/rig/laws/force_feedback.h"

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    bool contact = in->wanted_mode >= 0 ? in->wanted_mode == CONTACT : in->force > m->p[THRESHOLD];
    out->mode = contact ? CONTACT : APPROACH;
    out->command = contact ? force_feedback_command(m, in) : m->p[APPROACH_VOLTAGE];
}

const controller discontinuous_law = FORCE_FEEDBACK_LAW("discontinuous", true, sample);

// Static torque of the wanted force with feedback of the force error and of the hub's velocity,
// once contact was felt.
#include "src/rig/laws/force_feedback.h"

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    force_feedback_choose_mode(m, in);
    out->mode = m->mode;
    out->command = m->mode == CONTACT ? force_feedback_command(m, in) : m->p[APPROACH_VOLTAGE];
}

const controller force_pd_law = FORCE_FEEDBACK_LAW("force-pd", true, sample);

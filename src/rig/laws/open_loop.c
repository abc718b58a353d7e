// The constant command of the approach, whatever the sensors read: figures 2.4 to 2.6.
#include "src/rig/laws/force_feedback.h"

static void sample(void *memory, const controller_input *in, controller_output *out)
{
    force_memory *m = memory;
    (void)in;
    out->command = m->p[APPROACH_VOLTAGE];
}

const controller open_loop_law = FORCE_FEEDBACK_LAW("open-loop", false, sample);

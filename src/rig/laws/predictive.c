// The optimal law behind an approach that keeps to control.force_limit wherever the wall is: were
// the tip to touch now, stopping would take at most that force.
#include "src/rig/laws/state_feedback.h"

static const controller_parameter parameters_of_law[] = {STATE_FEEDBACK_PARAMETERS,
                                                         {.name = "force_limit"}};

const controller predictive_law =
    STATE_FEEDBACK_LAW("predictive", parameters_of_law, state_feedback_start_with_limit);

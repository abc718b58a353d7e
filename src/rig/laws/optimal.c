// State feedback with an observer on the linearised arm, behind the plain approach.
#include "src/rig/laws/state_feedback.h"

static const controller_parameter parameters_of_law[] = {STATE_FEEDBACK_PARAMETERS};

const controller optimal_law =
    STATE_FEEDBACK_LAW("optimal", parameters_of_law, state_feedback_start);

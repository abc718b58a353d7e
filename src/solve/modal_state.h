// The state of a motion within a stride of the chain's modes (modal_stride.h), and its ledger.
#pragma once

#include "src/solve/modal_stride.h"
#include "src/solve/motion.h"

// Angles, velocities, what depends on them and the quadratures at h in (0, length] into `state`,
// whose slots of contact are set; in contact on the constraint. Returns the residual of the energy
// balance of the stride up to there, positive for energy gained [J]. Since the losses are integrals
// of the modes' motion itself, the residual measures the accuracy of the stride.
double modal_state_at(modal_stride *s, const arm *a, motion *m, double h, double *state);

// Growth of the gap from the stride's start to h [m], to full relative precision.
double modal_gap_change(modal_stride *s, const arm *a, motion *m, double h);

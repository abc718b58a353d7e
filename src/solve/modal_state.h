// The state of a motion within a stride of the chain's modes (modal_stride.h), and its ledger.
#pragma once

#include "src/solve/modal_stride.h"
#include "src/solve/motion.h"

// Angles, velocities, what depends on them and the quadratures at h in (0, length] into `state`,
// whose slots of contact are set; in contact on the constraint. Returns what the ledger of the
// stride until there leaves open: energy too much [J]. Losses being integrals of the modes' motion,
// that says how exact the stride is.
double modal_state_at(modal_stride *s, const arm *a, motion *m, double h, double *state);

// How much larger the gap is at h than at the stride's start [m], to its own digits.
double modal_gap_change(modal_stride *s, const arm *a, motion *m, double h);

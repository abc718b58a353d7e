// The state of a motion within a stride of the chain's modes (modal_stride.h), with a closed
// ledger.
//
// Modes that turn by more than MODAL_FAST in a stride vibrate in it as those of the straight chain
// do, undisturbed by how the chain is bent. The true ones give and take a share of about the square
// of the bend between neighbours, within a period and to and fro, which the exact energy of angles
// and velocities shows. What it lacks is restored by velocity along those vibrations, in the way of
// relaxation methods (Ketcheson, 2019): a share of 1e-4 of theirs as a rule. The engine asks for a
// shorter stride where it would be more than a little, and where no mode is fast the ledger is not
// touched: it then closes as well as the stride is exact.
#pragma once

#include "src/solve/modal_stride.h"
#include "src/solve/motion.h"

// The ledger at h within the stride [J].
typedef struct modal_ledger {
    double open;       // energy too much, before anything was restored
    double restorable; // the most that restoring would change little
    double restored;   // what was put back
} modal_ledger;

// Angles, velocities, what depends on them and the quadratures at h in (0, length] into `state`,
// whose slots of contact are set; in contact on the constraint.
modal_ledger modal_state_at(modal_stride *s, const arm *a, motion *m, double h, double *state);

// The gap at h [m].
double modal_gap_at(modal_stride *s, const arm *a, motion *m, double h);

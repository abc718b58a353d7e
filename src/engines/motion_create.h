// Motions of an arm by the engine that takes it, and their copies. Engines know nothing
// of it, nor does the contact machine.
#pragma once

#include "src/contact/motion.h"

extern const engine newmark_engine;           // implicit, stepping
extern const engine generalized_alpha_engine; // the same step with other coefficients

extern const engine taylor_engine; // power series of the two-link arm; dense
extern const engine stiff_engine;  // Radau IIA of seven stages for every arm; dense

// Whether the event method left alone integrates the arm with the power series of two
// links.
bool motion_suits_pair(const arm *a);

// Prepares a motion of the arm with the given method; all storage is allocated here. NULL
// if out of memory.
motion *motion_create(const arm *a, const method_parameters *method);

// The same with an engine of the event method chosen by the caller and kept even when the
// arm changes, so that engines can be compared. The engine must suit the arm.
motion *motion_create_by(const arm *a, const method_parameters *method,
                         const engine *chosen);
void motion_destroy(motion *m); // m may be NULL

// A motion as motion_create gives it, in the storage of a finished motion m if that fits
// (m may be NULL). m must not be used afterwards. NULL if out of memory.
motion *motion_renew(motion *m, const arm *a, const method_parameters *method);

// To be called after the arm's constants changed: the event method switches to the engine
// that motion_create would now choose, without a step in hand. If there is no memory for
// it, the next step fails with STATUS_NO_MEMORY.
void motion_follow_arm(const arm *a, motion *m);

// Bytes of a copy of state and record, of any engine that a changed arm may get.
size_t motion_saved_size(const motion *m);
// Copies state and record; what the state has no use of is zero.
void motion_save(const motion *m, void *bytes);
// Continues with a copy, with the arm as it was then: chooses its engine, and begins its
// step anew from what the state keeps of it.
void motion_restore(const arm *a, motion *m, const void *bytes);

// An implicit simulation of an arm and its wall that shares no code with the engines:
// dense equations of motion, Radau IIA of three stages, events located by shorter steps
// from the same start.
//
// It takes every arm of the corrected model and every wall, and follows what explicit
// formulas cannot: fast decays. Its cost grows with the cube of the number of links, so
// that some 24 are the most.
#pragma once

#include "tests/chain_outcome.h"

// The outcome of `start`, whose `by` is ignored, at a relative tolerance of the embedded
// formula of order 3; the result, of order 5, is far better. `status` is
// STATUS_NO_PROGRESS where steps become too short or too many.
chain_outcome implicit_outcome_of(const chain_start *start, double tolerance);

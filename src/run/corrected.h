// A run of the corrected arm.
#pragma once

#include "src/run/recording.h"

// Runs to the end, or as far as possible; f says why it ended early.
status run_corrected(recording *r, fault *f);

// A run of the printed arm.
#pragma once

#include "src/run/recording.h"

// Runs to the end, or as far as possible; f says why it ended early.
status run_printed(recording *r, fault *f);

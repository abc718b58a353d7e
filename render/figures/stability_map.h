// The map of section 3.1.3: how good the contact force is for every (beta, gamma) of Newmark's
// method, at several steps.
#pragma once

#include "render/figures/artwork.h"

// Runs the scenario for every pair on two threads and opens the map; the title is copied. Fails as
// a run of the scenario does.
status stability_map(const char *title, const figure_options *o, artwork *out, fault *f);

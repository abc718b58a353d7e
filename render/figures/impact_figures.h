// Figures of one impact: the arm's shape in contact, the force pulse, and what the thesis's
// predictors assume of the motion.
#pragma once

#include "render/figures/artwork.h"

// Opens figure 3.1, 4.3, 4.4, 4.5 or 4.6; the title is copied. Each has this form and runs its
// scenario; fails as that does.
status figure_contact(const char *title, const figure_options *o, artwork *out, fault *f);
status figure_force_profile(const char *title, const figure_options *o, artwork *out, fault *f);
status figure_linear_velocity(const char *title, const figure_options *o, artwork *out, fault *f);
status figure_quadratic_angle(const char *title, const figure_options *o, artwork *out, fault *f);
status figure_peak_shape(const char *title, const figure_options *o, artwork *out, fault *f);

// The thesis's tables as pages.
#pragma once

#include "render/figures/artwork.h"

// Opens table T2.1, T3.1, T3.2, T4.1, T4.2, T4.3 or their mean errors; the title is copied. Each
// has this form.
status table_motor(const char *title, const figure_options *o, artwork *out, fault *f);
status table_stability(const char *title, const figure_options *o, artwork *out, fault *f);
status table_algorithm(const char *title, const figure_options *o, artwork *out, fault *f);
status table_hundredfold(const char *title, const figure_options *o, artwork *out, fault *f);
status table_tenfold(const char *title, const figure_options *o, artwork *out, fault *f);
status table_errors(const char *title, const figure_options *o, artwork *out, fault *f);
status table_nominal(const char *title, const figure_options *o, artwork *out, fault *f);

// The thesis's diagrams, drawn from the model's own geometry and numbers.
#pragma once

#include "render/figures/artwork.h"

// Opens diagram 2.1, 2.2, 2.3, 4.1 or 4.2; the title is copied. Each has this form.
status diagram_sensor(const char *title, const figure_options *o, artwork *out, fault *f);
status diagram_links(const char *title, const figure_options *o, artwork *out, fault *f);
status diagram_free_bodies(const char *title, const figure_options *o, artwork *out, fault *f);
status diagram_springs(const char *title, const figure_options *o, artwork *out, fault *f);
status diagram_collision(const char *title, const figure_options *o, artwork *out, fault *f);

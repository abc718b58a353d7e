// The topics of impactlab study.
#pragma once

#include "ui/commands/pictures.h"

// Computes the study of the scenario, and prints and writes the requested results. Returns the exit
// status.
int study_of_methods(const arguments *a, scenario *s);
int study_of_sensor(const arguments *a, scenario *s);

// Draws a study's figure to --plot, panels side by side over one logarithmic axis, and its data
// beside it. Returns the exit status.
int publish_study(const arguments *a, figure *fig);

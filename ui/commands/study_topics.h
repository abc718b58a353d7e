// The topics of impactlab study.
#pragma once

#include "render/plot/figure_file.h"
#include "ui/commands/command.h"

// Computes the study of the scenario, and prints and writes what was asked for. Returns the exit
// status.
int study_of_methods(const arguments *a, scenario *s);
int study_of_sensor(const arguments *a, scenario *s);

// Writes a study's figure, panels side by side over one logarithmic axis, and its data beside it.
// `what` is the topic, for the file's metadata.
status write_study_figure(figure *fig, const scenario *s, const char *what, const char *path,
                          fault *f);

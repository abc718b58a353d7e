// modelDescription.xml of an FMU (FMI 2.0.5, section 2.2): what an importer reads.
#pragma once

#include <stdio.h>

#include "src/exchange/fmu/fmu_scenario.h"

// Whether a parameter is a variable of the FMU: not where it names a file or a program of
// this machine, has no value, or is run.duration, which the importer tells as stopTime.
bool fmu_shows_parameter(const parameters *p, int parameter);

// Writes it. inputs[i]: whether parameter i is an input, if it may change during a run;
// else it can be tuned. `identifier` names the binary, `sources` are the names of the
// files to be compiled.
void write_model_description(FILE *stream, const fmu_scenario *given, const bool *inputs,
                             const char *title, const char *identifier,
                             const char *const *sources, int source_count);

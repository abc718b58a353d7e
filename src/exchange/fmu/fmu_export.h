// A scenario as an FMU: model exchange between simulation tools by FMI 2.0,
// co-simulation.
//
// The archive has modelDescription.xml, the lab's own sources with the scenario as a
// table of values (sources/given.c), and for Linux on x86-64 a shared object that
// holds the same values.
#pragma once

#include "src/base/fault.h"
#include "src/exchange/fmu/fmu_scenario.h"

typedef struct fmu_export {
    fmu_scenario given;
    bool inputs[sizeof(((parameters *)0)->set)]; // which parameters are inputs
    const char *title;                           // borrowed from the scenario
    char identifier[FMU_TEXT];                   // a name of C: of the binary
    bool has_binary;                             // written by fmu_export_write
} fmu_export;

// Takes a scenario with the content of the files that it reads; *made is to be freed.
// `inputs`: the paths, with commas between, of the parameters that are inputs; NULL: all
// that may change during a run. STATUS_BAD_ARGUMENT if one of them may not;
// STATUS_BAD_SCENARIO where code of others is its law, or it has more actions or larger
// files than an FMU has room for; STATUS_CANNOT_READ; STATUS_NO_MEMORY.
status fmu_export_create(fmu_export **made, const scenario *s, const char *inputs,
                         fault *f);

// Writes the archive. Errors of writing stay in the stream; STATUS_NO_MEMORY.
status fmu_export_write(fmu_export *e, FILE *stream, fault *f);

// What an FMU runs: a block of values without addresses. `impactlab fmu` writes it as C
// among the sources, and as bytes into the binary.
#pragma once

#include "src/scenario/scenario.h"

enum {
    FMU_TEXT = 256,
    FMU_ACTIONS = 256,
    FMU_FILES = 2, // that one scenario reads at most
    FMU_FILE_BYTES = 1 << 18
};

// A file that the scenario reads, whole.
typedef struct fmu_file {
    char path[PARAMETER_TEXT_SIZE]; // as the parameter gives it
    size_t length;
    char bytes[FMU_FILE_BYTES];
} fmu_file;

typedef struct fmu_scenario {
    char guid[FMU_TEXT]; // as in modelDescription.xml; at first FMU_BLANK
    char name[FMU_TEXT];
    parameters parameters; // resolved
    int action_count;
    action actions[FMU_ACTIONS]; // sorted by time
    fmu_file files[FMU_FILES];
} fmu_scenario;

// The guid of the block in a binary that holds no scenario yet, by which it is found.
#define FMU_BLANK "impactlab: the scenario of an FMU goes here"

extern const fmu_scenario fmu_given;

// Value references. A parameter's is its place in the table, a signal's stands behind
// FMU_SIGNALS.
enum {
    FMU_SIGNALS = 1000,
    FMU_COMMANDED = 2000, // whether the importer commands the motor
    FMU_COMMAND,          // what it commands then [V]
    FMU_PUSH              // impulse at the tip [N s]
};

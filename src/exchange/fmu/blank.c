// The place of the scenario in the binary of an FMU; among the sources given.c stands
// for this file.
#include "src/exchange/fmu/fmu_scenario.h"

const fmu_scenario fmu_given = {.guid = FMU_BLANK};

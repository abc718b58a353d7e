// Parameters that have no effect on a run, and why.
#pragma once

#include "src/tables/parameters.h"

// Why a parameter has no effect on a run of these parameters: half a sentence; NULL if it has one.
const char *inert_reason(const parameters *p, int parameter);

// What tables say of the scenario they come from.
#pragma once

#include "src/exchange/parquet_file.h"
#include "src/scenario/scenario.h"

// Ends a Parquet file with the notes impactlab.version and impactlab.scenario.
void parquet_end_with_scenario(parquet_file *p, const scenario *s);

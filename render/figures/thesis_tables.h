// Tables 4.1 to 4.3, computed once for all pages that show them.
#pragma once

#include "src/study/thesis_tables.h"

// All rows, computed at the first call, on any thread; valid until the program ends. NULL with a
// reason if they cannot be computed.
const thesis_tables *computed_tables(fault *f);

// The row of a table ("4.1"), model ("printed") and quantity ("max_force_energy"), which must
// exist.
const table_row *computed_row(const thesis_tables *t, const char *table, const char *model,
                              const char *quantity);

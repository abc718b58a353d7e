// Tables 4.1-4.3 of the thesis: printed value, computed value, difference.
#pragma once

#include "src/tables/parameters.h"
#include "src/base/fault.h"

enum { TABLE_VOLTAGES = 4 };

typedef struct table_row {
    const char *table;    // "4.1"
    double k2_factor;     // times the nominal k2
    const char *model;    // "printed", "corrected" or "fitted"
    const char *quantity; // "max_force_energy", "max_force_dynamics",
                          // "max_force_simulation", "delay_dynamics", "delay_simulation"
    double printed[TABLE_VOLTAGES];  // what the thesis prints [N] or [s]
    double computed[TABLE_VOLTAGES]; // NaN where the quantity did not occur
} table_row;

typedef struct thesis_tables {
    double voltage[TABLE_VOLTAGES]; // [V]
    table_row rows[3 * 2 * 5];
    int row_count;
} thesis_tables;

// Computes all rows, for both models; on failure there are those until then.
status tables_compute(thesis_tables *t, fault *f);

// The closest reproduction of the delays in the tables, three rows of the model "fitted"
// for each of them (docs/explanation/thesis.md): force and delay of the simulation with
// seven numbers and switches of the printed model fitted to its 24 cells, the delay
// counted from the step before contact; and the printed model's delay of the impact
// dynamics times sqrt(3)/2, which takes its bias away and is not explained.
void tables_compute_fitted(thesis_tables *t);

// What the thesis prints at the four voltages, 1, 2, 5 and 10 V: values[TABLE_VOLTAGES]
// of a quantity of Table "4.1", "4.2" or "4.3" [N] or [s]. False if there is no such row.
bool tables_printed(const char *table, const char *quantity, double *values);

// Mean |relative error| over the 12 cells of one quantity of one model, NaN cells left
// out.
double tables_mean_error(const thesis_tables *t, const char *model, const char *quantity);

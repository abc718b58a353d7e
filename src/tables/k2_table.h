// The stiffness of the beam by the force it presses with: the look-up table of (5.26).
#pragma once

#include <stddef.h>

#include <stdbool.h>

#include "src/base/fault.h"

enum { K2_TABLE_MOST = 32 };

typedef struct k2_table {
    int count;
    double force[K2_TABLE_MOST]; // growing [N]
    double k2[K2_TABLE_MOST];    // [N m/rad]
} k2_table;

// Reads "FORCE:K2 FORCE:K2 ...", forces in N growing, K2 in N m/rad above zero, separated
// by blanks. An empty text gives a table without entries. STATUS_BAD_SCENARIO, with a
// sentence in f that names control.k2_table, if the text is no such table.
status k2_table_read(k2_table *t, const char *text, fault *f);

// Writes it in that form with four digits. False if it does not fit.
bool k2_table_write(const k2_table *t, char *text, size_t size);

// K2 at a force [N m/rad]: straight lines between the entries, and beyond the first and
// the last one their own value. The table has at least one entry.
double k2_table_at(const k2_table *t, double force);

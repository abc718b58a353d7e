// The rows of a sweep as Parquet: a row for each run, as in its CSV.
//
// The columns, their types and their order follow from the sweep alone, so that the files
// of its parts, in one folder, are one table. Missing quantities are nulls. The notes are
// those of a run's tables (run_tables.h), with the scenario that was varied.
//
//     sweep_table_begin -> sweep_store_rows with sweep_table_row -> sweep_table_end
#pragma once

#include <stdio.h>

#include "src/exchange/parquet_file.h"
#include "src/study/store/sweep_store.h"

typedef struct sweep_table {
    FILE *stream;
    parquet_file *file;
    parquet_column columns[SWEEP_COLUMNS];
    int count;
} sweep_table;

// Begins a table with these columns (sweep_store_columns), in the caller's storage, which
// stays in its place. STATUS_NO_MEMORY; then there is nothing to end. Errors of the
// stream stay in it.
status sweep_table_begin(sweep_table *t, FILE *stream, const result_column *columns,
                         int count) __attribute__((warn_unused_result));

// Adds a row: a sweep_row_taker, whose context is the table.
bool sweep_table_row(void *table, size_t run, const result_cell *cells);

// Ends the table of that scenario's sweep.
void sweep_table_end(sweep_table *t, const scenario *s);

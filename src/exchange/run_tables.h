// The rows of a run as tables for other programs, written while the run goes on: memory
// does not grow with rows.
//
//     run_tables_open -> run_tables_observe, the run -> run_tables_close
//
// All files have the same columns and rows. Parquet has the scenario, as a file that
// reads back, and the version of the program in its notes impactlab.scenario and
// impactlab.version, MAT in the texts `scenario` and `version`, and the units in the
// struct `units`.
#pragma once

#include "src/run/run.h"

typedef struct run_tables_order {
    const char *csv, *parquet, *mat; // files, "-": standard output; NULL: none
    const char *columns;             // "A,B" (run_columns.h), NULL: all
    double every;                    // rows every so often [s], 0: every recorded row
} run_tables_order;

typedef struct run_tables run_tables;

// Opens the files for a run of the scenario, which lives as long. *opened is NULL, with
// STATUS_OK, where no file is asked for. STATUS_BAD_ARGUMENT if `columns` names no
// columns of it, STATUS_CANNOT_WRITE, STATUS_NO_MEMORY.
status run_tables_open(run_tables **opened, const scenario *s,
                       const run_tables_order *order, fault *f)
    __attribute__((warn_unused_result));

// Lets the tables have the rows of the run that these options are for; NULL: nothing.
void run_tables_observe(run_tables *t, run_options *options);

// Ends the tables with the rows that came, puts each file in its place whole or not at
// all, and frees `t`, which may be NULL. Each file that could not be written is reported;
// returns the last one's code.
status run_tables_close(run_tables *t, fault_handler report, void *context);

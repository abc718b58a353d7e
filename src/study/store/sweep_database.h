// The database under a sweep's store: what its parts share.
#pragma once

#include <sqlite3.h>

#include "src/study/result_rows.h"
#include "src/study/sweep_run.h"
#include "src/study/sweep_definition.h"

// Marks a database as ours (PRAGMA application_id): "ILSw". The layout's version is
// user_version.
#define APPLICATION_ID "1229738871"
#define LAYOUT         "1"

// Of the table `run`: number of the run, then the varied values, status and message, then
// the quantities of the summary.
enum {
    RUN_FIRST_VALUE = 1,
    RUN_OUTCOME_COLUMNS = 2,
    RUN_MOST_COLUMNS =
        RUN_FIRST_VALUE + SWEEP_MOST_AXES + RUN_OUTCOME_COLUMNS + SUMMARY_NUMBERS
};

typedef struct run_column {
    result_column told; // its key is its name in the database
    const char *type;   // of SQLite
    const char *quote;  // round its name there; NULL: none
    bool timing;        // depends on the machine
} run_column;

typedef struct sweep_database {
    sweep_store store; // what others know of it
    const sweep *sweep;
    sqlite3 *database;
    sqlite3_stmt *insert;
    char *path;       // NULL: in memory
    const char *told; // the file that faults name; NULL: path
    int lock;         // descriptor that holds the lock, -1 if there is none
    bool in_transaction;
    char stamp[SHA256_TEXT]; // of what the runs read from outside
} sweep_database;

static inline sweep_database *database_of(sweep_store *store)
{
    return (sweep_database *)store; // its first member
}

// Opens the database file store->path, or memory where it is NULL, with SQLite's open
// flags. Whatever an untrusted file could execute (triggers, views, functions in a
// schema) is disabled.
status database_open(sweep_database *store, int flags, fault *f);

// True in *empty if the database holds nothing; STATUS_BAD_ARGUMENT if what it holds is
// no sweep of this program.
status database_recognise(sweep_database *store, bool *empty, fault *f);

// STATUS_BAD_ARGUMENT unless the table `run` has the columns of store->sweep, in their
// order, and in each row a run of it, once, with the values that the sweep gives it and
// finite numbers; counts them.
status database_check_runs(sweep_database *store, size_t *count, fault *f);

// The columns of the table `run` of a sweep; returns how many.
int database_columns(const sweep *s, run_column columns[RUN_MOST_COLUMNS]);

// What the database complains about, as a fault.
status database_fault(const sweep_database *store, fault *f);

// That the file is no longer where it was opened.
status database_moved_fault(const sweep_database *store, fault *f);

// Executes (statement NULL) or prepares the statement that was put together, NULL without
// memory.
status database_use(sweep_database *store, sqlite3_str *sql, sqlite3_stmt **statement,
                    fault *f);

// Executes statements that give no rows.
status database_execute(sweep_database *store, const char *sql, fault *f);

// Prepares a statement; the caller finalizes it, also on failure.
status database_prepare(sweep_database *store, sqlite3_stmt **statement, const char *sql,
                        fault *f);

// Steps to the next row of a prepared statement, as long as *code is STATUS_OK. At the
// end, which a fault of the database in *code may be, false: then the statement is
// finalized.
bool database_next(sweep_database *store, sqlite3_stmt *rows, status *code, fault *f);

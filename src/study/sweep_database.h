// The database under a sweep's store: what its parts share.
#pragma once

#include <sqlite3.h>

#include "src/base/sha256.h"
#include "src/study/sweep.h"

// Of the table `run`: number of the run, then the varied values, status and message, then the
// quantities of the summary.
enum { RUN_FIRST_VALUE = 1, RUN_OUTCOME_COLUMNS = 2 };

typedef struct sweep_store {
    const sweep *sweep;
    sqlite3 *database;
    sqlite3_stmt *insert;
    char *path; // NULL: in memory
    int lock;   // descriptor that holds the lock, -1 if there is none
    bool in_transaction;
    char stamp[SHA256_TEXT]; // of what the runs read from outside
} sweep_store;

// Opens the database file store->path, or memory where it is NULL, with SQLite's open flags.
// Whatever an untrusted file could execute (triggers, views, functions in a schema) is disabled.
status database_open(sweep_store *store, int flags, fault *f);

// True in *empty if the database holds nothing; STATUS_BAD_ARGUMENT if what it holds is no sweep of
// this program.
status database_recognise(sweep_store *store, bool *empty, fault *f);

// STATUS_BAD_ARGUMENT unless the table `run` has the columns of store->sweep, in their order, and
// in each row a run of it, once, with the values that the sweep gives it and finite numbers.
status database_check_runs(sweep_store *store, fault *f);

// Creates the tables `sweep` and `run` and marks the database as a sweep; in a transaction of the
// caller's.
status database_create_tables(sweep_store *store, fault *f);

// The statement that adds a row to `run`; the caller finalizes it.
status database_prepare_insert(sweep_store *store, sqlite3_stmt **insert, fault *f);

// What the database complains about, as a fault.
status database_fault(const sweep_store *store, fault *f);

// That the file is no longer where it was opened.
status database_moved_fault(const sweep_store *store, fault *f);

// Executes statements that give no rows.
status database_execute(sweep_store *store, const char *sql, fault *f);

// Prepares a statement; the caller finalizes it, also on failure.
status database_prepare(sweep_store *store, sqlite3_stmt **statement, const char *sql, fault *f);

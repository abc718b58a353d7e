// The results of a sweep, in an SQLite database: one row a run.
//
// Table `sweep` (key, value) holds what defines the sweep: version, scenario, sampling, seed, what
// is varied, every other parameter and the script. Table `run` has the number of the run from 1 as
// its primary key, the varied values under their paths, status ('ok', 'inaccurate' or 'failed'),
// message and all quantities of the summary (NULL: did not occur). Rows come in transactions: a
// program that is killed leaves the rows of the last commit, each of them once.
#pragma once

#include <stdio.h>

#include "src/study/sweep.h"

typedef struct sweep_store sweep_store;

// Opens the database of the sweep, or creates it. path NULL keeps everything in memory.
// STATUS_BAD_ARGUMENT if the file is something else or holds a sweep that is defined otherwise (f
// says in what they differ), STATUS_CANNOT_WRITE if it cannot be written or another sweep writes to
// it. `s` is borrowed and has to live as long as the store.
status sweep_store_open(sweep_store **store, const char *path, const sweep *s, fault *f);

// Commits what is not committed and closes; NULL is nothing. Errors are lost here: commit first.
void sweep_store_close(sweep_store *store);

// Makes what was put permanent. STATUS_CANNOT_WRITE also where the file was deleted or moved since.
status sweep_store_commit(sweep_store *store, fault *f);

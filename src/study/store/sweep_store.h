// The results of a sweep, in an SQLite database: one row a run.
//
// Table `sweep` (key, value) holds what defines the sweep: version, scenario, sampling,
// seed, what is varied, every other parameter and the script. Table `run` has the number
// of the run from 1 as its primary key, the varied values under their paths, status
// ('ok', 'inaccurate' or 'failed'), message and all quantities of the summary (NULL: did
// not occur). Rows come in transactions: a program that is killed leaves the rows of the
// last commit, each of them once.
#pragma once

#include <stdio.h>

#include "src/study/result_rows.h"
#include "src/study/sweep_run.h"

// Opens the database of the sweep, or creates it. path NULL keeps everything in memory.
// STATUS_BAD_ARGUMENT if the file is something else or holds a sweep that is defined
// otherwise (f says in what they differ), STATUS_CANNOT_WRITE if it cannot be written or
// another sweep writes to it. `s` is borrowed and has to live as long as the store.
status sweep_store_open(sweep_store **store, const char *path, const sweep *s, fault *f)
    __attribute__((warn_unused_result));

// Commits what is not committed and closes; NULL is nothing. An error is only noted
// (text_stream.h): commit first.
void sweep_store_close(sweep_store *store);
GIVEN_BACK(sweep_store, sweep_store_close)

// Makes what was put permanent. STATUS_CANNOT_WRITE also where the file was deleted or
// moved since.
status sweep_store_commit(sweep_store *store, fault *f)
    __attribute__((warn_unused_result));

// What the store of a sweep does (sweep_run.h): of one more row in the transaction, and
// of a quantity of a share, one by one or as a column.
status sweep_store_put(sweep_store *store, size_t run, const summary *result, fault *f)
    __attribute__((warn_unused_result));
status sweep_store_values(sweep_store *store, sweep_share share, const char *key,
                          sweep_value_taker *take, void *context, size_t *failed,
                          fault *f) __attribute__((warn_unused_result));
status sweep_store_quantity(sweep_store *store, sweep_share share, const char *key,
                            double *values, size_t *failed, fault *f)
    __attribute__((warn_unused_result));

// --- rows ------------------------------------------------------------------------------

// The most columns of a sweep's table.
enum { SWEEP_COLUMNS = 1 + SWEEP_MOST_AXES + 2 + SUMMARY_NUMBERS + 1 };

// The columns of a sweep's table, whichever of its runs are there: run, varied values,
// status, message, the quantities that do not depend on the machine and `without_effect`,
// the paths of values without effect: in a table of more than SWEEP_LOOKED_AT runs, of
// which not all are looked at, and where a value of some run has none. Returns how many.
enum { SWEEP_LOOKED_AT = 10000 };
int sweep_store_columns(const sweep *s, result_column columns[SWEEP_COLUMNS]);

// Takes a row of the table, a cell for each of its columns, of a run counted from 0;
// false: no other one is wanted.
typedef bool sweep_row_taker(void *context, size_t run, const result_cell *cells);

// Hands on the rows of a share in the order of the runs, with the columns that
// sweep_store_columns has given, columns[column_count]. STATUS_NO_MEMORY, or what is
// wrong with the database.
status sweep_store_rows(sweep_store *store, sweep_share share,
                        const result_column *columns, int column_count,
                        sweep_row_taker *take, void *context, fault *f)
    __attribute__((warn_unused_result));

// Writes all rows in the order of the runs. As CSV: run, varied values, status, message,
// then the quantities that do not depend on the machine; the header is name[unit]. As
// JSON: scenario, sampling, and in `runs` an object for each row under the keys of
// `impactlab run --json`, the varied values under their paths. Errors of the stream stay
// in it (ferror). STATUS_NO_MEMORY, or what is wrong with the database.
status sweep_store_write(sweep_store *store, FILE *stream, bool json, fault *f)
    __attribute__((warn_unused_result));

// --- databases of others ---

// Whether a file is the database of a sweep, of this build or another.
bool sweep_store_is(const char *path);

// What a merged sweep holds.
typedef struct sweep_merged {
    size_t runs;  // that are there
    size_t total; // of the sweep
} sweep_merged;

// Merges the databases of `count` > 0 parts into a new one at `output`, whole or not at
// all: the rows of all of them under their common definition, in any order.
// STATUS_BAD_ARGUMENT if a file is no sweep of this program, holds another sweep than the
// first, or a run that another part holds too; f says which.
status sweep_merge(char *const *files, int count, const char *output,
                   sweep_merged *merged, fault *f) __attribute__((warn_unused_result));

enum { SWEEP_TABLE_COLUMNS = 3 };

// Reads columns of the runs, by the keys of their headings (a parameter's path,
// "peak_force_N"), 1 to SWEEP_TABLE_COLUMNS of them, in ascending order of the first and
// then of the second. Runs without a number in one of them are left out. columns[0 ...
// key_count - 1] are to be freed; on failure they are NULL. STATUS_CANNOT_READ or
// STATUS_BAD_ARGUMENT with the path if the file is no sweep's database, has no such
// column, or something infinite in it.
status sweep_table_read(const char *path, const char *const *keys, int key_count,
                        double **columns, size_t *count, fault *f)
    __attribute__((warn_unused_result));

#include "src/study/store/sweep_database.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/input_file.h"
#include "src/tables/summary.h"

// Of a value or a row: what is stored is shorter, what a file may make up on reading need
// not be.
enum { MOST_BYTES = 16 << 20 };

status database_fault(const sweep_database *store, fault *f)
{
    int code = sqlite3_errcode(store->database) & 0xFF;
    const char *why = sqlite3_errmsg(store->database);
    const char *path = "the results in memory";
    if (store->told != NULL) {
        path = store->told;
    } else if (store->path != NULL) {
        path = store->path;
    }

    if (code == SQLITE_NOMEM) {
        return fault_no_memory(f);
    }
    FAULT_IF(code == SQLITE_NOTADB, f, STATUS_BAD_ARGUMENT, "'%s' is no SQLite database",
             path);
    FAULT_IF(code == SQLITE_CORRUPT, f, STATUS_CANNOT_READ, "'%s' is damaged: %s", path,
             why);

    // what is asked of it is always the same, so that tables of others are at fault
    FAULT_IF(code == SQLITE_ERROR || code == SQLITE_TOOBIG, f, STATUS_BAD_ARGUMENT,
             "'%s' is not laid out as this program does it: %s", path, why);
    FAULT_IF(code != SQLITE_READONLY && sqlite3_db_readonly(store->database, "main") == 1,
             f, STATUS_CANNOT_READ, "'%s' cannot be read: %s", path, why);
    if (sqlite3_extended_errcode(store->database) == SQLITE_READONLY_DBMOVED) {
        return database_moved_fault(store, f);
    }
    return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path, why);
}

status database_moved_fault(const sweep_database *store, fault *f)
{
    return fault_set(f, STATUS_CANNOT_WRITE,
                     "'%s' was deleted, moved or replaced while runs were added to it; "
                     "those since then are lost",
                     store->path);
}

status database_execute(sweep_database *store, const char *sql, fault *f)
{
    if (sqlite3_exec(store->database, sql, NULL, NULL, NULL) == SQLITE_OK) {
        return STATUS_OK;
    }
    return database_fault(store, f);
}

status database_prepare(sweep_database *store, sqlite3_stmt **statement, const char *sql,
                        fault *f)
{
    if (sqlite3_prepare_v2(store->database, sql, -1, statement, NULL) == SQLITE_OK) {
        return STATUS_OK;
    }
    return database_fault(store, f);
}

bool database_next(sweep_database *store, sqlite3_stmt *rows, status *code, fault *f)
{
    if (*code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        return true;
    }
    if (sqlite3_finalize(rows) != SQLITE_OK && *code == STATUS_OK) {
        *code = database_fault(store, f);
    }
    return false;
}

// The last number that a query gives, 0 if it gives none.
static status database_query_number(sweep_database *store, const char *sql,
                                    long long *number, fault *f)
{
    sqlite3_stmt *statement;
    *number = 0;
    status code = database_prepare(store, &statement, sql, f);
    while (database_next(store, statement, &code, f)) {
        *number = sqlite3_column_int64(statement, 0);
    }
    return code;
}

status database_recognise(sweep_database *store, bool *empty, fault *f)
{
    long long tables, mark = 0, layout = 0;
    TRY(database_query_number(store, "SELECT count(*) FROM sqlite_master", &tables, f));
    *empty = tables == 0;

    // one that holds something must hold a sweep
    TRY(database_query_number(store, "PRAGMA application_id", &mark, f));
    TRY(database_query_number(store, "PRAGMA user_version", &layout, f));
    if (!(*empty || (mark == atoll(APPLICATION_ID) && layout == atoll(LAYOUT)))) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is a database that holds no sweep of this program",
                         store->path);
    }
    return STATUS_OK;
}

int database_columns(const sweep *s, run_column columns[RUN_MOST_COLUMNS])
{
    int count = 0;
    columns[count++] =
        (run_column){{"run", "run", "", .kind = RESULT_COUNT}, "INTEGER PRIMARY KEY"};
    for (const sweep_axis *a = s->axes; a < s->axes + s->axis_count; a++) {
        const parameter_info *info = sweep_axis_parameter(a);
        const char *type = "REAL NOT NULL";
        result_kind kind = RESULT_NUMBER;
        if (sweep_axis_has_words(a)) {
            type = "TEXT NOT NULL";
            kind = RESULT_TEXT;
        } else if (info->type == PARAMETER_INTEGER) {
            type = "INTEGER NOT NULL";
            kind = RESULT_COUNT;
        }
        columns[count++] = (run_column){{a->name, a->name, info->unit, .kind = kind},
                                        type,
                                        .quote = "\""};
    }
    columns[count++] =
        (run_column){{"status", "status", "", .kind = RESULT_TEXT}, "TEXT NOT NULL"};
    columns[count++] =
        (run_column){{"message", "message", "", .kind = RESULT_TEXT}, "TEXT NOT NULL"};
    for (const summary_info *q = summary_table; q < summary_table + summary_count; q++) {
        columns[count++] =
            (run_column){{q->key, q->name, q->unit}, "REAL", "\"", q->timing};
    }
    return count;
}

status database_use(sweep_database *store, sqlite3_str *sql, sqlite3_stmt **statement,
                    fault *f)
{
    char *text = sqlite3_str_finish(sql);
    status code;
    if (text == NULL) {
        code = fault_no_memory(f);
    } else if (statement == NULL) {
        code = database_execute(store, text, f);
    } else {
        code = database_prepare(store, statement, text, f);
    }
    sqlite3_free(text);
    return code;
}

// The text in that column of the row that a statement stands on; NULL if there is none,
// one that does not end where it ends, or no memory for it.
static const char *text_at(sqlite3_stmt *row, int column)
{
    const char *text = NULL;
    if (sqlite3_column_type(row, column) == SQLITE_TEXT) {
        text = (const char *)sqlite3_column_text(row, column);
    }
    const bool whole =
        text != NULL && strlen(text) == (size_t)sqlite3_column_bytes(row, column);
    if (whole) {
        return text;
    }
    return NULL;
}

static bool is_number(sqlite3_stmt *row, int column)
{
    const int type = sqlite3_column_type(row, column);
    return type == SQLITE_FLOAT || type == SQLITE_INTEGER;
}

// Whether the row that a statement stands on has in that column what the sweep gives run
// `run`.
static bool is_value(const sweep *s, size_t run, int axis, sqlite3_stmt *row, int column)
{
    if (sweep_axis_has_words(&s->axes[axis])) {
        char text[SWEEP_VALUE_TEXT];
        const char *found = text_at(row, column);
        sweep_value_text(s, run, axis, text, sizeof text);
        return found != NULL && strcmp(found, text) == 0;
    }
    const double planned = sweep_value(s, run, axis);
    return is_number(row, column) &&
           (isnan(planned) || sqlite3_column_double(row, column) == planned);
}

// Whether that column, of the outcome, has what this program writes there: how the run
// ended, a message, finite numbers, and nothing where a quantity did not occur; what is
// counted always does in a run that did not fail.
static bool is_outcome(int word, bool failed, sqlite3_stmt *row, int column)
{
    const int quantity = word - RUN_OUTCOME_COLUMNS;
    if (quantity >= 0) {
        const bool counted = quantity == SUMMARY_INDEX(impacts) ||
                             quantity == SUMMARY_INDEX(separations) ||
                             quantity == SUMMARY_INDEX(steps);
        const bool always = summary_table[quantity].timing || (counted && !failed);
        return (!always && sqlite3_column_type(row, column) == SQLITE_NULL) ||
               (is_number(row, column) && isfinite(sqlite3_column_double(row, column)));
    }
    const char *text = text_at(row, column);
    return text != NULL &&
           (word > 0 || strcmp(text, "ok") == 0 || strcmp(text, "inaccurate") == 0 ||
            strcmp(text, "failed") == 0);
}

// Checks the row that a statement stands on, behind that of run *before: SQLite lets
// others write anything into any column.
static status check_row(const sweep_database *store, sqlite3_stmt *row, long long *before,
                        fault *f)
{
    const sweep *s = store->sweep;
    const long long run = sqlite3_column_int64(row, 0);
    FAULT_IF(sqlite3_column_type(row, 0) != SQLITE_INTEGER || run < 1 ||
                 (unsigned long long)run > s->run_count,
             f, STATUS_BAD_ARGUMENT, "'%s' holds run %lld of a sweep of %zu", store->path,
             run, s->run_count);
    FAULT_IF(run == *before, f, STATUS_BAD_ARGUMENT, "'%s' holds run %lld twice",
             store->path, run);
    *before = run;

    // what was put in, as planned
    int column = RUN_FIRST_VALUE;
    for (int i = 0; i < s->axis_count; i++, column++) {
        if (!is_value(s, (size_t)run - 1, i, row, column)) {
            const char *found = (const char *)sqlite3_column_text(row, column);
            char text[SWEEP_VALUE_TEXT];
            sweep_value_text(s, (size_t)run - 1, i, text, sizeof text);
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' has %s = %.60s in run %lld, expected %s", store->path,
                             s->axes[i].name, found != NULL ? found : "nothing", run,
                             text);
        }
    }

    // what came out
    const char *ended = text_at(row, column);
    const bool failed = ended != NULL && strcmp(ended, "failed") == 0;
    for (int i = 0; i < RUN_OUTCOME_COLUMNS + summary_count; i++, column++) {
        FAULT_IF(!is_outcome(i, failed, row, column), f, STATUS_BAD_ARGUMENT,
                 "'%s' has values of another kind in run %lld than this program writes, "
                 "under %s",
                 store->path, run, sqlite3_column_name(row, column));
    }
    return STATUS_OK;
}

// STATUS_BAD_ARGUMENT unless the runs have these columns and no others: another build has
// other results.
static status check_names(const sweep_database *store, sqlite3_stmt *rows,
                          const run_column *expected, int count, fault *f)
{
    const int found = sqlite3_column_count(rows);
    const char *lacks = NULL, *beyond = NULL;

    // what this build writes and the file lacks
    for (int i = 0; i < count && lacks == NULL; i++) {
        lacks = expected[i].told.key;
        for (int k = 0; k < found && lacks != NULL; k++) {
            const char *name = sqlite3_column_name(rows, k);
            if (name == NULL) {
                return fault_no_memory(f);
            }
            if (strcmp(name, lacks) == 0) {
                lacks = NULL;
            }
        }
    }

    // what the file has and this build does not write
    for (int k = 0; k < found && beyond == NULL; k++) {
        beyond = sqlite3_column_name(rows, k);
        for (int i = 0; i < count && beyond != NULL; i++) {
            if (strcmp(beyond, expected[i].told.key) == 0) {
                beyond = NULL;
            }
        }
    }
    if (lacks == NULL && beyond == NULL) {
        return STATUS_OK;
    }
    return fault_set(f, STATUS_BAD_ARGUMENT,
                     "'%.200s' was made by another build: its runs %s%.60s%s%s%.60s%s",
                     store->path, lacks != NULL ? "lack " : "",
                     lacks != NULL ? lacks : "",
                     lacks != NULL && beyond != NULL ? " and " : "",
                     beyond != NULL ? "have " : "", beyond != NULL ? beyond : "",
                     beyond != NULL ? ", which this one does not know" : "");
}

status database_check_runs(sweep_database *store, size_t *count, fault *f)
{
    run_column expected[RUN_MOST_COLUMNS];
    const int columns = database_columns(store->sweep, expected);
    sqlite3_stmt *rows;
    long long before = 0;
    *count = 0;
    status code = database_prepare(store, &rows, "SELECT * FROM run ORDER BY run", f);
    int found = 0;
    if (code == STATUS_OK) {
        found = sqlite3_column_count(rows);
    }

    if (code == STATUS_OK) {
        code = check_names(store, rows, expected, columns, f);
    }

    // in their order
    for (int i = 0; i < columns && code == STATUS_OK; i++) {
        const char *name = NULL;
        if (i < found) {
            name = sqlite3_column_name(rows, i);
        }
        if (name == NULL || strcmp(name, expected[i].told.key) != 0) {
            code = fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' has %.60s in column %d of its runs, expected %s",
                             store->path, name != NULL ? name : "nothing", i + 1,
                             expected[i].told.key);
        }
    }

    // row by row
    while (database_next(store, rows, &code, f)) {
        code = check_row(store, rows, &before, f);
        (*count)++;
        if (code != STATUS_OK && sqlite3_errcode(store->database) == SQLITE_NOMEM) {
            code = fault_no_memory(f);
        }
    }
    return code;
}

// --- opening ---

// A journal that an interrupted sweep left is rolled back, and one of a transaction over
// several databases then has SQLite delete the file it names at its end. This program
// makes no such one.
static status check_journal(const sweep_database *store, fault *f)
{
    static const unsigned char mark[] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7};
    unsigned char end[sizeof mark];
    const char *name =
        sqlite3_filename_journal(sqlite3_db_filename(store->database, "main"));
    FILE *journal = NULL;
    if (name != NULL) {
        journal = fopen(name, "rb");
    }
    if (journal == NULL) {
        return STATUS_OK;
    }

    // what SQLite looks for, and where
    const bool names_file = fseek(journal, -(long)sizeof mark, SEEK_END) == 0 &&
                            fread(end, sizeof end, 1, journal) == 1 &&
                            memcmp(end, mark, sizeof mark) == 0;
    fclose(journal);
    if (names_file) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is no journal of this program: it names another file, "
                         "which would be deleted; remove the journal, or do without '%s'",
                         name, store->path);
    }
    return STATUS_OK;
}

status database_open(sweep_database *store, int flags, fault *f)
{
    // a store is one thread's at a time: no locks round every value
    flags |= SQLITE_OPEN_NOMUTEX;
    if ((flags & SQLITE_OPEN_READONLY) != 0) {
        fault why = {0};
        FILE *file = input_file_open(store->path, &why);
        if (file == NULL) {
            return input_file_fault(store->path, &why, f);
        }
        fclose(file);
    }
    const char *name = store->path != NULL ? store->path : ":memory:";
    if (sqlite3_open_v2(name, &store->database, flags, NULL) != SQLITE_OK) {
        if (store->database == NULL) {
            return fault_no_memory(f);
        }
        return database_fault(store, f);
    }
    sqlite3_db_config(store->database, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    sqlite3_db_config(store->database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    sqlite3_db_config(store->database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
    sqlite3_db_config(store->database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, NULL);
    sqlite3_limit(store->database, SQLITE_LIMIT_LENGTH, MOST_BYTES);
    if (store->path != NULL) {
        return check_journal(store, f);
    }
    return STATUS_OK;
}

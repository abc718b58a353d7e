// The rows of a sweep's store: one for each run that was computed.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/json.h"
#include "src/study/result_rows.h"
#include "src/study/store/sweep_database.h"
#include "src/study/store/sweep_store.h"

static void bind_row(sweep_database *store, size_t run, const summary *result)
{
    const sweep *s = store->sweep;
    sqlite3_stmt *row = store->insert;
    int column = 1;

    // which run, under which values
    sqlite3_bind_int64(row, column++, (sqlite3_int64)run + 1);
    for (int i = 0; i < s->axis_count; i++) {
        if (sweep_axis_has_words(&s->axes[i])) {
            char text[SWEEP_VALUE_TEXT];
            sweep_value_text(s, run, i, text, sizeof text);
            sqlite3_bind_text(row, column++, text, -1, SQLITE_TRANSIENT);
        } else {
            sqlite3_bind_double(row, column++, sweep_value(s, run, i));
        }
    }

    // how it ended, and with what numbers
    sqlite3_bind_text(row, column++, summary_status(result), -1, SQLITE_STATIC);
    sqlite3_bind_text(row, column++, result->message, -1,
                      SQLITE_STATIC); // until the step
    for (int i = 0; i < summary_count; i++) {
        const double value = summary_value(result, i);
        if (isfinite(value)) {
            sqlite3_bind_double(row, column++, value);
        } else {
            sqlite3_bind_null(row, column++);
        }
    }
}

status sweep_store_put(sweep_store *of, size_t run, const summary *result, fault *f)
{
    sweep_database *store = database_of(of);
    assert(run < store->sweep->run_count);
    if (!store->in_transaction) {
        TRY(database_execute(store, "BEGIN IMMEDIATE", f));
        store->in_transaction = true;
    }

    // the row, within a transaction that is committed every now and then
    bind_row(store, run, result);
    const bool done = sqlite3_step(store->insert) == SQLITE_DONE;
    status code = STATUS_OK;
    if (!done) {
        code = database_fault(store, f);
    }
    sqlite3_reset(store->insert);
    of->present[run] |= done;
    of->count += done;
    return code;
}

status sweep_store_quantity(sweep_store *of, sweep_share share, const char *key,
                            double *values, size_t *failed, fault *f)
{
    sweep_database *store = database_of(of);
    const long long total = (long long)store->sweep->run_count;
    long long first = 1, step = 1;
    if (share.parts > 0) {
        first = share.part;
        step = share.parts;
    }
    size_t failures = 0;
    sqlite3_stmt *rows = NULL;

    for (size_t i = 0; i < sweep_share_count(share, store->sweep->run_count); i++) {
        values[i] = (double)NAN;
    }

    // the rows of a share are looked up one by one
    char *sql;
    if (share.parts == 0) {
        sql = sqlite3_mprintf("SELECT run, status, \"%w\" FROM run", key);
    } else {
        sql = sqlite3_mprintf(
            "WITH RECURSIVE part(n) AS (SELECT %lld UNION ALL SELECT n + %lld "
            "FROM part WHERE n + %lld <= %lld) "
            "SELECT run, status, \"%w\" FROM run WHERE run IN part",
            first, step, step, total, key);
    }

    // a run that failed, or has no such quantity, stays missing
    status code;
    if (sql) {
        code = database_prepare(store, &rows, sql, f);
    } else {
        code = fault_no_memory(f);
    }
    while (database_next(store, rows, &code, f)) {
        long long run = sqlite3_column_int64(rows, 0);
        const char *ended = (const char *)sqlite3_column_text(rows, 1);
        if (run < first || run > total || ended == NULL) {
            code = fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' holds a row that is no run of the sweep",
                             store->path ? store->path : "memory");
            continue;
        }
        bool ok = strcmp(ended, "failed") != 0;
        if (!ok) {
            failures++;
        }
        if (ok && sqlite3_column_type(rows, 2) != SQLITE_NULL) {
            values[(run - first) / step] = sqlite3_column_double(rows, 2);
        }
    }

    sqlite3_free(sql);
    if (failed != NULL) {
        *failed = failures;
    }
    return code;
}

// --- as files --------------------------------------------------------------------------

// Whether some run has an axis that idles, so that CSV needs a column for it.
static bool some_idle(const sweep *s)
{
    for (size_t i = 0; i < s->run_count * (size_t)s->axis_count; i++) {
        if (sweep_idle(s, i / (size_t)s->axis_count, (int)(i % (size_t)s->axis_count)) !=
            NULL) {
            return true;
        }
    }
    return false;
}

// Tells which values of a run have no effect: an object of JSON why, a row of CSV their
// paths.
static void write_idle(const sweep *s, size_t run, json_t *object, csv_writer *csv)
{
    char paths[SWEEP_MOST_AXES * SWEEP_NAME] = "";
    size_t length = 0;
    json_t *array = json_array();
    for (int i = 0; i < s->axis_count; i++) {
        const char *name = s->axes[i].name, *why = sweep_idle(s, run, i);
        if (why != NULL) {
            json_add(array, json_of("path:t why:t", name, why));
            length += (size_t)snprintf(paths + length, sizeof paths - length, "%s%s",
                                       length > 0 ? " " : "", name);
        }
    }

    if (csv != NULL) {
        csv_text(csv, paths);
    } else if (length > 0) {
        json_put(object, "without_effect", json_incref(array));
    }
    json_decref(array);
}

// The rows are read and written one by one, as there may be millions.
status sweep_store_write(sweep_store *of, FILE *stream, bool json, fault *f)
{
    sweep_database *store = database_of(of);
    sqlite3_stmt *rows;
    csv_writer csv = csv_begin(stream);
    run_column all[RUN_MOST_COLUMNS];
    result_column columns[RUN_MOST_COLUMNS];
    int at[RUN_MOST_COLUMNS], count = 0;
    const char *separator = "\n    ";
    TRY(database_prepare(store, &rows, "SELECT * FROM run ORDER BY run", f));

    const bool told_idle = !json && some_idle(store->sweep);

    // all columns but those that depend on the machine
    for (int i = 0, most = database_columns(store->sweep, all); i < most; i++) {
        if (!all[i].timing) {
            at[count] = i;
            columns[count++] = all[i].told;
        }
    }
    if (json) {
        json_t *name = json_text(store->sweep->base->name);
        fputs("{\n  \"scenario\": ", stream);
        json_write_member(stream, name, 1);
        fprintf(stream, ",\n  \"sampling\": \"%s\",\n  \"runs\": [",
                sweep_sampling_name(store->sweep->sampling));
        json_decref(name);
    } else {
        columns[count] = (result_column){"without_effect", "without_effect", ""};
        result_headings(&csv, columns, count + (told_idle ? 1 : 0));
    }
    while (sqlite3_step(rows) == SQLITE_ROW && !ferror(stream)) {
        json_t *object = NULL; // which loses whatever is put into it
        if (json) {
            object = json_object();
        }
        for (int k = 0; k < count; k++) {
            const int type = sqlite3_column_type(rows, at[k]);
            result_cell cell = {NULL, (double)NAN};
            if (type == SQLITE_TEXT) {
                cell = (result_cell){(const char *)sqlite3_column_text(rows, at[k]), 0};
            } else if (type != SQLITE_NULL) {
                cell.number = sqlite3_column_double(rows, at[k]);
            }
            if (json) {
                result_put(object, columns[k].key, cell);
            } else {
                result_field(&csv, cell);
            }
        }
        if (json || told_idle) {
            const size_t run = (size_t)sqlite3_column_int64(rows, 0) - 1;
            write_idle(store->sweep, run, object, json ? NULL : &csv);
        }
        if (json) {
            fputs(separator, stream);
            json_write_member(stream, object, 2);
            separator = ",\n    ";
        } else {
            csv_end_row(&csv);
        }
        json_decref(object);
    }
    if (json) {
        fputs("\n  ]\n}\n", stream);
    }
    if (sqlite3_finalize(rows) == SQLITE_OK) {
        return STATUS_OK;
    }
    return database_fault(store, f);
}

// --- columns, for whoever draws them ---------------------------------------------------

// Appends the row that a statement stands on to the columns, as their number `at`. Each
// of its columns has a number.
static status take_row(const sweep_database *store, sqlite3_stmt *row, int key_count,
                       double **columns, size_t at, fault *f)
{
    for (int k = 0; k < key_count; k++) {
        // room for 64 of them, then for twice as many whenever it is full
        if (at == 0 || (at >= 64 && (at & (at - 1)) == 0)) {
            const size_t room = at > 0 ? 2 * at : 64;
            double *more = realloc(columns[k], room * sizeof *more);
            if (more == NULL) {
                return fault_no_memory(f);
            }
            columns[k] = more;
        }
        columns[k][at] = sqlite3_column_double(row, k);
        FAULT_IF(!isfinite(columns[k][at]), f, STATUS_CANNOT_READ,
                 "'%s' has an infinite %s, expected numbers", store->path,
                 sqlite3_column_name(row, k));
    }
    return STATUS_OK;
}

// Looks for a column in the runs' table: sqlite would take an unknown name for a text.
static status find_column(sweep_database *store, const char *key, fault *f)
{
    sqlite3_stmt *found;
    int count = 0;
    status code =
        database_prepare(store, &found,
                         "SELECT 1 FROM pragma_table_info('run') WHERE name = ?1", f);
    sqlite3_bind_text(found, 1, key, -1, SQLITE_STATIC);
    while (database_next(store, found, &code, f)) {
        count++;
    }
    if (code != STATUS_OK || count > 0) {
        return code;
    }
    return fault_set(f, STATUS_CANNOT_READ,
                     "%s: no column '%s' in it, expected the database of a sweep",
                     store->path, key);
}

// Opens the rows of runs that have a number in every column.
static status query(sweep_database *store, const char *const *keys, int key_count,
                    sqlite3_stmt **rows, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(store->database);

    // what is wanted
    status code = STATUS_OK;
    const char *separator = "SELECT ";
    for (int k = 0; k < key_count && code == STATUS_OK; k++) {
        code = find_column(store, keys[k], f);
        sqlite3_str_appendf(sql, "%s\"%w\"", separator, keys[k]);
        separator = ", ";
    }

    // of which runs, in which order
    separator = " FROM run WHERE";
    for (int k = 0; k < key_count; k++) {
        sqlite3_str_appendf(sql, "%s typeof(\"%w\") IN ('real', 'integer')", separator,
                            keys[k]);
        separator = " AND";
    }
    sqlite3_str_appendall(sql, " ORDER BY 1");
    if (key_count > 1) {
        sqlite3_str_appendall(sql, ", 2");
    }

    if (code != STATUS_OK) {
        sqlite3_free(sqlite3_str_finish(sql));
        return code;
    }
    return database_use(store, sql, rows, f);
}

bool sweep_store_is(const char *path)
{
    sweep_database store = {.path = (char *)path, .lock = -1};
    bool empty;
    const bool is = database_open(&store, SQLITE_OPEN_READONLY, NULL) == STATUS_OK &&
                    database_recognise(&store, &empty, NULL) == STATUS_OK;
    sqlite3_close(store.database);
    return is;
}

status sweep_table_read(const char *path, const char *const *keys, int key_count,
                        double **columns, size_t *count, fault *f)
{
    assert(key_count >= 1 && key_count <= SWEEP_TABLE_COLUMNS);
    sweep_database store = {.path = (char *)path, .lock = -1};
    sqlite3_stmt *rows = NULL;
    *count = 0;
    for (int k = 0; k < key_count; k++) {
        columns[k] = NULL;
    }

    // read only: nothing is created where no file is
    bool empty;
    status code = database_open(&store, SQLITE_OPEN_READONLY, f);
    if (code == STATUS_OK) {
        code = database_recognise(&store, &empty, f);
    }
    if (code == STATUS_OK) {
        code = query(&store, keys, key_count, &rows, f);
    }
    while (database_next(&store, rows, &code, f)) {
        code = take_row(&store, rows, key_count, columns, (*count)++, f);
    }

    // all or nothing
    sqlite3_close(store.database);
    for (int k = 0; k < key_count && code != STATUS_OK; k++) {
        free(columns[k]);
        columns[k] = NULL;
    }
    if (code != STATUS_OK) {
        *count = 0;
    }
    return code;
}

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
    of->count += done;
    return code;
}

status sweep_store_values(sweep_store *of, sweep_share share, const char *key,
                          sweep_value_taker *take, void *context, size_t *failed,
                          fault *f)
{
    sweep_database *store = database_of(of);
    const long long total = (long long)store->sweep->run_count;
    size_t failures = 0;
    sqlite3_stmt *rows = NULL;

    // the rows of a share are looked up one by one
    sqlite3_str *sql = sqlite3_str_new(store->database);
    if (share.parts > 0) {
        sqlite3_str_appendf(sql,
                            "WITH RECURSIVE part(n) AS (SELECT %d UNION ALL SELECT n + "
                            "%d FROM part WHERE n + %d <= %lld) ",
                            share.part, share.parts, share.parts, total);
    }
    sqlite3_str_appendf(sql, "SELECT run, status, \"%w\" FROM run %s ORDER BY run", key,
                        share.parts > 0 ? "WHERE run IN part" : "");

    // a run that failed, or has no such quantity, has no number
    status code = database_use(store, sql, &rows, f);
    bool wanted = true;
    while (wanted && database_next(store, rows, &code, f)) {
        const long long run = sqlite3_column_int64(rows, 0);
        const char *ended = (const char *)sqlite3_column_text(rows, 1);
        if (run < 1 || run > total || ended == NULL) {
            code = fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' holds a row that is no run of the sweep",
                             store->path ? store->path : "memory");
            continue;
        }
        const bool ok = strcmp(ended, "failed") != 0;
        failures += !ok;
        double value = (double)NAN;
        if (ok && sqlite3_column_type(rows, 2) != SQLITE_NULL) {
            value = sqlite3_column_double(rows, 2);
        }
        wanted = take(context, (size_t)run - 1, value);
    }

    // the last row has ended the statement
    if (!wanted) {
        sqlite3_finalize(rows);
    }
    if (failed != NULL) {
        *failed = failures;
    }
    return code;
}

status sweep_store_quantity(sweep_store *store, sweep_share share, const char *key,
                            double *values, size_t *failed, fault *f)
{
    const size_t run_count = database_of(store)->sweep->run_count;
    return sweep_quantity(store, run_count, share, key, values, failed, f);
}

// --- as a table ------------------------------------------------------------------------

// The last column, of the paths of values without effect.
static const char idle_key[] = "without_effect";

// Whether some run has an axis that idles, so that a table needs a column for it.
static bool some_idle(const sweep *s)
{
    const char *why[SWEEP_MOST_AXES];
    for (size_t run = 0; run < s->run_count; run++) {
        if (sweep_idle(s, run, why)) {
            return true;
        }
    }
    return false;
}

int sweep_store_columns(const sweep *s, result_column columns[SWEEP_COLUMNS])
{
    run_column all[RUN_MOST_COLUMNS];
    int count = 0;
    for (int i = 0, most = database_columns(s, all); i < most; i++) {
        if (!all[i].timing) {
            columns[count++] = all[i].told;
        }
    }
    if (s->run_count > SWEEP_LOOKED_AT || some_idle(s)) {
        columns[count++] = (result_column){idle_key, idle_key, "", .kind = RESULT_TEXT};
    }
    return count;
}

// Whether a table's columns tell what has no effect; where none idles, rows need not
// look.
static bool tells_idle(const result_column *columns, int count)
{
    return count > 0 && strcmp(columns[count - 1].key, idle_key) == 0;
}

// The paths of a run's values without effect, with blanks between them.
static void idle_paths(const sweep *s, size_t run,
                       char paths[SWEEP_MOST_AXES * SWEEP_NAME])
{
    const char *why[SWEEP_MOST_AXES];
    size_t length = 0;
    paths[0] = '\0';
    sweep_idle(s, run, why);
    for (int i = 0; i < s->axis_count; i++) {
        if (why[i] != NULL) {
            length +=
                (size_t)snprintf(paths + length, SWEEP_MOST_AXES * SWEEP_NAME - length,
                                 "%s%s", length > 0 ? " " : "", s->axes[i].name);
        }
    }
}

// What the row that a statement stands on has in a column.
static result_cell cell_at(sqlite3_stmt *row, int column)
{
    const int type = sqlite3_column_type(row, column);
    result_cell cell = {NULL, (double)NAN};
    if (type == SQLITE_TEXT) {
        cell = (result_cell){(const char *)sqlite3_column_text(row, column), 0};
    } else if (type != SQLITE_NULL) {
        cell.number = sqlite3_column_double(row, column);
    }
    return cell;
}

// The rows are read and handed on one by one, as there may be millions.
status sweep_store_rows(sweep_store *of, sweep_share share, const result_column *columns,
                        int column_count, sweep_row_taker *take, void *context, fault *f)
{
    sweep_database *store = database_of(of);
    sqlite3_stmt *rows;
    run_column all[RUN_MOST_COLUMNS];
    const int most = database_columns(store->sweep, all);
    bool wanted = true;
    status code = database_prepare(store, &rows, "SELECT * FROM run ORDER BY run", f);

    while (wanted && database_next(store, rows, &code, f)) {
        const size_t run = (size_t)sqlite3_column_int64(rows, 0) - 1;
        if (share.parts > 0 && run % (size_t)share.parts != (size_t)share.part - 1) {
            continue;
        }

        // the row's cells, then what has no effect
        result_cell cells[SWEEP_COLUMNS];
        char paths[SWEEP_MOST_AXES * SWEEP_NAME];
        int count = 0;
        for (int i = 0; i < most; i++) {
            if (!all[i].timing) {
                cells[count++] = cell_at(rows, i);
            }
        }
        if (tells_idle(columns, column_count)) {
            idle_paths(store->sweep, run, paths);
            cells[count] = (result_cell){paths, 0};
        }
        wanted = take(context, run, cells);
    }

    // the last row has ended the statement
    if (!wanted) {
        sqlite3_finalize(rows);
    }
    return code;
}

// --- as files --------------------------------------------------------------------------

// A file that is being written.
typedef struct rows_file {
    FILE *stream;
    const sweep *sweep;
    csv_writer csv;
    result_column columns[SWEEP_COLUMNS];
    int count;
    const char *separator; // before the next object of JSON
} rows_file;

static bool write_csv_row(void *context, size_t run, const result_cell *cells)
{
    rows_file *file = context;
    (void)run; // it is in its cell
    for (int k = 0; k < file->count; k++) {
        result_field(&file->csv, cells[k]);
    }
    csv_end_row(&file->csv);
    return !ferror(file->stream);
}

// Adds the values of a run that have no effect, [{path, why}], if there are any.
static void put_idle_values(json_t *object, const sweep *s, size_t run)
{
    const char *why[SWEEP_MOST_AXES];
    if (!sweep_idle(s, run, why)) {
        return;
    }
    json_t *array = json_array();
    for (int i = 0; i < s->axis_count; i++) {
        if (why[i] != NULL) {
            json_add(array, json_of("path:t why:t", s->axes[i].name, why[i]));
        }
    }
    json_put(object, idle_key, array);
}

static bool write_json_row(void *context, size_t run, const result_cell *cells)
{
    rows_file *file = context;
    json_t *object = json_object();

    // as the columns, but that JSON says why a value has no effect, too
    const bool tells = tells_idle(file->columns, file->count);
    int plain = file->count;
    if (tells) {
        plain--;
    }
    for (int k = 0; k < plain; k++) {
        result_put(object, file->columns[k].key, cells[k]);
    }
    if (tells) {
        put_idle_values(object, file->sweep, run);
    }

    fputs(file->separator, file->stream);
    json_write_member(file->stream, object, 2);
    file->separator = ",\n    ";
    json_decref(object);
    return !ferror(file->stream);
}

// The object with all rows in `runs`.
static status write_json(sweep_store *of, rows_file *file, fault *f)
{
    FILE *stream = file->stream;
    json_t *name = json_text(file->sweep->base->name);
    fputs("{\n  \"scenario\": ", stream);
    json_write_member(stream, name, 1);
    fprintf(stream, ",\n  \"sampling\": \"%s\",\n  \"runs\": [",
            sweep_sampling_name(file->sweep->sampling));
    json_decref(name);

    TRY(sweep_store_rows(of, (sweep_share){0, 0}, file->columns, file->count,
                         write_json_row, file, f));
    fputs("\n  ]\n}\n", stream);
    return STATUS_OK;
}

status sweep_store_write(sweep_store *of, FILE *stream, bool json, fault *f)
{
    rows_file file = {.stream = stream,
                      .sweep = database_of(of)->sweep,
                      .csv = csv_begin(stream),
                      .separator = "\n    "};
    file.count = sweep_store_columns(file.sweep, file.columns);
    if (json) {
        return write_json(of, &file, f);
    }
    result_headings(&file.csv, file.columns, file.count);
    return sweep_store_rows(of, (sweep_share){0, 0}, file.columns, file.count,
                            write_csv_row, &file, f);
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

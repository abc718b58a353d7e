// The rows of a sweep's store: one for each run that was computed.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "src/study/store/sweep_database.h"
#include "src/study/store/sweep_store.h"

status sweep_store_present(sweep_store *of, unsigned char *present, size_t *count, fault *f)
{
    assert(present != NULL && count != NULL);
    sweep_database *store = database_of(of);
    sqlite3_stmt *rows;
    size_t total = store->sweep->run_count;
    memset(present, 0, total);
    *count = 0;

    // a run that the sweep does not have means that the file was changed by others
    status code = database_prepare(store, &rows, "SELECT run FROM run", f);
    while (code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        long long run = sqlite3_column_int64(rows, 0);
        if (run < 1 || (unsigned long long)run > total) {
            code = fault_set(f, STATUS_BAD_ARGUMENT, "'%s' holds run %lld of a sweep of %zu",
                             store->path, run, total);
        } else {
            present[run - 1] = 1;
            (*count)++;
        }
    }

    if (sqlite3_finalize(rows) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    return code;
}

static void bind_number(sqlite3_stmt *statement, int column, double value)
{
    if (isfinite(value)) {
        sqlite3_bind_double(statement, column, value);
    } else {
        sqlite3_bind_null(statement, column);
    }
}

static void bind_row(sweep_database *store, size_t run, const summary *result)
{
    const sweep *s = store->sweep;
    sqlite3_stmt *row = store->insert;
    int column = 1;

    // which run, under which values
    sqlite3_bind_int64(row, column++, (sqlite3_int64)run + 1);
    for (int i = 0; i < s->axis_count; i++) {
        parameter_type type = sweep_axis_parameter(&s->axes[i])->type;
        if (type == PARAMETER_CHOICE || type == PARAMETER_BOOLEAN) {
            char text[128];
            sweep_value_text(s, run, i, text, sizeof text);
            sqlite3_bind_text(row, column++, text, -1, SQLITE_TRANSIENT);
        } else {
            sqlite3_bind_double(row, column++, sweep_value(s, run, i));
        }
    }

    // how it ended, and with what numbers
    sqlite3_bind_text(row, column++, summary_status(result), -1, SQLITE_STATIC);
    sqlite3_bind_text(row, column++, result->message, -1, SQLITE_STATIC); // until the step
    for (int i = 0; i < summary_count; i++) {
        bind_number(row, column++, summary_value(result, i));
    }
}

status sweep_store_put(sweep_store *of, size_t run, const summary *result, fault *f)
{
    sweep_database *store = database_of(of);
    assert(result != NULL && run < store->sweep->run_count);
    if (!store->in_transaction) {
        status code = database_execute(store, "BEGIN IMMEDIATE", f);
        if (code != STATUS_OK) {
            return code;
        }
        store->in_transaction = true;
    }

    // the row, within a transaction that is committed every now and then
    bind_row(store, run, result);
    int done = sqlite3_step(store->insert);
    status code = done == SQLITE_DONE ? STATUS_OK : database_fault(store, f);
    sqlite3_reset(store->insert);
    return code;
}

status sweep_store_quantity(sweep_store *of, const char *key, double *values, size_t *failed,
                            fault *f)
{
    assert(key != NULL && values != NULL);
    sweep_database *store = database_of(of);
    size_t total = store->sweep->run_count, failures = 0;
    sqlite3_stmt *rows = NULL;

    for (size_t i = 0; i < total; i++) {
        values[i] = (double)NAN;
    }

    // a run that failed, or has no such quantity, stays missing
    char *sql = sqlite3_mprintf("SELECT run, status, \"%w\" FROM run", key);
    status code = sql ? database_prepare(store, &rows, sql, f) : fault_no_memory(f);
    while (code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        long long run = sqlite3_column_int64(rows, 0);
        const char *ended = (const char *)sqlite3_column_text(rows, 1);
        if (run < 1 || (unsigned long long)run > total || ended == NULL) {
            code = fault_set(f, STATUS_BAD_ARGUMENT, "'%s' holds a row that is no run of the sweep",
                             store->path ? store->path : "memory");
            break;
        }
        bool ok = strcmp(ended, "failed") != 0;
        failures += !ok;
        if (ok && sqlite3_column_type(rows, 2) != SQLITE_NULL) {
            values[run - 1] = sqlite3_column_double(rows, 2);
        }
    }

    if (sqlite3_finalize(rows) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    sqlite3_free(sql);
    if (failed != NULL) {
        *failed = failures;
    }
    return code;
}

static void write_headings(csv_writer *csv, const sweep *s)
{
    csv_heading(csv, "run", "");
    for (int i = 0; i < s->axis_count; i++) {
        const parameter_info *info = sweep_axis_parameter(&s->axes[i]);
        csv_heading(csv, s->axes[i].name, info->unit);
    }

    // how it ended, and with what numbers
    csv_heading(csv, "status", "");
    csv_heading(csv, "message", "");
    for (int i = 0; i < summary_count; i++) {
        if (!summary_table[i].timing) {
            csv_heading(csv, summary_table[i].name, summary_table[i].unit);
        }
    }
    csv_end_row(csv);
}

static void write_field(csv_writer *csv, sqlite3_stmt *row, int column)
{
    switch (sqlite3_column_type(row, column)) {
    case SQLITE_TEXT:
        csv_text(csv, (const char *)sqlite3_column_text(row, column));
        break;
    case SQLITE_NULL:
        csv_number(csv, (double)NAN);
        break;
    default:
        csv_number(csv, sqlite3_column_double(row, column));
    }
}

status sweep_store_csv(sweep_store *of, FILE *stream, fault *f)
{
    assert(stream != NULL);
    sweep_database *store = database_of(of);
    sqlite3_stmt *rows;
    int first_quantity = RUN_FIRST_VALUE + store->sweep->axis_count + RUN_OUTCOME_COLUMNS;
    TRY(database_prepare(store, &rows, "SELECT * FROM run ORDER BY run", f));

    csv_writer csv = csv_begin(stream);
    write_headings(&csv, store->sweep);

    // all columns but those that depend on the machine
    while (sqlite3_step(rows) == SQLITE_ROW && !ferror(stream)) {
        for (int i = 0; i < first_quantity + summary_count; i++) {
            if (i < first_quantity || !summary_table[i - first_quantity].timing) {
                write_field(&csv, rows, i);
            }
        }
        csv_end_row(&csv);
    }
    return sqlite3_finalize(rows) == SQLITE_OK ? STATUS_OK : database_fault(store, f);
}

static json_t *field_value(sqlite3_stmt *row, int column)
{
    return sqlite3_column_type(row, column) == SQLITE_TEXT
               ? json_text((const char *)sqlite3_column_text(row, column))
           : sqlite3_column_type(row, column) == SQLITE_NULL
               ? json_null()
               : json_number(sqlite3_column_double(row, column));
}

// The row that a statement stands on, without what depends on the machine.
static json_t *row_object(const sweep *s, sqlite3_stmt *row)
{
    json_t *object = json_object(); // NULL loses whatever is put into it
    int column = 0;
    json_put(object, "run", field_value(row, column++));
    for (int i = 0; i < s->axis_count; i++) {
        json_put(object, s->axes[i].name, field_value(row, column++));
    }

    // how it ended, and with what numbers
    json_put(object, "status", field_value(row, column++));
    json_put(object, "message", field_value(row, column++));
    for (int i = 0; i < summary_count; i++, column++) {
        if (!summary_table[i].timing) {
            json_put(object, summary_table[i].key, field_value(row, column));
        }
    }
    return object;
}

status sweep_store_json(sweep_store *of, FILE *stream, fault *f)
{
    assert(stream != NULL);
    sweep_database *store = database_of(of);
    const sweep *s = store->sweep;
    sqlite3_stmt *rows;
    TRY(database_prepare(store, &rows, "SELECT * FROM run ORDER BY run", f));

    // the head
    json_t *name = json_text(s->base->name);
    fputs("{\n  \"scenario\": ", stream);
    json_write_member(stream, name, 1);
    fprintf(stream, ",\n  \"sampling\": \"%s\",\n  \"runs\": [", sweep_sampling_name(s->sampling));
    json_decref(name);

    // row by row, as there may be millions
    const char *separator = "\n    ";
    while (sqlite3_step(rows) == SQLITE_ROW && !ferror(stream)) {
        json_t *object = row_object(s, rows);
        fputs(separator, stream);
        json_write_member(stream, object, 2);
        json_decref(object);
        separator = ",\n    ";
    }
    fputs("\n  ]\n}\n", stream);
    return sqlite3_finalize(rows) == SQLITE_OK ? STATUS_OK : database_fault(store, f);
}

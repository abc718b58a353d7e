// Columns of a sweep's database, for whoever draws them.
#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/study/store/sweep_database.h"
#include "src/study/store/sweep_store.h"

// All rows of a statement with a number in each of its columns.
static status read_rows(const sweep_database *store, sqlite3_stmt *rows, int key_count,
                        double **columns, size_t *count, fault *f)
{
    size_t room = 0;
    int step;
    while ((step = sqlite3_step(rows)) == SQLITE_ROW) {
        // all grow together; what was had is kept for the caller to free
        if (*count == room) {
            room = room > 0 ? 2 * room : 64;
            for (int k = 0; k < key_count; k++) {
                double *more = realloc(columns[k], room * sizeof *more);
                TRY_MEMORY(more != NULL, f);
                columns[k] = more;
            }
        }

        for (int k = 0; k < key_count; k++) {
            columns[k][*count] = sqlite3_column_double(rows, k);
            FAIL_IF(!isfinite(columns[k][*count]),
                    fault_set(f, STATUS_CANNOT_READ, "'%s' has an infinite %s, expected numbers",
                              store->path, sqlite3_column_name(rows, k)));
        }
        (*count)++;
    }

    // rows that end by a failure are not all
    return step == SQLITE_DONE ? STATUS_OK : database_fault(store, f);
}

// Looks for a column in the runs' table: sqlite would take an unknown name for a text.
static status find_column(sweep_database *store, const char *key, fault *f)
{
    sqlite3_stmt *found;
    status code = database_prepare(store, &found,
                                   "SELECT 1 FROM pragma_table_info('run') WHERE name = ?1", f);
    if (code == STATUS_OK) {
        sqlite3_bind_text(found, 1, key, -1, SQLITE_STATIC);
        const int step = sqlite3_step(found);
        code = step == SQLITE_ROW ? STATUS_OK
               : step == SQLITE_DONE
                   ? fault_set(f, STATUS_CANNOT_READ,
                               "%s: no column '%s' in it, expected the database of a sweep",
                               store->path, key)
                   : database_fault(store, f);
    }
    sqlite3_finalize(found);
    return code;
}

// Opens the rows of runs that have a number in every column.
static status query(sweep_database *store, const char *const *keys, int key_count,
                    sqlite3_stmt **rows, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(store->database);

    // what is wanted
    status code = STATUS_OK;
    for (int k = 0; k < key_count && code == STATUS_OK; k++) {
        code = find_column(store, keys[k], f);
        sqlite3_str_appendf(sql, "%s\"%w\"", k == 0 ? "SELECT " : ", ", keys[k]);
    }

    // of which runs, in which order
    for (int k = 0; k < key_count; k++) {
        sqlite3_str_appendf(sql, "%s typeof(\"%w\") IN ('real', 'integer')",
                            k == 0 ? " FROM run WHERE" : " AND", keys[k]);
    }
    sqlite3_str_appendf(sql, " ORDER BY 1%s", key_count > 1 ? ", 2" : "");

    char *text = sqlite3_str_finish(sql);
    if (code == STATUS_OK) {
        code = text != NULL ? database_prepare(store, rows, text, f) : fault_no_memory(f);
    }
    sqlite3_free(text);
    return code;
}

status sweep_table_read(const char *path, const char *const *keys, int key_count, double **columns,
                        size_t *count, fault *f)
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
    code = code == STATUS_OK ? database_recognise(&store, &empty, f) : code;
    code = code == STATUS_OK ? query(&store, keys, key_count, &rows, f) : code;
    code = code == STATUS_OK ? read_rows(&store, rows, key_count, columns, count, f) : code;

    // all or nothing
    sqlite3_finalize(rows);
    sqlite3_close(store.database);
    for (int k = 0; k < key_count && code != STATUS_OK; k++) {
        free(columns[k]);
        columns[k] = NULL;
    }
    *count = code == STATUS_OK ? *count : 0;
    return code;
}

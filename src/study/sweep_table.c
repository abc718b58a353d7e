#include "src/study/sweep_table.h"

#include <assert.h>
#include <sqlite3.h>
#include <stdbool.h>
#include <stdlib.h>

// All rows of a statement with a number in each of its columns.
static status read_rows(sqlite3_stmt *rows, int key_count, double **columns, size_t *count,
                        fault *f)
{
    size_t room = 0;
    while (sqlite3_step(rows) == SQLITE_ROW) {
        // all grow together; what was had is kept for the caller to free
        if (*count == room) {
            room = room > 0 ? 2 * room : 64;
            for (int k = 0; k < key_count; k++) {
                double *more = realloc(columns[k], room * sizeof *more);
                if (more == NULL) {
                    return fault_no_memory(f);
                }
                columns[k] = more;
            }
        }

        for (int k = 0; k < key_count; k++) {
            columns[k][*count] = sqlite3_column_double(rows, k);
        }
        (*count)++;
    }
    return STATUS_OK;
}

// Whether the runs' table has a column; sqlite would take an unknown name for a text.
static bool has_column(sqlite3 *database, const char *key)
{
    sqlite3_stmt *found = NULL;
    bool has = false;
    const char *sql = "SELECT 1 FROM pragma_table_info('run') WHERE name = ?1";
    if (sqlite3_prepare_v2(database, sql, -1, &found, NULL) == SQLITE_OK) {
        sqlite3_bind_text(found, 1, key, -1, SQLITE_STATIC);
        has = sqlite3_step(found) == SQLITE_ROW;
    }
    sqlite3_finalize(found);
    return has;
}

// Opens the rows of runs that have a number in every column.
static status query(sqlite3 *database, const char *path, const char *const *keys, int key_count,
                    sqlite3_stmt **rows, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(database);

    // what is wanted; sqlite would take an unknown name for a text
    for (int k = 0; k < key_count; k++) {
        if (!has_column(database, keys[k])) {
            sqlite3_free(sqlite3_str_finish(sql));
            return fault_set(f, STATUS_CANNOT_READ,
                             "%s: no column '%s' in it, expected the database of a sweep", path,
                             keys[k]);
        }
        sqlite3_str_appendf(sql, "%s\"%w\"", k == 0 ? "SELECT " : ", ", keys[k]);
    }

    // of which runs, in which order
    for (int k = 0; k < key_count; k++) {
        sqlite3_str_appendf(sql, "%s typeof(\"%w\") IN ('real', 'integer')",
                            k == 0 ? " FROM run WHERE" : " AND", keys[k]);
    }
    sqlite3_str_appendf(sql, " ORDER BY 1%s", key_count > 1 ? ", 2" : "");

    char *text = sqlite3_str_finish(sql);
    int code = text != NULL ? sqlite3_prepare_v2(database, text, -1, rows, NULL) : SQLITE_NOMEM;
    sqlite3_free(text);
    return code == SQLITE_OK ? STATUS_OK
                             : fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path,
                                         sqlite3_errmsg(database));
}

status sweep_table_read(const char *path, const char *const *keys, int key_count, double **columns,
                        size_t *count, fault *f)
{
    assert(path != NULL && keys != NULL && columns != NULL && count != NULL);
    assert(key_count >= 1 && key_count <= SWEEP_TABLE_COLUMNS);
    sqlite3 *database = NULL;
    sqlite3_stmt *rows = NULL;
    *count = 0;
    for (int k = 0; k < key_count; k++) {
        columns[k] = NULL;
    }

    // read only: nothing is created where no file is
    status code = STATUS_OK;
    if (sqlite3_open_v2(path, &database, SQLITE_OPEN_READONLY, NULL) != SQLITE_OK) {
        code = fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path,
                         sqlite3_errmsg(database));
    }
    if (code == STATUS_OK) {
        code = query(database, path, keys, key_count, &rows, f);
    }
    if (code == STATUS_OK) {
        code = read_rows(rows, key_count, columns, count, f);
    }

    // all or nothing
    sqlite3_finalize(rows);
    sqlite3_close(database);
    for (int k = 0; k < key_count && code != STATUS_OK; k++) {
        free(columns[k]);
        columns[k] = NULL;
    }
    *count = code == STATUS_OK ? *count : 0;
    return code;
}

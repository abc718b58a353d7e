#include "src/study/sweep_table.h"

#include <assert.h>
#include <sqlite3.h>
#include <stdlib.h>

static status cannot_read(sqlite3 *database, const char *path, fault *f)
{
    return fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path,
                     sqlite3_errmsg(database));
}

// All rows of a statement with a number in each of its columns.
static status read_rows(sqlite3_stmt *rows, const char *path, int key_count, double **columns,
                        size_t *count, fault *f)
{
    size_t room = 0;
    int step;
    while ((step = sqlite3_step(rows)) == SQLITE_ROW) {
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

    // rows that end by a failure are not all
    return step == SQLITE_DONE ? STATUS_OK : cannot_read(sqlite3_db_handle(rows), path, f);
}

// Looks for a column in the runs' table: sqlite would take an unknown name for a text.
static status find_column(sqlite3 *database, const char *path, const char *key, fault *f)
{
    sqlite3_stmt *found = NULL;
    const char *sql = "SELECT 1 FROM pragma_table_info('run') WHERE name = ?1";
    int step = sqlite3_prepare_v2(database, sql, -1, &found, NULL);
    if (step == SQLITE_OK) {
        sqlite3_bind_text(found, 1, key, -1, SQLITE_STATIC);
        step = sqlite3_step(found);
    }

    status code = STATUS_OK;
    if (step == SQLITE_DONE) {
        code = fault_set(f, STATUS_CANNOT_READ,
                         "%s: no column '%s' in it, expected the database of a sweep", path, key);
    } else if (step != SQLITE_ROW) {
        code = cannot_read(database, path, f);
    }
    sqlite3_finalize(found);
    return code;
}

// Opens the rows of runs that have a number in every column.
static status query(sqlite3 *database, const char *path, const char *const *keys, int key_count,
                    sqlite3_stmt **rows, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(database);

    // what is wanted
    for (int k = 0; k < key_count; k++) {
        status found = find_column(database, path, keys[k], f);
        if (found != STATUS_OK) {
            sqlite3_free(sqlite3_str_finish(sql));
            return found;
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
    return code == SQLITE_OK ? STATUS_OK : cannot_read(database, path, f);
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
        code = cannot_read(database, path, f);
    }
    if (code == STATUS_OK) {
        code = query(database, path, keys, key_count, &rows, f);
    }
    if (code == STATUS_OK) {
        code = read_rows(rows, path, key_count, columns, count, f);
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

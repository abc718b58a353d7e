#include "src/study/sweep_table.h"

#include <assert.h>
#include <sqlite3.h>
#include <stdbool.h>
#include <stdlib.h>

// All rows of a statement with two numbers each.
static status read_rows(sqlite3_stmt *rows, double **x, double **y, size_t *count, fault *f)
{
    size_t room = 0;
    while (sqlite3_step(rows) == SQLITE_ROW) {
        // both grow together; what was had is kept for the caller to free
        if (*count == room) {
            room = room > 0 ? 2 * room : 64;
            double *more_x = realloc(*x, room * sizeof **x);
            *x = more_x != NULL ? more_x : *x;
            double *more_y = realloc(*y, room * sizeof **y);
            *y = more_y != NULL ? more_y : *y;
            if (more_x == NULL || more_y == NULL) {
                return fault_no_memory(f);
            }
        }

        (*x)[*count] = sqlite3_column_double(rows, 0);
        (*y)[(*count)++] = sqlite3_column_double(rows, 1);
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

static status query(sqlite3 *database, const char *path, const char *x_key, const char *y_key,
                    sqlite3_stmt **rows, fault *f)
{
    // both columns must be there
    const char *const keys[] = {x_key, y_key};
    for (int i = 0; i < 2; i++) {
        if (!has_column(database, keys[i])) {
            return fault_set(f, STATUS_CANNOT_READ,
                             "%s: no column '%s' in it, expected the database of a sweep", path,
                             keys[i]);
        }
    }

    // runs that have both numbers
    char *sql = sqlite3_mprintf("SELECT \"%w\", \"%w\" FROM run WHERE typeof(\"%w\") IN ('real', "
                                "'integer') AND typeof(\"%w\") IN ('real', 'integer') ORDER BY 1",
                                x_key, y_key, x_key, y_key);
    int code = sql != NULL ? sqlite3_prepare_v2(database, sql, -1, rows, NULL) : SQLITE_NOMEM;
    sqlite3_free(sql);
    return code == SQLITE_OK ? STATUS_OK
                             : fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path,
                                         sqlite3_errmsg(database));
}

status sweep_table_read(const char *path, const char *x_key, const char *y_key, double **x,
                        double **y, size_t *count, fault *f)
{
    assert(path != NULL && x_key != NULL && y_key != NULL && x != NULL && y != NULL);
    sqlite3 *database = NULL;
    sqlite3_stmt *rows = NULL;
    *x = *y = NULL;
    *count = 0;

    // read only: nothing is created where no file is
    status code = STATUS_OK;
    if (sqlite3_open_v2(path, &database, SQLITE_OPEN_READONLY, NULL) != SQLITE_OK) {
        code = fault_set(f, STATUS_CANNOT_READ, "%s cannot be read: %s", path,
                         sqlite3_errmsg(database));
    }
    if (code == STATUS_OK) {
        code = query(database, path, x_key, y_key, &rows, f);
    }
    if (code == STATUS_OK) {
        code = read_rows(rows, x, y, count, f);
    }

    // all or nothing
    sqlite3_finalize(rows);
    sqlite3_close(database);
    if (code != STATUS_OK) {
        free(*x);
        free(*y);
        *x = *y = NULL;
        *count = 0;
    }
    return code;
}

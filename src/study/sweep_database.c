#include "src/study/sweep_database.h"

status database_fault(const sweep_store *store, fault *f)
{
    int code = sqlite3_errcode(store->database) & 0xFF;
    const char *why = sqlite3_errmsg(store->database);
    const char *path = store->path ? store->path : "the results in memory";

    if (code == SQLITE_NOMEM) {
        return fault_no_memory(f);
    }
    if (code == SQLITE_NOTADB) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "'%s' is no SQLite database", path);
    }
    return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path, why);
}

status database_execute(sweep_store *store, const char *sql, fault *f)
{
    return sqlite3_exec(store->database, sql, NULL, NULL, NULL) == SQLITE_OK
               ? STATUS_OK
               : database_fault(store, f);
}

status database_prepare(sweep_store *store, sqlite3_stmt **statement, const char *sql, fault *f)
{
    return sqlite3_prepare_v2(store->database, sql, -1, statement, NULL) == SQLITE_OK
               ? STATUS_OK
               : database_fault(store, f);
}

status database_query_number(sweep_store *store, const char *sql, long long *number, fault *f)
{
    sqlite3_stmt *statement;
    *number = 0;
    status code = database_prepare(store, &statement, sql, f);
    if (code == STATUS_OK && sqlite3_step(statement) == SQLITE_ROW) {
        *number = sqlite3_column_int64(statement, 0);
    }
    if (sqlite3_finalize(statement) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    return code;
}

#include "src/study/sweep_store.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "src/run/run_result.h"
#include "src/study/sweep_definition.h"

// Marks a database as ours (PRAGMA application_id): "ILSw". The layout's version is user_version.
#define APPLICATION_ID "1229738871"
#define LAYOUT         "1"

// A row a run: its number, the values of the axes, how it ended, the summary.
static status create_run_table(sweep_store *store, fault *f)
{
    const sweep *s = store->sweep;
    sqlite3_str *sql = sqlite3_str_new(store->database);
    sqlite3_str_appendall(sql, "CREATE TABLE run (run INTEGER PRIMARY KEY");

    for (int i = 0; i < s->axis_count; i++) {
        const parameter_info *info = &parameter_table[s->axes[i].parameter];
        bool words = info->type == PARAMETER_CHOICE || info->type == PARAMETER_BOOLEAN;
        sqlite3_str_appendf(sql, ", \"%w\" %s NOT NULL", info->path,
                            words                             ? "TEXT"
                            : info->type == PARAMETER_INTEGER ? "INTEGER"
                                                              : "REAL");
    }

    sqlite3_str_appendall(sql, ", status TEXT NOT NULL, message TEXT NOT NULL");
    for (int i = 0; i < summary_count; i++) {
        sqlite3_str_appendf(sql, ", \"%w\" REAL", summary_table[i].key);
    }
    sqlite3_str_appendall(sql, ")");

    char *text = sqlite3_str_finish(sql);
    status code = text ? database_execute(store, text, f) : fault_no_memory(f);
    sqlite3_free(text);
    return code;
}

// Creates the tables and writes the definition, all in one transaction.
static status create_tables(sweep_store *store, const definition *d, fault *f)
{
    status code =
        database_execute(store,
                         "BEGIN IMMEDIATE;"
                         "PRAGMA application_id = " APPLICATION_ID ";"
                         "PRAGMA user_version = " LAYOUT ";"
                         "CREATE TABLE sweep (key TEXT UNIQUE NOT NULL, value TEXT NOT NULL)",
                         f);

    code = code == STATUS_OK ? create_run_table(store, f) : code;
    code = code == STATUS_OK ? definition_write(store, d, f) : code;
    code = code == STATUS_OK ? database_execute(store, "COMMIT", f) : code;

    if (code != STATUS_OK) {
        sqlite3_exec(store->database, "ROLLBACK", NULL, NULL, NULL);
    }
    return code;
}

// True in *empty if the database holds nothing; a fault if what it holds is no sweep of ours.
static status recognise(sweep_store *store, bool *empty, fault *f)
{
    long long tables, mark = 0, layout = 0;
    status code = database_query_number(store, "SELECT count(*) FROM sqlite_master", &tables, f);
    *empty = tables == 0;
    if (code == STATUS_OK && !*empty) {
        code = database_query_number(store, "PRAGMA application_id", &mark, f);
        code = code == STATUS_OK ? database_query_number(store, "PRAGMA user_version", &layout, f)
                                 : code;
        if (code == STATUS_OK && (mark != atoll(APPLICATION_ID) || layout != atoll(LAYOUT))) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' is a database that holds no sweep of this program", store->path);
        }
    }
    return code;
}

// Continues the sweep in the database or starts it.
static status adopt(sweep_store *store, fault *f)
{
    definition now, was;
    bool empty;
    status code = recognise(store, &empty, f);
    if (code != STATUS_OK) {
        return code;
    }

    definition_init(&now, store->sweep);
    if (now.out_of_memory) {
        code = fault_no_memory(f);
    } else if (empty) {
        code = create_tables(store, &now, f);
    } else {
        code = definition_read(store, &was, f);
        if (code == STATUS_OK) {
            code = was.out_of_memory ? fault_no_memory(f)
                                     : definition_compare(store->path, &was, &now, f);
        }
        definition_finish(&was);
    }
    definition_finish(&now);
    return code;
}

// Keeps a second sweep from writing to the same file. The descriptor stays open as long as the
// database: closing it earlier would drop the database's own locks on the file.
static status lock_file(sweep_store *store, fault *f)
{
    store->lock = open(store->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (store->lock < 0) {
        return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", store->path,
                         strerror(errno));
    }

    if (flock(store->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        return fault_set(f, STATUS_CANNOT_WRITE, "another sweep is writing to '%s' just now",
                         store->path);
    }
    return STATUS_OK;
}

// The statement that stores a run, compiled once.
static status prepare_insert(sweep_store *store, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(store->database);
    int columns = RUN_FIRST_VALUE + store->sweep->axis_count + RUN_OUTCOME_COLUMNS + summary_count;
    sqlite3_str_appendall(sql, "INSERT INTO run VALUES (?");
    for (int i = 1; i < columns; i++) {
        sqlite3_str_appendall(sql, ", ?");
    }
    sqlite3_str_appendall(sql, ")");

    char *text = sqlite3_str_finish(sql);
    status code = text ? database_prepare(store, &store->insert, text, f) : fault_no_memory(f);
    sqlite3_free(text);
    return code;
}

// Opens the file, or memory, and what the sweep needs of it.
static status open_database(sweep_store *store, fault *f)
{
    if (store->path != NULL) {
        status code = lock_file(store, f);
        if (code != STATUS_OK) {
            return code;
        }
    }

    if (sqlite3_open_v2(store->path ? store->path : ":memory:", &store->database,
                        SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, NULL) != SQLITE_OK) {
        return store->database ? database_fault(store, f) : fault_no_memory(f);
    }

    // somebody may be reading the results of a sweep that goes on
    sqlite3_busy_timeout(store->database, 10000);
    status code = adopt(store, f);
    return code == STATUS_OK ? prepare_insert(store, f) : code;
}

status sweep_store_open(sweep_store **opened, const char *path, const sweep *s, fault *f)
{
    assert(opened != NULL && s != NULL);
    sweep_store *store = calloc(1, sizeof *store);
    *opened = NULL;
    if (store == NULL) {
        return fault_no_memory(f);
    }

    store->sweep = s;
    store->lock = -1;
    status code = STATUS_OK;

    // a plain name that begins with a colon would mean something else to the database
    if (path != NULL && asprintf(&store->path, "%s%s", path[0] == ':' ? "./" : "", path) < 0) {
        store->path = NULL;
        code = fault_no_memory(f);
    }

    code = code == STATUS_OK ? open_database(store, f) : code;
    if (code != STATUS_OK) {
        sweep_store_close(store);
        return code;
    }
    *opened = store;
    return STATUS_OK;
}

void sweep_store_close(sweep_store *store)
{
    if (store == NULL) {
        return;
    }
    if (store->in_transaction) {
        sweep_store_commit(store, NULL);
    }
    sqlite3_finalize(store->insert);
    sqlite3_close(store->database);
    if (store->lock >= 0) {
        close(store->lock);
    }
    free(store->path);
    free(store);
}

status sweep_store_commit(sweep_store *store, fault *f)
{
    assert(store != NULL);
    if (!store->in_transaction) {
        return STATUS_OK;
    }
    status code = database_execute(store, "COMMIT", f);
    store->in_transaction = code != STATUS_OK;
    return code;
}

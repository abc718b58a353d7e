#include "src/study/sweep_store.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "src/study/sweep_definition.h"

// Creates the tables and writes the definition, all in one transaction.
static status create_tables(sweep_store *store, const definition *d, fault *f)
{
    status code = database_execute(store, "BEGIN IMMEDIATE", f);
    code = code == STATUS_OK ? database_create_tables(store, f) : code;
    code = code == STATUS_OK ? definition_write(store, d, f) : code;
    code = code == STATUS_OK ? database_execute(store, "COMMIT", f) : code;

    if (code != STATUS_OK) {
        sqlite3_exec(store->database, "ROLLBACK", NULL, NULL, NULL);
    }
    return code;
}

// Continues the sweep in the database or starts it.
static status adopt(sweep_store *store, fault *f)
{
    definition now, was;
    bool empty;
    status code = database_recognise(store, &empty, f);
    if (code != STATUS_OK) {
        return code;
    }

    // a new file is given the definition, another one must have the same
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
            code = code == STATUS_OK ? database_check_columns(store, f) : code;
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

// Opens the file, or memory, and what the sweep needs of it.
static status open_database(sweep_store *store, fault *f)
{
    if (store->path != NULL) {
        status code = lock_file(store, f);
        if (code != STATUS_OK) {
            return code;
        }
    }

    status code = database_open(store, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, f);
    if (code != STATUS_OK) {
        return code;
    }

    // somebody may be reading the results of a sweep that goes on
    sqlite3_busy_timeout(store->database, 10000);
    code = adopt(store, f);
    return code == STATUS_OK ? database_prepare_insert(store, &store->insert, f) : code;
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

    // the database before the lock that guards it
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

    // SQLite looks at the beginning of a transaction whether the file is still there
    int moved = 0;
    sqlite3_file_control(store->database, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return code != STATUS_OK || !moved ? code : database_moved_fault(store, f);
}

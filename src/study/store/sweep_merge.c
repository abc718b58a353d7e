// Brings the parts of one sweep, computed apart, together in one database.
#include <assert.h>
#include <stdio.h>

#include "src/base/whole_file.h"
#include "src/study/store/sweep_database.h"
#include "src/study/store/sweep_store.h"

// The merged sweep while it grows, in memory.
typedef struct merging {
    sweep plan;            // which values each run has
    definition definition; // of the first part; all others are compared with it
    sweep_database store;  // in memory
    sweep_merged *merged;
} merging;

// Opens a part for reading and reads what defines it.
static status open_part(sweep_database *part, char *path, definition *d, fault *f)
{
    bool empty;
    *part = (sweep_database){.path = path, .lock = -1};
    TRY(database_open(part, SQLITE_OPEN_READONLY, f));
    TRY(database_execute(part, "BEGIN", f)); // as it is now
    TRY(database_recognise(part, &empty, f));
    return empty ? fault_set(f, STATUS_BAD_ARGUMENT, "'%s' is empty, expected a part of a sweep",
                             path)
                 : definition_read(part, d, f);
}

// Begins the merged sweep with the definition of its first part, which it takes over.
static status begin(merging *m, const char *path, fault *f)
{
    status code = definition_plan(&m->definition, path, &m->plan, f);
    m->merged->total = m->plan.run_count;
    m->store = (sweep_database){.sweep = &m->plan, .lock = -1};
    TRY(code);
    TRY(database_open(&m->store, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, f));
    TRY(database_execute(&m->store, "BEGIN", f));
    TRY(database_create_tables(&m->store, f));
    TRY(definition_write(&m->store, &m->definition, f));
    return database_prepare_insert(&m->store, &m->store.insert, f);
}

// Adds the row that a statement stands on.
static status add_row(merging *m, const char *path, sqlite3_stmt *row, fault *f)
{
    int done = SQLITE_OK;
    for (int i = 0; i < sqlite3_column_count(row) && done == SQLITE_OK; i++) {
        done = sqlite3_bind_value(m->store.insert, i + 1, sqlite3_column_value(row, i));
    }
    done = done == SQLITE_OK ? sqlite3_step(m->store.insert) : done;
    sqlite3_reset(m->store.insert);
    m->merged->runs += done == SQLITE_DONE;

    // the number of a run is its key
    return done == SQLITE_DONE ? STATUS_OK
           : done == SQLITE_CONSTRAINT
               ? fault_set(f, STATUS_BAD_ARGUMENT, "run %lld of '%s' is in another part too",
                           sqlite3_column_int64(row, 0), path)
               : database_fault(&m->store, f);
}

// Adds all rows of a part.
static status add_rows(merging *m, sweep_database *part, fault *f)
{
    sqlite3_stmt *rows;
    part->sweep = &m->plan;
    TRY(database_check_runs(part, f));

    status code = database_prepare(part, &rows, "SELECT * FROM run ORDER BY run", f);
    while (database_next(part, rows, &code, f)) {
        code = add_row(m, part->path, rows, f);
    }
    return code;
}

// Adds a part: the first one begins the merged sweep, the others must be of the same.
static status add_part(merging *m, char *path, bool first, fault *f)
{
    definition own = {.count = 0};
    sweep_database part;
    definition *d = first ? &m->definition : &own;

    // its definition, then its rows
    status code = open_part(&part, path, d, f);
    if (code == STATUS_OK) {
        code = first ? begin(m, path, f) : definition_compare(path, d, &m->definition, f);
    }
    code = code == STATUS_OK ? add_rows(m, &part, f) : code;

    definition_finish(&own);
    sqlite3_close(part.database);
    return code;
}

// The database as it would stand in a file, written whole or not at all.
static status write_database(merging *m, const char *output, fault *f)
{
    TRY(database_execute(&m->store, "COMMIT", f));

    // its bytes, as a file would have them
    sqlite3_int64 size = 0;
    unsigned char *bytes = sqlite3_serialize(m->store.database, "main", &size, 0);
    TRY_MEMORY(bytes != NULL, f);

    // into the file
    whole_file file;
    status code = whole_file_open(&file, output, f);
    if (code == STATUS_OK) {
        fwrite(bytes, 1, (size_t)size, file.stream); // errors stay in the stream
        code = whole_file_commit(&file, f);
    }
    sqlite3_free(bytes);
    return code;
}

status sweep_merge(char *const *files, int count, const char *output, sweep_merged *merged,
                   fault *f)
{
    assert(count > 0);
    merging m = {.merged = merged};
    status code = STATUS_OK;
    *merged = (sweep_merged){0};

    // the first part decides what the others must be
    for (int i = 0; i < count && code == STATUS_OK; i++) {
        code = add_part(&m, files[i], i == 0, f);
    }
    code = code == STATUS_OK ? write_database(&m, output, f) : code;

    definition_finish(&m.definition);
    sweep_finish(&m.plan);
    sqlite3_finalize(m.store.insert);
    sqlite3_close(m.store.database);
    return code;
}

#include "src/study/store/sweep_store.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "src/base/text_stream.h"
#include "src/study/store/sweep_database.h"
#include "src/base/input_file.h"
#include "src/base/whole_file.h"

// Creates the tables `sweep` and `run` and marks the database as a sweep; in a
// transaction of the caller's.
static status make_tables(sweep_database *store, fault *f)
{
    TRY(database_execute(
        store,
        "PRAGMA application_id = " APPLICATION_ID ";PRAGMA user_version = " LAYOUT ";"
        "CREATE TABLE sweep (key TEXT UNIQUE NOT NULL, value TEXT NOT NULL)",
        f));
    run_column columns[RUN_MOST_COLUMNS];
    const int count = database_columns(store->sweep, columns);
    sqlite3_str *sql = sqlite3_str_new(store->database);
    const char *separator = "CREATE TABLE run (";
    for (int i = 0; i < count; i++) {
        const char *quote = columns[i].quote != NULL ? columns[i].quote : "";
        sqlite3_str_appendf(sql, "%s%s%w%s %s", separator, quote, columns[i].told.key,
                            quote, columns[i].type);
        separator = ", ";
    }
    sqlite3_str_appendall(sql, ")");
    return database_use(store, sql, NULL, f);
}

// Prepares the statement that adds a row to `run`.
static status prepare_insert(sweep_database *store, fault *f)
{
    run_column columns[RUN_MOST_COLUMNS];
    sqlite3_str *sql = sqlite3_str_new(store->database);
    sqlite3_str_appendall(sql, "INSERT INTO run VALUES (?");
    for (int i = database_columns(store->sweep, columns); i > 1; i--) {
        sqlite3_str_appendall(sql, ", ?");
    }
    sqlite3_str_appendall(sql, ")");
    return database_use(store, sql, &store->insert, f);
}

// Adds the line that a statement stands on.
static status read_line(definition *d, const char *path, sqlite3_stmt *row, fault *f)
{
    const char *key = (const char *)sqlite3_column_text(row, 0);
    const char *value = (const char *)sqlite3_column_text(row, 1);
    if (sqlite3_errcode(sqlite3_db_handle(row)) == SQLITE_NOMEM) {
        return fault_no_memory(f);
    }
    FAULT_IF(key == NULL || value == NULL || strlen(key) >= DEFINITION_KEY ||
                 strlen(key) != (size_t)sqlite3_column_bytes(row, 0) ||
                 strlen(value) != (size_t)sqlite3_column_bytes(row, 1),
             f, STATUS_BAD_ARGUMENT,
             "'%s' has a line without text in what defines its sweep", path);
    FAULT_IF(json_object_size(d->lines) == DEFINITION_LINES ||
                 definition_value(d, key) != NULL,
             f, STATUS_BAD_ARGUMENT,
             "'%s' has more lines in what defines its sweep than this program writes",
             path);
    definition_add(d, key, "%s", value);
    if (d->code != STATUS_OK) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// Reads the definition that the database holds, as definition_init would make it;
// STATUS_BAD_ARGUMENT if this program never writes such a one. definition_finish in any
// case.
static status read_definition(sweep_database *store, definition *d, fault *f)
{
    sqlite3_stmt *rows;
    *d = (definition){.lines = json_object()};

    // as it was written, line by line; a damaged file shows at the end
    d->code =
        database_prepare(store, &rows, "SELECT key, value FROM sweep ORDER BY rowid", f);
    while (database_next(store, rows, &d->code, f)) {
        d->code = read_line(d, store->path, rows, f);
    }
    return d->code;
}

static status write_definition(sweep_database *store, const definition *d, fault *f)
{
    sqlite3_stmt *insert;
    const char *key;
    json_t *value;
    status code = database_prepare(store, &insert,
                                   "INSERT INTO sweep (key, value) VALUES (?1, ?2)", f);
    json_object_foreach(d->lines, key, value)
    {
        sqlite3_bind_text(insert, 1, key, -1, SQLITE_STATIC);
        sqlite3_bind_text(insert, 2, json_string_value(value), -1, SQLITE_STATIC);
        if (code == STATUS_OK && sqlite3_step(insert) != SQLITE_DONE) {
            code = database_fault(store, f);
        }
        sqlite3_reset(insert);
    }
    sqlite3_finalize(insert);
    return code;
}

// Creates the tables and writes the definition, all in one transaction.
static status create_tables(sweep_database *store, const definition *d, fault *f)
{
    status code = database_execute(store, "BEGIN IMMEDIATE", f);
    if (code == STATUS_OK) {
        code = make_tables(store, f);
    }
    if (code == STATUS_OK) {
        code = write_definition(store, d, f);
    }
    if (code == STATUS_OK) {
        code = database_execute(store, "COMMIT", f);
    }

    if (code != STATUS_OK) {
        sqlite3_exec(store->database, "ROLLBACK", NULL, NULL, NULL);
    }
    return code;
}

// STATUS_OK if the definition that the database holds is the sweep's.
static status check_definition(sweep_database *store, fault *f)
{
    SCOPED(definition_finish) definition was = {.lines = NULL};
    SCOPED(definition_finish) definition now = {.lines = NULL};
    TRY(definition_init(&now, store->sweep, f));
    TRY(read_definition(store, &was, f));
    return definition_compare(store->path, &was, &now, f);
}

// Continues the sweep that the database holds, or starts it in an empty one.
static status adopt(sweep_database *store, fault *f)
{
    bool empty;
    TRY(database_recognise(store, &empty, f));

    // what lies outside is looked at before it is read: later it can only be newer
    definition_stamp(store->sweep, store->stamp);
    if (!empty) {
        TRY(check_definition(store, f));
        return database_check_runs(store, &store->store.count, f);
    }
    SCOPED(definition_finish) definition now = {.lines = NULL};
    TRY(definition_init(&now, store->sweep, f));
    return create_tables(store, &now, f);
}

// STATUS_OK if what the runs read from outside is what it was when the store was opened.
static status check_outside(sweep_database *store, fault *f)
{
    char stamp[SHA256_TEXT];
    if (store->path == NULL) {
        return STATUS_OK;
    }
    definition_stamp(store->sweep, stamp);
    if (strcmp(stamp, store->stamp) != 0) {
        // written to, but perhaps with the same content
        TRY(check_definition(store, f));
        memcpy(store->stamp, stamp, sizeof stamp);
    }
    return STATUS_OK;
}

// Keeps a second sweep from writing to the same file. The descriptor stays open as long
// as the database: closing it earlier would drop the database's own locks on the file.
static status lock_file(sweep_database *store, fault *f)
{
    fault why = {0};
    if (input_file_check_plain(store->path, &why) != STATUS_OK) {
        return input_file_fault(store->path, &why, f);
    }
    store->lock = open(store->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    FAULT_IF(store->lock < 0, f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s",
             store->path, strerror(errno));

    FAULT_IF(flock(store->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK, f,
             STATUS_CANNOT_WRITE, "another sweep is writing to '%s' just now",
             store->path);
    return STATUS_OK;
}

// Opens the file, or memory, and what the sweep needs of it.
static status open_database(sweep_database *store, fault *f)
{
    if (store->path != NULL) {
        TRY(lock_file(store, f));
    }
    TRY(database_open(store, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, f));

    // what is kept in memory nobody goes on with; somebody may be reading the results in
    // a file
    sqlite3_busy_timeout(store->database, 10000);
    if (store->path == NULL) {
        TRY(make_tables(store, f));
    } else {
        TRY(adopt(store, f));
    }
    return prepare_insert(store, f);
}

status sweep_store_open(sweep_store **opened, const char *path, const sweep *s, fault *f)
{
    sweep_database *store = calloc(1, sizeof *store);
    *opened = NULL;
    if (store == NULL) {
        return fault_no_memory(f);
    }

    store->store = (sweep_store){.put = sweep_store_put,
                                 .commit = sweep_store_commit,
                                 .values = sweep_store_values};
    store->sweep = s;
    store->lock = -1;

    // a plain name that begins with a colon would mean something else to the database
    status code = STATUS_OK;
    if (path != NULL &&
        asprintf(&store->path, "%s%s", path[0] == ':' ? "./" : "", path) < 0) {
        store->path = NULL;
        code = fault_no_memory(f);
    }

    if (code == STATUS_OK) {
        code = open_database(store, f);
    }
    if (code != STATUS_OK) {
        sweep_store_close(&store->store);
        return code;
    }
    *opened = &store->store;
    return STATUS_OK;
}

void sweep_store_close(sweep_store *closed)
{
    if (closed == NULL) {
        return;
    }
    sweep_database *store = database_of(closed);
    if (store->in_transaction) {
        loss_unless(sweep_store_commit(closed, NULL) == STATUS_OK);
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

status sweep_store_commit(sweep_store *of, fault *f)
{
    sweep_database *store = database_of(of);
    if (!store->in_transaction) {
        return STATUS_OK;
    }

    // runs that may have read something else are not kept
    status code = check_outside(store, f);
    if (code != STATUS_OK) {
        sqlite3_exec(store->database, "ROLLBACK", NULL, NULL, NULL);
        store->in_transaction = false;
        return code;
    }
    code = database_execute(store, "COMMIT", f);
    store->in_transaction = code != STATUS_OK;

    // SQLite looks at the beginning of a transaction whether the file is still there
    int moved = 0;
    sqlite3_file_control(store->database, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    if (code != STATUS_OK || !moved) {
        return code;
    }
    return database_moved_fault(store, f);
}

// --- parts of one sweep, computed apart, together in one database ----------------------

// The merged sweep while it grows: in the temporary that becomes the output, so that it
// takes no memory; where there is none, since the output is a pipe or a device, in
// memory.
typedef struct merging {
    whole_file file;
    sweep plan;            // which values each run has
    definition definition; // of the first part; all others are compared with it
    sweep_database store;
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
    if (empty) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is empty, expected a part of a sweep", path);
    }
    return read_definition(part, d, f);
}

// Begins the merged sweep with the definition of its first part, which it takes over.
static status begin_merged(merging *m, const char *path, fault *f)
{
    status code = definition_plan(&m->definition, path, &m->plan, f);
    m->merged->total = m->plan.run_count;
    m->store = (sweep_database){.sweep = &m->plan, .lock = -1};
    if (m->file.temporary[0] != '\0') {
        m->store.path = m->file.temporary;
        m->store.told = m->file.path;
    }
    TRY(code);
    TRY(database_open(&m->store, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, f));

    // what fails is thrown away, and what is whole is brought to the disk at the end
    TRY(database_execute(&m->store,
                         "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF", f));
    TRY(database_execute(&m->store, "BEGIN", f));
    TRY(make_tables(&m->store, f));
    TRY(write_definition(&m->store, &m->definition, f));
    return prepare_insert(&m->store, f);
}

// Adds the row that a statement stands on.
static status copy_row(merging *m, const char *path, sqlite3_stmt *row, fault *f)
{
    int done = SQLITE_OK;
    for (int i = 0; i < sqlite3_column_count(row) && done == SQLITE_OK; i++) {
        done = sqlite3_bind_value(m->store.insert, i + 1, sqlite3_column_value(row, i));
    }
    if (done == SQLITE_OK) {
        done = sqlite3_step(m->store.insert);
    }
    sqlite3_reset(m->store.insert);
    if (done == SQLITE_DONE) {
        m->merged->runs++;
    }

    // the number of a run is its key
    if (done == SQLITE_DONE) {
        return STATUS_OK;
    }
    if (done == SQLITE_CONSTRAINT) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "run %lld of '%s' is in another part too",
                         sqlite3_column_int64(row, 0), path);
    }
    return database_fault(&m->store, f);
}

// Adds all rows of a part.
static status copy_rows(merging *m, sweep_database *part, fault *f)
{
    sqlite3_stmt *rows;
    size_t count;
    part->sweep = &m->plan;
    TRY(database_check_runs(part, &count, f));

    status code = database_prepare(part, &rows, "SELECT * FROM run ORDER BY run", f);
    while (database_next(part, rows, &code, f)) {
        code = copy_row(m, part->path, rows, f);
    }
    return code;
}

// Adds a part: the first one begins the merged sweep, the others must be of the same.
static status add_part(merging *m, char *path, bool first, fault *f)
{
    SCOPED(definition_finish) definition own = {.lines = NULL};
    sweep_database part;
    definition *d = first ? &m->definition : &own;

    // its definition, then its rows
    status code = open_part(&part, path, d, f);
    if (code == STATUS_OK) {
        if (first) {
            code = begin_merged(m, path, f);
        } else {
            code = definition_compare(path, d, &m->definition, f);
        }
    }
    if (code == STATUS_OK) {
        code = copy_rows(m, &part, f);
    }
    sqlite3_close(part.database);
    return code;
}

// Writes the database in memory as it would stand in a file.
static status write_database(merging *m, fault *f)
{
    sqlite3_int64 size = 0;
    unsigned char *bytes = sqlite3_serialize(m->store.database, "main", &size, 0);
    if (bytes == NULL) {
        return fault_no_memory(f);
    }

    fwrite(bytes, 1, (size_t)size, m->file.stream); // errors stay in the stream
    sqlite3_free(bytes);
    return STATUS_OK;
}

// Adds all parts; the first one decides what the others must be.
static status merge_parts(merging *m, char *const *files, int count, fault *f)
{
    for (int i = 0; i < count; i++) {
        TRY(add_part(m, files[i], i == 0, f));
    }
    TRY(database_execute(&m->store, "COMMIT", f));
    if (m->store.path == NULL) {
        return write_database(m, f);
    }
    return STATUS_OK;
}

status sweep_merge(char *const *files, int count, const char *output,
                   sweep_merged *merged, fault *f)
{
    assert(count > 0);
    merging m = {.merged = merged};
    *merged = (sweep_merged){0};
    TRY(whole_file_open(&m.file, output, f));
    const status code = merge_parts(&m, files, count, f);

    // the database is closed before its file is put into its place
    definition_finish(&m.definition);
    sweep_finish(&m.plan);
    sqlite3_finalize(m.store.insert);
    sqlite3_close(m.store.database);
    return whole_file_close(&m.file, code, f);
}

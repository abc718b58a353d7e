#include "src/study/sweep_store.h"
#include "src/base/numbers.h"
#include "src/base/csv.h"
#include "src/base/version.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <unistd.h>

// Marks a database as ours (PRAGMA application_id): "ILSw". The layout's version is user_version.
#define APPLICATION_ID "1229738871"
#define LAYOUT         "1"

// Of the row as SELECT * gives it: number of the run, then the values, status and message.
enum { FIRST_VALUE = 1 };

struct sweep_store {
    const sweep *sweep;
    sqlite3 *database;
    sqlite3_stmt *insert;
    char *path; // NULL: in memory
    int lock;   // descriptor that holds the lock, -1 if there is none
    bool in_transaction;
};

static status no_memory(fault *f)
{
    return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
}

// What the database complains about, as a fault.
static status database_fault(const sweep_store *store, fault *f)
{
    int code = sqlite3_errcode(store->database) & 0xFF;
    const char *why = sqlite3_errmsg(store->database);
    const char *path = store->path ? store->path : "the results in memory";
    if (code == SQLITE_NOMEM) {
        return no_memory(f);
    }
    if (code == SQLITE_NOTADB) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "'%s' is no SQLite database", path);
    }
    return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path, why);
}

static status execute(sweep_store *store, const char *sql, fault *f)
{
    return sqlite3_exec(store->database, sql, NULL, NULL, NULL) == SQLITE_OK
               ? STATUS_OK
               : database_fault(store, f);
}

static status prepare(sweep_store *store, sqlite3_stmt **statement, const char *sql, fault *f)
{
    return sqlite3_prepare_v2(store->database, sql, -1, statement, NULL) == SQLITE_OK
               ? STATUS_OK
               : database_fault(store, f);
}

// The first number that a query gives, 0 if it gives none.
static status query_number(sweep_store *store, const char *sql, long long *number, fault *f)
{
    sqlite3_stmt *statement;
    *number = 0;
    status code = prepare(store, &statement, sql, f);
    if (code == STATUS_OK && sqlite3_step(statement) == SQLITE_ROW) {
        *number = sqlite3_column_int64(statement, 0);
    }
    if (sqlite3_finalize(statement) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    return code;
}

// --- what defines a sweep -------------------------------------------------------------------

typedef struct definition_line {
    char key[64];
    char *value;
} definition_line;

typedef struct definition {
    definition_line lines[160];
    int count;
    bool out_of_memory;
} definition;

__attribute__((format(printf, 3, 4))) static void define(definition *d, const char *key,
                                                         const char *format, ...)
{
    va_list list;
    definition_line *line = &d->lines[d->count];
    if (d->count == sizeof d->lines / sizeof d->lines[0]) {
        d->out_of_memory = true;
        return;
    }
    snprintf(line->key, sizeof line->key, "%s", key);
    va_start(list, format);
    if (vasprintf(&line->value, format, list) < 0) {
        line->value = NULL;
        d->out_of_memory = true;
    } else {
        d->count++;
    }
    va_end(list);
}

static bool is_varied(const sweep *s, int parameter)
{
    for (int i = 0; i < s->axis_count; i++) {
        if (s->axes[i].parameter == parameter) {
            return true;
        }
    }
    return false;
}

// Parameters that keep their value, and which of them were given (the others follow arm.model).
static void define_parameters(definition *d, const sweep *s)
{
    const parameters *p = &s->base->parameters;
    char given[4096] = "";
    for (int i = 0; i < parameter_count; i++) {
        char text[128];
        if (is_varied(s, i)) {
            continue;
        }
        parameter_format(p, i, text, sizeof text);
        define(d, parameter_table[i].path, "%s", text);
        if (p->set[i]) {
            size_t length = strlen(given);
            snprintf(given + length, sizeof given - length, "%s%s", length > 0 ? " " : "",
                     parameter_table[i].path);
        }
    }
    define(d, "given", "%s", given);
}

static void define_script(definition *d, const scenario *s)
{
    char *text = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    if (stream == NULL) {
        d->out_of_memory = true;
        return;
    }
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        bool push = a->kind == ACTION_PUSH;
        char time[NUMBER_TEXT], value[NUMBER_TEXT];
        number_format(time, a->time);
        number_format(value, a->value);
        bool text_valued = !push && parameter_table[a->parameter].type == PARAMETER_TEXT;
        fprintf(stream, "%sat %s %s = %s", i > 0 ? "; " : "", time,
                push ? "push" : parameter_table[a->parameter].path, text_valued ? a->text : value);
    }
    if (fclose(stream) == 0) {
        define(d, "script", "%s", text);
    } else {
        d->out_of_memory = true;
    }
    free(text);
}

static void definition_init(definition *d, const sweep *s)
{
    memset(d, 0, sizeof *d);
    define(d, "version", "%s", lab_version());
    define(d, "scenario", "%s", s->base->name);
    define(d, "sample", "%s", sweep_sampling_name(s->sampling));
    define(d, "runs", "%zu", s->run_count);
    if (s->sampling != SWEEP_GRID) {
        define(d, "seed", "%llu", (unsigned long long)s->seed);
    }
    for (int i = 0; i < s->axis_count; i++) {
        char key[16];
        snprintf(key, sizeof key, "vary %d", i + 1);
        define(d, key, "%s=%s", parameter_table[s->axes[i].parameter].path, s->axes[i].text);
    }
    define_script(d, s->base);
    define_parameters(d, s);
}

static void definition_finish(definition *d)
{
    for (int i = 0; i < d->count; i++) {
        free(d->lines[i].value);
    }
}

static const char *definition_value(const definition *d, const char *key)
{
    for (int i = 0; i < d->count; i++) {
        if (strcmp(d->lines[i].key, key) == 0) {
            return d->lines[i].value;
        }
    }
    return NULL;
}

static status read_definition(sweep_store *store, definition *d, fault *f)
{
    sqlite3_stmt *rows;
    memset(d, 0, sizeof *d);
    status code = prepare(store, &rows, "SELECT key, value FROM sweep ORDER BY rowid", f);
    while (code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        define(d, (const char *)sqlite3_column_text(rows, 0), "%s", sqlite3_column_text(rows, 1));
    }
    if (sqlite3_finalize(rows) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    return code;
}

// Adds one difference to the sentence; beyond the first few they are only counted.
static void add_difference(char *text, size_t size, int *count, const char *key, const char *was,
                           const char *now)
{
    enum { SHOWN = 4 };
    size_t length = strlen(text);
    if ((*count)++ < SHOWN) {
        snprintf(text + length, size - length, "%s%s%s was %.80s, now it is %.80s",
                 *count > 1 ? "; " : "", strncmp(key, "vary", 4) == 0 ? "--" : "", key,
                 was == NULL   ? "not there"
                 : was[0] == 0 ? "empty"
                               : was,
                 now == NULL   ? "not there"
                 : now[0] == 0 ? "empty"
                               : now);
    }
}

// The same scenario may be called by another name (a file seen from another folder): what it says
// is compared, not its name.
static bool is_compared(const char *key)
{
    return strcmp(key, "scenario") != 0;
}

static status compare_definitions(const char *path, const definition *was, const definition *now,
                                  fault *f)
{
    char text[900] = "";
    int count = 0;
    for (int i = 0; i < now->count; i++) {
        const char *key = now->lines[i].key, *before = definition_value(was, key);
        // which parameters were given is worth saying only if all values are the same
        bool aside = !is_compared(key) || (count > 0 && strcmp(key, "given") == 0);
        if (!aside && (before == NULL || strcmp(before, now->lines[i].value) != 0)) {
            add_difference(text, sizeof text, &count, key, before, now->lines[i].value);
        }
    }
    for (int i = 0; i < was->count; i++) {
        if (definition_value(now, was->lines[i].key) == NULL) {
            add_difference(text, sizeof text, &count, was->lines[i].key, was->lines[i].value, NULL);
        }
    }
    if (count == 0) {
        return STATUS_OK;
    }
    return fault_set(f, STATUS_BAD_ARGUMENT, "'%.200s' holds another sweep: %s%s", path, text,
                     count > 4 ? "; and more" : "");
}

// --- opening --------------------------------------------------------------------------------

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
    status code = text ? execute(store, text, f) : no_memory(f);
    sqlite3_free(text);
    return code;
}

static status write_definition(sweep_store *store, const definition *d, fault *f)
{
    sqlite3_stmt *insert;
    status code = prepare(store, &insert, "INSERT INTO sweep (key, value) VALUES (?1, ?2)", f);
    for (int i = 0; i < d->count && code == STATUS_OK; i++) {
        sqlite3_bind_text(insert, 1, d->lines[i].key, -1, SQLITE_STATIC);
        sqlite3_bind_text(insert, 2, d->lines[i].value, -1, SQLITE_STATIC);
        if (sqlite3_step(insert) != SQLITE_DONE) {
            code = database_fault(store, f);
        }
        sqlite3_reset(insert);
    }
    sqlite3_finalize(insert);
    return code;
}

// Creates the tables and writes the definition, all in one transaction.
static status create_tables(sweep_store *store, const definition *d, fault *f)
{
    status code = execute(store,
                          "BEGIN IMMEDIATE;"
                          "PRAGMA application_id = " APPLICATION_ID ";"
                          "PRAGMA user_version = " LAYOUT ";"
                          "CREATE TABLE sweep (key TEXT UNIQUE NOT NULL, value TEXT NOT NULL)",
                          f);
    code = code == STATUS_OK ? create_run_table(store, f) : code;
    code = code == STATUS_OK ? write_definition(store, d, f) : code;
    code = code == STATUS_OK ? execute(store, "COMMIT", f) : code;
    if (code != STATUS_OK) {
        sqlite3_exec(store->database, "ROLLBACK", NULL, NULL, NULL);
    }
    return code;
}

// True in *empty if the database holds nothing; a fault if what it holds is no sweep of ours.
static status recognise(sweep_store *store, bool *empty, fault *f)
{
    long long tables, mark = 0, layout = 0;
    status code = query_number(store, "SELECT count(*) FROM sqlite_master", &tables, f);
    *empty = tables == 0;
    if (code == STATUS_OK && !*empty) {
        code = query_number(store, "PRAGMA application_id", &mark, f);
        code = code == STATUS_OK ? query_number(store, "PRAGMA user_version", &layout, f) : code;
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
        code = no_memory(f);
    } else if (empty) {
        code = create_tables(store, &now, f);
    } else {
        code = read_definition(store, &was, f);
        if (code == STATUS_OK) {
            code =
                was.out_of_memory ? no_memory(f) : compare_definitions(store->path, &was, &now, f);
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

static status prepare_insert(sweep_store *store, fault *f)
{
    sqlite3_str *sql = sqlite3_str_new(store->database);
    int columns = FIRST_VALUE + store->sweep->axis_count + 2 + summary_count;
    sqlite3_str_appendall(sql, "INSERT INTO run VALUES (?");
    for (int i = 1; i < columns; i++) {
        sqlite3_str_appendall(sql, ", ?");
    }
    sqlite3_str_appendall(sql, ")");
    char *text = sqlite3_str_finish(sql);
    status code = text ? prepare(store, &store->insert, text, f) : no_memory(f);
    sqlite3_free(text);
    return code;
}

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
        return store->database ? database_fault(store, f) : no_memory(f);
    }
    // somebody may be reading the results of a sweep that goes on
    sqlite3_busy_timeout(store->database, 10000);
    status code = adopt(store, f);
    return code == STATUS_OK ? prepare_insert(store, f) : code;
}

status sweep_store_open(sweep_store **opened, const char *path, const sweep *s, fault *f)
{
    sweep_store *store = calloc(1, sizeof *store);
    *opened = NULL;
    if (store == NULL) {
        return no_memory(f);
    }
    store->sweep = s;
    store->lock = -1;
    status code = STATUS_OK;
    // a plain name that begins with a colon would mean something else to the database
    if (path != NULL && asprintf(&store->path, "%s%s", path[0] == ':' ? "./" : "", path) < 0) {
        store->path = NULL;
        code = no_memory(f);
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

// --- rows -----------------------------------------------------------------------------------

status sweep_store_present(sweep_store *store, unsigned char *present, size_t *count, fault *f)
{
    sqlite3_stmt *rows;
    size_t total = store->sweep->run_count;
    memset(present, 0, total);
    *count = 0;
    status code = prepare(store, &rows, "SELECT run FROM run", f);
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

static void bind_row(sweep_store *store, size_t run, const summary *result)
{
    const sweep *s = store->sweep;
    sqlite3_stmt *row = store->insert;
    int column = 1;
    sqlite3_bind_int64(row, column++, (sqlite3_int64)run + 1);
    for (int i = 0; i < s->axis_count; i++) {
        parameter_type type = parameter_table[s->axes[i].parameter].type;
        if (type == PARAMETER_CHOICE || type == PARAMETER_BOOLEAN) {
            char text[128];
            sweep_value_text(s, run, i, text, sizeof text);
            sqlite3_bind_text(row, column++, text, -1, SQLITE_TRANSIENT);
        } else {
            sqlite3_bind_double(row, column++, sweep_value(s, run, i));
        }
    }
    sqlite3_bind_text(row, column++, result->status == STATUS_OK ? "ok" : "failed", -1,
                      SQLITE_STATIC);
    sqlite3_bind_text(row, column++, result->message, -1, SQLITE_TRANSIENT);
    for (int i = 0; i < summary_count; i++) {
        double value = (double)NAN;
        summary_get(result, summary_table[i].key, &value);
        bind_number(row, column++, value);
    }
}

status sweep_store_put(sweep_store *store, size_t run, const summary *result, fault *f)
{
    if (!store->in_transaction) {
        status code = execute(store, "BEGIN IMMEDIATE", f);
        if (code != STATUS_OK) {
            return code;
        }
        store->in_transaction = true;
    }
    bind_row(store, run, result);
    int done = sqlite3_step(store->insert);
    status code = done == SQLITE_DONE ? STATUS_OK : database_fault(store, f);
    sqlite3_reset(store->insert);
    return code;
}

status sweep_store_commit(sweep_store *store, fault *f)
{
    if (!store->in_transaction) {
        return STATUS_OK;
    }
    status code = execute(store, "COMMIT", f);
    store->in_transaction = code != STATUS_OK;
    return code;
}

status sweep_store_quantity(sweep_store *store, const char *key, double *values, size_t *failed,
                            fault *f)
{
    size_t total = store->sweep->run_count, failures = 0;
    sqlite3_stmt *rows = NULL;
    for (size_t i = 0; i < total; i++) {
        values[i] = (double)NAN;
    }
    char *sql = sqlite3_mprintf("SELECT run, status, \"%w\" FROM run", key);
    status code = sql ? prepare(store, &rows, sql, f) : no_memory(f);
    while (code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        bool ok = strcmp((const char *)sqlite3_column_text(rows, 1), "ok") == 0;
        failures += !ok;
        if (ok && sqlite3_column_type(rows, 2) != SQLITE_NULL) {
            values[sqlite3_column_int64(rows, 0) - 1] = sqlite3_column_double(rows, 2);
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

// --- CSV ------------------------------------------------------------------------------------

static void write_headings(csv_writer *csv, const sweep *s)
{
    csv_heading(csv, "run", "");
    for (int i = 0; i < s->axis_count; i++) {
        const parameter_info *info = &parameter_table[s->axes[i].parameter];
        csv_heading(csv, info->path, info->unit);
    }
    csv_heading(csv, "status", "");
    csv_heading(csv, "message", "");
    for (int i = 0; i < summary_count; i++) {
        if (!summary_table[i].timing) {
            char name[64];
            const char *unit;
            quantity_name(summary_table[i].key, name, sizeof name, &unit);
            csv_heading(csv, name, unit);
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

status sweep_store_csv(sweep_store *store, FILE *stream, fault *f)
{
    sqlite3_stmt *rows;
    int first_quantity = FIRST_VALUE + store->sweep->axis_count + 2;
    status code = prepare(store, &rows, "SELECT * FROM run ORDER BY run", f);
    if (code != STATUS_OK) {
        return code;
    }

    csv_writer csv = csv_begin(stream);
    write_headings(&csv, store->sweep);
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

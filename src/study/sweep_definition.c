#include "src/study/sweep_definition.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/base/version.h"

// Adds a line; printf-like.
__attribute__((format(printf, 3, 4))) static void define(definition *d, const char *key,
                                                         const char *format, ...)
{
    va_list list;
    definition_line *line = &d->lines[d->count];

    // more lines than any sweep has count as too much
    if (d->count == sizeof d->lines / sizeof d->lines[0]) {
        d->out_of_memory = true;
        return;
    }

    // a value may be long: it has memory of its own
    snprintf(line->key, sizeof line->key, "%s", key);
    va_start(list, format);
    line->value = decimal_vtext(format, list);
    if (line->value == NULL) {
        d->out_of_memory = true;
    } else {
        d->count++;
    }
    va_end(list);
}

static bool is_varied(const sweep *s, int parameter)
{
    for (int i = 0; i < s->axis_count; i++) {
        if (s->axes[i].parameter == parameter && s->axes[i].element == 0) {
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

        // its value, and that it was given
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

// The script in one line.
static void define_script(definition *d, const scenario *s)
{
    text_stream line;
    if (!text_stream_open(&line)) {
        d->out_of_memory = true;
        return;
    }

    // action by action, in their order
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        bool push = a->kind == ACTION_PUSH;
        char time[NUMBER_TEXT], value[NUMBER_TEXT];
        number_format(time, a->time);
        number_format(value, a->value);
        bool text_valued = !push && parameter_is_text(&parameter_table[a->parameter]);
        fprintf(line.stream, "%sat %s %s = %s", i > 0 ? "; " : "", time,
                push ? "push" : parameter_table[a->parameter].path, text_valued ? a->text : value);
    }

    // closing it shows whether there was memory
    char *text = text_stream_close(&line, NULL);
    if (text != NULL) {
        define(d, "script", "%s", text);
    } else {
        d->out_of_memory = true;
    }
    free(text);
}

void definition_init(definition *d, const sweep *s)
{
    assert(d != NULL && s != NULL);
    memset(d, 0, sizeof *d);

    // what is varied, and how
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
        define(d, key, "%s=%s", s->axes[i].name, s->axes[i].text);
    }

    // what stays
    define_script(d, s->base);
    define_parameters(d, s);
}

void definition_finish(definition *d)
{
    assert(d != NULL);
    for (int i = 0; i < d->count; i++) {
        free(d->lines[i].value);
    }
}

const char *definition_value(const definition *d, const char *key)
{
    assert(d != NULL && key != NULL);
    for (int i = 0; i < d->count; i++) {
        if (strcmp(d->lines[i].key, key) == 0) {
            return d->lines[i].value;
        }
    }
    return NULL;
}

status definition_read(sweep_store *store, definition *d, fault *f)
{
    assert(store != NULL && d != NULL);
    sqlite3_stmt *rows;
    memset(d, 0, sizeof *d);

    // as it was written, line by line
    status code = database_prepare(store, &rows, "SELECT key, value FROM sweep ORDER BY rowid", f);
    while (code == STATUS_OK && sqlite3_step(rows) == SQLITE_ROW) {
        const char *key = (const char *)sqlite3_column_text(rows, 0);
        const char *value = (const char *)sqlite3_column_text(rows, 1);
        if (key == NULL || value == NULL) {
            code = fault_set(f, STATUS_BAD_ARGUMENT,
                             "'%s' has a line without text in what defines its sweep", store->path);
            break;
        }
        define(d, key, "%s", value);
    }

    // a damaged file shows at the end
    if (sqlite3_finalize(rows) != SQLITE_OK && code == STATUS_OK) {
        code = database_fault(store, f);
    }
    return code;
}

status definition_write(sweep_store *store, const definition *d, fault *f)
{
    assert(store != NULL && d != NULL);
    sqlite3_stmt *insert;

    // in the order in which they were defined
    status code =
        database_prepare(store, &insert, "INSERT INTO sweep (key, value) VALUES (?1, ?2)", f);

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

// Adds one difference to the sentence; beyond the first few they are only counted.
static void add_difference(char *text, size_t size, int *count, const char *key, const char *was,
                           const char *now)
{
    enum { SHOWN = 4 };
    size_t length = strlen(text);

    // named as the user gives it: an axis is an option
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

status definition_compare(const char *path, const definition *was, const definition *now, fault *f)
{
    assert(path != NULL && was != NULL && now != NULL);
    char text[900] = "";
    int count = 0;

    // what is new or another value
    for (int i = 0; i < now->count; i++) {
        const char *key = now->lines[i].key, *before = definition_value(was, key);
        // which parameters were given is worth saying only if all values are the same
        bool aside = !is_compared(key) || (count > 0 && strcmp(key, "given") == 0);
        if (!aside && (before == NULL || strcmp(before, now->lines[i].value) != 0)) {
            add_difference(text, sizeof text, &count, key, before, now->lines[i].value);
        }
    }

    // what is gone
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

void definition_digest(const definition *d, char digest[SHA256_TEXT])
{
    assert(d != NULL && digest != NULL);
    sha256 h;
    sha256_init(&h);
    for (int i = 0; i < d->count; i++) {
        sha256_add(&h, d->lines[i].key, strlen(d->lines[i].key) + 1);
        sha256_add(&h, d->lines[i].value, strlen(d->lines[i].value) + 1);
    }
    sha256_finish(&h, digest);
}

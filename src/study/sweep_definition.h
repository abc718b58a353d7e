// What defines a sweep, as keys and values: a database holds it, and a sweep goes on in
// the database of an equal definition only.
#pragma once

#include <jansson.h>

#include "src/base/sha256.h"
#include "src/study/sweep.h"

enum { DEFINITION_LINES = 256, DEFINITION_KEY = 64 }; // at most, and a key with its end

typedef struct definition {
    json_t *lines; // a text under each key, in their order
    status code;   // STATUS_OK, or why it is incomplete
} definition;

// The definition of a sweep: version, scenario, sampling, seed, what is varied, every
// other parameter, the script, and a digest of all that its runs read from outside.
// STATUS_NO_MEMORY, or STATUS_CANNOT_READ where that cannot be read. definition_finish in
// any case.
status definition_init(definition *d, const sweep *s, fault *f);
void definition_finish(definition *d);

// outside_stamp of all that the sweep's runs read.
void definition_stamp(const sweep *s, char stamp[SHA256_TEXT]);

// Adds a line, its value printf-like; without memory d->code says so.
void definition_add(definition *d, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// The plan of the sweep that the definition in the database at `path` is of: which values
// each run has. STATUS_BAD_ARGUMENT if it is of none; else sweep_finish.
status definition_plan(const definition *d, const char *path, sweep *plan, fault *f);

// The value of a key, NULL if the definition has none.
const char *definition_value(const definition *d, const char *key);

// STATUS_BAD_ARGUMENT if the definition in the database at `path` is not that of now, or
// it cannot be told whether the runs read the same from outside; f says in what they
// differ.
status definition_compare(const char *path, const definition *was, const definition *now,
                          fault *f);

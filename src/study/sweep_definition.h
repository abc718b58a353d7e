// What defines a sweep, as keys and values: a database holds it, and a sweep goes on in the
// database of an equal definition only.
#pragma once

#include "src/base/sha256.h"
#include "src/study/sweep_database.h"

typedef struct definition_line {
    char key[64];
    char *value;
} definition_line;

typedef struct definition {
    definition_line lines[160];
    int count;
    bool out_of_memory;
} definition;

// The definition of a sweep: version, scenario, sampling, seed, what is varied, every other
// parameter and the script. definition_finish in any case; out_of_memory says if it is incomplete.
void definition_init(definition *d, const sweep *s);
void definition_finish(definition *d);

// A text that two definitions share only if they are equal (SHA-256 of their lines).
void definition_digest(const definition *d, char digest[SHA256_TEXT]);

// Reads the definition that the database holds, with the same remarks.
status definition_read(sweep_store *store, definition *d, fault *f);

// The value of a key, NULL if the definition has none.
const char *definition_value(const definition *d, const char *key);

// Writes the definition into the table `sweep`.
status definition_write(sweep_store *store, const definition *d, fault *f);

// STATUS_BAD_ARGUMENT if the definition in the database at `path` is not that of now; f says in
// what they differ.
status definition_compare(const char *path, const definition *was, const definition *now, fault *f);

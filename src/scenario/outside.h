// What a run reads from outside its scenario, by content: programs, plug-ins and files
// that parameters name. One list, for whoever must know whether a run would still be the
// same: the databases of sweeps, a session, the consent to programs.
#pragma once

#include "src/base/fault.h"
#include "src/base/sha256.h"
#include "src/tables/parameters.h"

typedef enum outside_kind {
    OUTSIDE_LIBRARY, // the path of a shared object, with a slash
    OUTSIDE_COMMAND, // words: the files that they name, and the programs that PATH finds
    OUTSIDE_FILE     // the path of a file
} outside_kind;

// A parameter that names something outside; it is read where another one has a certain
// value.
typedef struct outside_source {
    size_t parameter, chooser; // offsets in struct parameters
    double choice;             // value of the chooser
    outside_kind kind;
} outside_source;

extern const outside_source outside_table[];
extern const int outside_count;

// Whether a run with these parameters reads it; of all of them, as bits.
bool outside_is_read(const outside_source *source, const parameters *p);
unsigned outside_read(const parameters *p);

// Those that are only read, and never run, as bits.
unsigned outside_files(void);

// Whether its content can be told: not that of a command with characters that are special
// to a shell, nor of a shared object without a slash, which the system would look for.
bool outside_is_told(const outside_source *source, const parameters *p);

// STATUS_BAD_ARGUMENT if a result of the command would be written over a file that the
// parameters name, be it read in this run or not.
status outside_keep(const parameters *p, fault *f);

// The digest of a file's content. False, with the reason in errno, if it cannot be read.
bool outside_file_digest(const char *path, char digest[SHA256_TEXT]);

// The digest of what the parameter's value names, which can be told. STATUS_CANNOT_READ
// if a file cannot be read.
status outside_digest(const outside_source *source, const parameters *p,
                      char digest[SHA256_TEXT], fault *f);

// The digest of all that a run with these parameters reads and that can be told; empty if
// that is nothing.
void outside_digest_all(const parameters *p, char digest[SHA256_TEXT]);

// A text that is another one if a file that one of these sources names is: quick, as of a
// large file it takes in only when it was written, and one written again with the same
// content for another. What cannot be told counts as the same. `sources` has bit i for
// outside_table[i].
void outside_stamp(unsigned sources, const parameters *p, char stamp[SHA256_TEXT]);

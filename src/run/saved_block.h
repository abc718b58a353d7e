// Blocks of bytes that are kept and come back: the state of a loop (src/run/run_loop.h),
// a whole run (src/run/saved_run.h). Each begins with a head that says what it is, and
// bytes that are no whole block of the same origin are refused.
#pragma once

#include <stdint.h>

#include "src/scenario/scenario.h"

// A kind of block.
typedef struct block_kind {
    char magic[8];
    uint64_t layout;  // version of what follows the head
    const char *name; // for people, "state of a loop"
} block_kind;

typedef struct block_head {
    char magic[8];
    uint64_t layout;
    uint64_t size;   // of the whole block [bytes]
    uint64_t origin; // hash of what it was made from
    uint64_t check;  // checksum of what follows the head
} block_head;

// A hash of the program's version and of a scenario's parameters and script.
uint64_t block_origin(const scenario *s);
// The same continued with a text.
uint64_t block_origin_with(uint64_t origin, const char *text);

// Writes the head of a block whose other bytes are there.
void block_seal(void *bytes, size_t size, const block_kind *kind, uint64_t origin);

// STATUS_BAD_ARGUMENT, with a sentence in f, unless the bytes are what block_seal left.
status block_check(const void *bytes, size_t size, const block_kind *kind,
                   uint64_t origin, fault *f);

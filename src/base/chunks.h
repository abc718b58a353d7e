// Memory in chunks behind addresses that were kept free for it, one chunk at two places
// if need be. Linux alone can do that: on another machine chunks_plain.c stands in the
// place of chunks.c and has none.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { ARRAY_CHUNK = 128 * 1024 }; // [bytes]

// Whether there are chunks on this machine; without them nothing else here is called but
// machine_memory.
bool chunks_exist(void);

// The memory of the machine [bytes], HUGE_VAL where that is not known.
double machine_memory(void);

// Address space that a program may take in all [bytes].
size_t chunks_address_space(void);

// Keeps addresses free, in bytes; NULL if there are not as many. chunks_release gives
// them back with all memory that is behind them.
void *chunks_reserve(size_t size);
void chunks_release(void *base, size_t size);

// Puts a chunk of its own at a place within them, or the memory of another chunk. False
// if there is no memory.
bool chunks_put(void *at);
bool chunks_put_again(void *at, void *chunk);

#include "src/base/shared_array.h"

#include <assert.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { LEAST_ELEMENTS = 64 };

// Memory that arrays map side by side, so that their elements are an ordinary array. It goes back
// when the last mapping of it does.
struct array_chunk {
    atomic_size_t users; // arrays that have it
};

static atomic_size_t memory; // of all chunks [bytes]

size_t shared_array_memory(void)
{
    return atomic_load(&memory);
}

// --- chunks -----------------------------------------------------------------------------------

// Makes room for the number of one more chunk.
static bool reserve_number(shared_array *a)
{
    if (a->chunk_count < a->chunk_capacity) {
        return true;
    }
    size_t capacity = a->chunk_capacity ? 2 * a->chunk_capacity : 16;
    array_chunk **chunks = realloc(a->chunks, capacity * sizeof *chunks);
    if (chunks == NULL) {
        return false;
    }
    a->chunks = chunks;
    a->chunk_capacity = capacity;
    return true;
}

// Maps memory of its own at a place; NULL if there is none to be had.
static array_chunk *map_chunk(void *at)
{
    array_chunk *chunk = malloc(sizeof *chunk);
    bool mapped = chunk != NULL && mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE,
                                        MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == at;

    // memory is asked for here, where its want is an error and not a signal; an old kernel cannot
    mapped = mapped && (madvise(at, ARRAY_CHUNK, MADV_POPULATE_WRITE) == 0 || errno == EINVAL);
    if (!mapped) {
        free(chunk);
        return NULL;
    }
    atomic_init(&chunk->users, 0);
    atomic_fetch_add(&memory, ARRAY_CHUNK);
    return chunk;
}

// Puts a chunk behind the end of an array: memory of its own, or that of the same chunk of `from`.
static bool append_chunk(shared_array *a, const shared_array *from)
{
    const size_t place = a->chunk_count * ARRAY_CHUNK;
    char *at = (char *)a->base + place, *there = from != NULL ? (char *)from->base + place : NULL;
    if (place + ARRAY_CHUNK > a->reserved || !reserve_number(a)) {
        return false;
    }

    // memory of the size 0 that becomes larger is mapped a second time; valgrind knows no such call
    // and gets a copy
    array_chunk *chunk = NULL;
    if (from != NULL &&
        mremap(there, 0, ARRAY_CHUNK, MREMAP_MAYMOVE | MREMAP_FIXED, at) != MAP_FAILED) {
        chunk = from->chunks[a->chunk_count];
    } else if (from == NULL || errno == EINVAL) {
        chunk = map_chunk(at);
        if (chunk != NULL && from != NULL) {
            memcpy(at, there, ARRAY_CHUNK);
        }
    }
    if (chunk == NULL) {
        return false;
    }

    atomic_fetch_add(&chunk->users, 1);
    a->chunks[a->chunk_count++] = chunk;
    a->capacity = a->chunk_count * ARRAY_CHUNK / a->size;
    return true;
}

// --- arrays ----------------------------------------------------------------------------------

void shared_array_init(shared_array *a, size_t size)
{
    assert(size > 0);
    *a = (shared_array){.size = size};
}

static size_t whole_chunks(size_t elements, size_t size)
{
    return (elements * size / ARRAY_CHUNK + 1) * ARRAY_CHUNK;
}

bool shared_array_reserve(shared_array *a, size_t size, size_t least, size_t most)
{
    assert(least > 0 && least <= most);
    shared_array_init(a, size);

    // half as much where the address space has no room for the most
    for (; most >= least; most /= 2) {
        size_t reserved = whole_chunks(most, size);
        void *base =
            mmap(NULL, reserved, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (base != MAP_FAILED) {
            a->base = base;
            a->reserved = reserved;
            return true;
        }
    }
    return false;
}

static bool grow_plain(shared_array *a, size_t count)
{
    size_t capacity = a->capacity ? 2 * a->capacity : LEAST_ELEMENTS;
    capacity = capacity < count ? count : capacity;
    void *base = realloc(a->base, capacity * a->size + 1);
    if (base == NULL) {
        return false;
    }
    a->base = base;
    a->capacity = capacity;
    return true;
}

bool shared_array_grow(shared_array *a, size_t count)
{
    assert(a->size > 0);
    if (a->reserved == 0) {
        return count <= a->capacity || grow_plain(a, count);
    }
    while (count > a->capacity) {
        if (!append_chunk(a, NULL)) {
            return false;
        }
    }
    return true;
}

bool shared_array_share(shared_array *a, const shared_array *from, size_t count)
{
    assert(a->size == from->size && a->chunk_count == 0);
    assert(a->reserved > 0 && count <= from->capacity);
    size_t bytes = count * a->size, shared = from->reserved > 0 ? bytes / ARRAY_CHUNK : 0;

    // chunks that are full will not change any more
    for (size_t i = 0; i < shared; i++) {
        if (!append_chunk(a, from)) {
            return false;
        }
    }

    // the elements behind them
    size_t done = shared * ARRAY_CHUNK;
    if (!shared_array_grow(a, count)) {
        return false;
    }
    if (bytes > done) {
        memcpy((char *)a->base + done, (const char *)from->base + done, bytes - done);
    }
    a->count = count;
    return true;
}

void shared_array_finish(shared_array *a)
{
    if (a->reserved > 0) {
        munmap(a->base, a->reserved);
        for (size_t i = 0; i < a->chunk_count; i++) {
            if (atomic_fetch_sub(&a->chunks[i]->users, 1) == 1) {
                free(a->chunks[i]);
                atomic_fetch_sub(&memory, ARRAY_CHUNK);
            }
        }
    } else {
        free(a->base);
    }
    free(a->chunks);
    *a = (shared_array){0};
}

#include "src/base/shared_array.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/fault.h"

enum {
    LEAST_ELEMENTS = 64,
    PART = 32 // of an address space that is limited, what an array takes of it at most
};

// --- chunks ----------------------------------------------------------------------------

// Chunks are put side by side, so that elements are an ordinary array, and the kernel
// counts who has them.

// Puts a chunk behind the end of an array: memory of its own, or that of the same chunk
// of `from`.
static bool append_chunk(shared_array *a, const shared_array *from)
{
    if (a->mapped + ARRAY_CHUNK > a->reserved) {
        return false;
    }

    char *at = (char *)a->base + a->mapped;
    bool mapped;
    if (from == NULL) {
        mapped = chunks_put(at);
    } else {
        mapped = chunks_put_again(at, (char *)from->base + a->mapped);
    }
    if (!mapped) {
        return false;
    }

    a->mapped += ARRAY_CHUNK;
    a->capacity = a->mapped / a->size;
    return true;
}

// --- arrays ----------------------------------------------------------------------------

void shared_array_init(shared_array *a, size_t size)
{
    assert(size > 0);
    *a = (shared_array){.size = size};
}

// Keeps addresses free for the most elements there may be, or for fewer if it must.
bool shared_array_reserve(shared_array *a, size_t size, size_t least, size_t most)
{
    assert(least > 0 && least <= most);
    shared_array_init(a, size);
    if (!chunks_exist()) {
        return true; // a plain one does where no other thread reads
    }

    // a limited address space is for others, too
    if (chunks_address_space() / PART / size < most) {
        most = chunks_address_space() / PART / size;
    }
    if (most < least) {
        most = least;
    }

    // half as much where it has no room for the most
    for (; most >= least; most /= 2) {
        size_t reserved = (most * size / ARRAY_CHUNK + 1) * ARRAY_CHUNK;
        void *base = chunks_reserve(reserved);
        if (base != NULL) {
            a->base = base;
            a->reserved = reserved;
            return true;
        }
    }
    return false;
}

// Room for `count` elements in an array that shares nothing, by doubling.
static bool grow_plain(shared_array *a, size_t count)
{
    size_t capacity = 2 * a->capacity;
    if (capacity < LEAST_ELEMENTS) {
        capacity = LEAST_ELEMENTS;
    }
    if (capacity < count) {
        capacity = count;
    }

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

// The first elements of another array: full chunks are shared, the rest is copied.
bool shared_array_share(shared_array *a, const shared_array *from, size_t count)
{
    assert(a->size == from->size && a->mapped == 0);
    assert(count <= from->capacity);
    size_t bytes = count * a->size;
    size_t shared = 0;
    if (from->reserved > 0 && a->reserved > 0) {
        shared = bytes / ARRAY_CHUNK;
    }

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
        chunks_release(a->base, a->reserved);
    } else {
        free(a->base);
    }
    *a = (shared_array){0};
}

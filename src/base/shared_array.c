#include "src/base/shared_array.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "src/base/fault.h"

enum {
    LEAST_ELEMENTS = 64,
    PART = 32 // of an address space that is limited, what an array takes of it at most
};

// --- chunks ----------------------------------------------------------------------------

// Chunks are mapped side by side, so that elements are an ordinary array, and the kernel
// counts who has them.

// Maps a chunk of its own at a place. False if there is no memory to be had.
static bool map_own_chunk(void *at)
{
    if (mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE,
             MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != at) {
        return false;
    }

    // memory is asked for here, where its want is an error and not a signal; an old
    // kernel cannot
    return madvise(at, ARRAY_CHUNK, MADV_POPULATE_WRITE) == 0 || errno == EINVAL;
}

// Maps a chunk a second time at a place. False if that cannot be.
static bool map_again(void *at, void *chunk)
{
    // memory of the size 0 that becomes larger is mapped a second time
    if (mremap(chunk, 0, ARRAY_CHUNK, MREMAP_MAYMOVE | MREMAP_FIXED, at) != MAP_FAILED) {
        return true;
    }

    // valgrind knows no such call and gets a copy
    if (errno != EINVAL || !map_own_chunk(at)) {
        return false;
    }
    memcpy(at, chunk, ARRAY_CHUNK);
    return true;
}

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
        mapped = map_own_chunk(at);
    } else {
        mapped = map_again(at, (char *)from->base + a->mapped);
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

    // a limited address space is for others, too
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur / PART / size < most) {
        most = limit.rlim_cur / PART / size;
    }
    if (most < least) {
        most = least;
    }

    // half as much where it has no room for the most
    for (; most >= least; most /= 2) {
        size_t reserved = (most * size / ARRAY_CHUNK + 1) * ARRAY_CHUNK;
        void *base = mmap(NULL, reserved, PROT_NONE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (base != MAP_FAILED) {
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
        munmap(a->base, a->reserved);
    } else {
        free(a->base);
    }
    *a = (shared_array){0};
}

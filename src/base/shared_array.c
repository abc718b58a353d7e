#include "src/base/shared_array.h"

#include <assert.h>
#include <fcntl.h>
#include <linux/falloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { LEAST_ELEMENTS = 64 };

// All chunks of the program lie in one file without a name. An array maps those that it has side by
// side, so that its elements are an ordinary array.
static struct {
    pthread_mutex_t lock;
    int file;         // -1: not made yet
    uint32_t *users;  // of each chunk; 0: it has no memory
    uint32_t *unused; // chunks without users, a stack
    size_t count, capacity, unused_count;
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .file = -1};

// --- chunks -----------------------------------------------------------------------------------

static off_t place_of(uint32_t chunk)
{
    return (off_t)chunk * ARRAY_CHUNK;
}

// Finds a chunk that nobody uses, or adds a new one to the file; the caller holds the lock.
static bool unused_chunk(uint32_t *chunk)
{
    if (pool.unused_count > 0) {
        *chunk = pool.unused[--pool.unused_count];
        return true;
    }

    // tables for its number
    if (pool.file < 0) {
        pool.file = memfd_create("impactlab rows", MFD_CLOEXEC);
    }
    if (pool.count == pool.capacity) {
        size_t capacity = pool.capacity ? 2 * pool.capacity : 64;
        uint32_t *users = realloc(pool.users, capacity * sizeof *users);
        pool.users = users ? users : pool.users;
        uint32_t *unused = realloc(pool.unused, capacity * sizeof *unused);
        pool.unused = unused ? unused : pool.unused;
        if (users == NULL || unused == NULL) {
            return false;
        }
        pool.capacity = capacity;
    }

    // its place in the file
    off_t size = place_of((uint32_t)pool.count + 1);
    if (pool.file < 0 || pool.count >= UINT32_MAX - 1 || ftruncate(pool.file, size) != 0) {
        return false;
    }
    *chunk = (uint32_t)pool.count++;
    return true;
}

// A chunk with memory behind it and one user; false if there is none to be had.
static bool acquire_chunk(uint32_t *chunk)
{
    pthread_mutex_lock(&pool.lock);
    bool got = unused_chunk(chunk);

    // memory is asked for here, where its want is an error and not a signal
    if (got && fallocate(pool.file, 0, place_of(*chunk), ARRAY_CHUNK) != 0) {
        pool.unused[pool.unused_count++] = *chunk;
        got = false;
    }
    if (got) {
        pool.users[*chunk] = 1;
    }
    pthread_mutex_unlock(&pool.lock);
    return got;
}

static void share_chunk(uint32_t chunk)
{
    pthread_mutex_lock(&pool.lock);
    pool.users[chunk]++;
    pthread_mutex_unlock(&pool.lock);
}

// Ends one use of a chunk. After the last its memory goes back and its number can be used again.
static void release_chunk(uint32_t chunk)
{
    pthread_mutex_lock(&pool.lock);
    if (--pool.users[chunk] == 0) {
        fallocate(pool.file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, place_of(chunk),
                  ARRAY_CHUNK);
        pool.unused[pool.unused_count++] = chunk;
    }
    pthread_mutex_unlock(&pool.lock);
}

size_t shared_array_memory(void)
{
    pthread_mutex_lock(&pool.lock);
    size_t used = pool.count - pool.unused_count;
    pthread_mutex_unlock(&pool.lock);
    return used * ARRAY_CHUNK;
}

// Puts a chunk's memory where the i-th chunk of an array stands.
static bool map_chunk(const shared_array *a, size_t i, uint32_t chunk)
{
    char *at = (char *)a->base + i * ARRAY_CHUNK;
    return (i + 1) * ARRAY_CHUNK <= a->reserved &&
           mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, pool.file,
                place_of(chunk)) != MAP_FAILED;
}

// Puts a chunk behind the end of an array, which has room for its number. On failure it is
// released.
static bool append_chunk(shared_array *a, uint32_t chunk)
{
    if (!map_chunk(a, a->chunk_count, chunk)) {
        release_chunk(chunk);
        return false;
    }
    a->chunks[a->chunk_count++] = chunk;
    a->capacity = a->chunk_count * ARRAY_CHUNK / a->size;
    return true;
}

// Makes room for the number of one more chunk.
static bool reserve_number(shared_array *a)
{
    if (a->chunk_count < a->chunk_capacity) {
        return true;
    }
    size_t capacity = a->chunk_capacity ? 2 * a->chunk_capacity : 16;
    uint32_t *chunks = realloc(a->chunks, capacity * sizeof *chunks);
    if (chunks == NULL) {
        return false;
    }
    a->chunks = chunks;
    a->chunk_capacity = capacity;
    return true;
}

// --- arrays ----------------------------------------------------------------------------------

void shared_array_init(shared_array *a, size_t size)
{
    assert(a != NULL && size > 0);
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
    assert(a != NULL && a->size > 0);
    if (a->reserved == 0) {
        return count <= a->capacity || grow_plain(a, count);
    }
    while (count > a->capacity) {
        uint32_t chunk;
        if (!reserve_number(a) || !acquire_chunk(&chunk) || !append_chunk(a, chunk)) {
            return false;
        }
    }
    return true;
}

bool shared_array_share(shared_array *a, const shared_array *from, size_t count)
{
    assert(a != NULL && from != NULL && a->size == from->size && a->chunk_count == 0);
    assert(a->reserved > 0 && count <= from->capacity);
    size_t bytes = count * a->size, shared = from->reserved > 0 ? bytes / ARRAY_CHUNK : 0;

    // chunks that are full will not change any more
    for (size_t i = 0; i < shared; i++) {
        if (!reserve_number(a)) {
            return false;
        }
        share_chunk(from->chunks[i]);
        if (!append_chunk(a, from->chunks[i])) {
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
    return true;
}

void shared_array_finish(shared_array *a)
{
    assert(a != NULL);
    if (a->reserved > 0) {
        munmap(a->base, a->reserved);
        for (size_t i = 0; i < a->chunk_count; i++) {
            release_chunk(a->chunks[i]);
        }
    } else {
        free(a->base);
    }
    free(a->chunks);
    *a = (shared_array){0};
}

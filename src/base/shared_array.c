#include "src/base/shared_array.h"

#include <fcntl.h>
#include <linux/falloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { LEAST_ELEMENTS = 256 };

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

// Takes a chunk that nobody uses, or a new one; the caller holds the lock.
static bool pick_chunk(uint32_t *chunk)
{
    if (pool.unused_count > 0) {
        *chunk = pool.unused[--pool.unused_count];
        return true;
    }
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
    off_t size = place_of((uint32_t)pool.count + 1);
    if (pool.file < 0 || pool.count >= UINT32_MAX - 1 || ftruncate(pool.file, size) != 0) {
        return false;
    }
    *chunk = (uint32_t)pool.count++;
    return true;
}

static bool take_chunk(uint32_t *chunk)
{
    pthread_mutex_lock(&pool.lock);
    bool taken = pick_chunk(chunk);
    // memory is asked for here, where its want is an error and not a signal
    if (taken && fallocate(pool.file, 0, place_of(*chunk), ARRAY_CHUNK) != 0) {
        pool.unused[pool.unused_count++] = *chunk;
        taken = false;
    }
    if (taken) {
        pool.users[*chunk] = 1;
    }
    pthread_mutex_unlock(&pool.lock);
    return taken;
}

static void share_chunk(uint32_t chunk)
{
    pthread_mutex_lock(&pool.lock);
    pool.users[chunk]++;
    pthread_mutex_unlock(&pool.lock);
}

static void leave_chunk(uint32_t chunk)
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

// Puts a chunk behind the end of a array, which has room for its number. On failure it is left.
static bool map_chunk(shared_array *c, uint32_t chunk)
{
    char *at = (char *)c->base + c->chunk_count * ARRAY_CHUNK;
    void *mapped = MAP_FAILED;
    if ((c->chunk_count + 1) * ARRAY_CHUNK <= c->reserved) {
        mapped = mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, pool.file,
                      place_of(chunk));
    }
    if (mapped == MAP_FAILED) {
        leave_chunk(chunk);
        return false;
    }
    c->chunks[c->chunk_count++] = chunk;
    c->capacity = c->chunk_count * ARRAY_CHUNK / c->size;
    return true;
}

static bool reserve_number(shared_array *c)
{
    if (c->chunk_count < c->chunk_capacity) {
        return true;
    }
    size_t capacity = c->chunk_capacity ? 2 * c->chunk_capacity : 16;
    uint32_t *chunks = realloc(c->chunks, capacity * sizeof *chunks);
    if (chunks == NULL) {
        return false;
    }
    c->chunks = chunks;
    c->chunk_capacity = capacity;
    return true;
}

// --- arrays ----------------------------------------------------------------------------------

void shared_array_init(shared_array *c, size_t size)
{
    *c = (shared_array){.size = size};
}

static size_t whole_chunks(size_t elements, size_t size)
{
    return (elements * size / ARRAY_CHUNK + 1) * ARRAY_CHUNK;
}

bool shared_array_reserve(shared_array *c, size_t size, size_t least, size_t most)
{
    shared_array_init(c, size);
    for (; most >= least; most /= 2) {
        size_t reserved = whole_chunks(most, size);
        void *base =
            mmap(NULL, reserved, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (base != MAP_FAILED) {
            c->base = base;
            c->reserved = reserved;
            return true;
        }
    }
    return false;
}

static bool grow_plain(shared_array *c, size_t count)
{
    size_t capacity = c->capacity ? 2 * c->capacity : LEAST_ELEMENTS;
    capacity = capacity < count ? count : capacity;
    void *base = realloc(c->base, capacity * c->size + 1);
    if (base == NULL) {
        return false;
    }
    c->base = base;
    c->capacity = capacity;
    return true;
}

bool shared_array_grow(shared_array *c, size_t count)
{
    if (c->reserved == 0) {
        return count <= c->capacity || grow_plain(c, count);
    }
    while (count > c->capacity) {
        uint32_t chunk;
        if (!reserve_number(c) || !take_chunk(&chunk) || !map_chunk(c, chunk)) {
            return false;
        }
    }
    return true;
}

bool shared_array_share(shared_array *c, const shared_array *from, size_t count)
{
    size_t bytes = count * c->size, shared = bytes / ARRAY_CHUNK;
    if (from->reserved == 0) {
        shared = 0;
    }
    for (size_t i = 0; i < shared; i++) {
        if (!reserve_number(c)) {
            return false;
        }
        share_chunk(from->chunks[i]);
        if (!map_chunk(c, from->chunks[i])) {
            return false;
        }
    }
    size_t done = shared * ARRAY_CHUNK;
    if (!shared_array_grow(c, count)) {
        return false;
    }
    if (bytes > done) {
        memcpy((char *)c->base + done, (const char *)from->base + done, bytes - done);
    }
    return true;
}

size_t shared_array_same_chunks(const shared_array *a, const shared_array *b, size_t count)
{
    size_t most = a->size == b->size && b->reserved > 0 ? count * a->size / ARRAY_CHUNK : 0;
    size_t same = 0;
    while (same < most && same < a->chunk_count && same < b->chunk_count) {
        size_t at = same * ARRAY_CHUNK;
        bool equal =
            a->chunks[same] == b->chunks[same] ||
            memcmp((const char *)a->base + at, (const char *)b->base + at, ARRAY_CHUNK) == 0;
        if (!equal) {
            break;
        }
        same++;
    }
    return same;
}

void shared_array_merge(shared_array *c, const shared_array *with, size_t chunks)
{
    for (size_t i = 0; i < chunks; i++) {
        uint32_t old = c->chunks[i], shared = with->chunks[i];
        char *at = (char *)c->base + i * ARRAY_CHUNK;
        if (old == shared) {
            continue;
        }
        if (mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED, pool.file,
                 place_of(shared)) == MAP_FAILED) {
            return; // then it goes on with its own
        }
        share_chunk(shared);
        c->chunks[i] = shared;
        leave_chunk(old);
    }
}

void shared_array_finish(shared_array *c)
{
    if (c->reserved > 0) {
        munmap(c->base, c->reserved);
        for (size_t i = 0; i < c->chunk_count; i++) {
            leave_chunk(c->chunks[i]);
        }
    } else {
        free(c->base);
    }
    free(c->chunks);
    *c = (shared_array){0};
}

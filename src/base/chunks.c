#include "src/base/chunks.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

bool chunks_exist(void)
{
    return true;
}

double machine_memory(void)
{
    return (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
}

size_t chunks_address_space(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < SIZE_MAX) {
        return limit.rlim_cur;
    }
    return SIZE_MAX;
}

void *chunks_reserve(size_t size)
{
    void *base =
        mmap(NULL, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (base == MAP_FAILED) {
        return NULL;
    }
    return base;
}

void chunks_release(void *base, size_t size)
{
    munmap(base, size);
}

bool chunks_put(void *at)
{
    if (mmap(at, ARRAY_CHUNK, PROT_READ | PROT_WRITE,
             MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != at) {
        return false;
    }

    // memory is asked for here, where its want is an error and not a signal; an old
    // kernel cannot
    return madvise(at, ARRAY_CHUNK, MADV_POPULATE_WRITE) == 0 || errno == EINVAL;
}

bool chunks_put_again(void *at, void *chunk)
{
    // memory of the size 0 that becomes larger is mapped a second time
    if (mremap(chunk, 0, ARRAY_CHUNK, MREMAP_MAYMOVE | MREMAP_FIXED, at) != MAP_FAILED) {
        return true;
    }

    // valgrind knows no such call and gets a copy
    if (errno != EINVAL || !chunks_put(at)) {
        return false;
    }
    memcpy(at, chunk, ARRAY_CHUNK);
    return true;
}

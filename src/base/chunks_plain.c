// A machine without chunks: every array lies on the heap.
#include "src/base/chunks.h"

#include <assert.h>
#include <math.h>

bool chunks_exist(void)
{
    return false;
}

double machine_memory(void)
{
    return HUGE_VAL;
}

size_t chunks_address_space(void)
{
    return 0;
}

void *chunks_reserve(size_t size)
{
    (void)size;
    return NULL;
}

void chunks_release(void *base, size_t size)
{
    (void)size;
    assert(base == NULL);
    (void)base;
}

bool chunks_put(void *at)
{
    (void)at;
    return false;
}

bool chunks_put_again(void *at, void *chunk)
{
    (void)at;
    (void)chunk;
    return false;
}

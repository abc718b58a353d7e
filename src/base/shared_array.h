// A growing array of equal elements, in one of two kinds.
//
// A plain one lies on the heap and moves as it grows. A shared one keeps its place:
// address space is reserved for all it may ever hold, and memory is put behind it in
// chunks as it grows. So another thread can read what has been published to it while the
// owner appends, and a second array can have the same chunks for its beginning instead of
// a copy. A chunk goes when the last array that has it does; elements once appended must
// not be changed. On a machine without chunks (src/base/chunks.h) all arrays are plain
// ones.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/chunks.h"

typedef struct shared_array {
    void *base;      // of the elements
    size_t size;     // of one element [bytes]
    size_t count;    // elements in it, for whoever keeps no count of his own
    size_t capacity; // elements that there is memory for
    size_t reserved; // address space of a shared array [bytes]; 0: a plain one
    size_t mapped;   // of it that has memory, whole chunks [bytes]
} shared_array;

// An empty plain array of elements of `size` bytes.
void shared_array_init(shared_array *a, size_t size);

// An empty shared array for `least` elements, and up to `most` if there is that much
// address space. False if it cannot be had; then there is nothing to be freed.
bool shared_array_reserve(shared_array *a, size_t size, size_t least, size_t most);

// Makes room for `count` elements; false without memory, then the array is as before.
bool shared_array_grow(shared_array *a, size_t count);

// Lets an array, still empty, begin with the first `count` elements of another: of two
// shared ones all chunks that these fill are shared, the rest is copied. False without
// memory.
bool shared_array_share(shared_array *a, const shared_array *from, size_t count);

void shared_array_finish(shared_array *a); // one of zeroes is allowed

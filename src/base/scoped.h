// What a function holds, given back however it is left.
#pragma once

#include <stdlib.h>

// A variable that is given back when its block is left, and must be whole by then:
// SCOPED(run_finish) run_result r;
#define SCOPED(finish) __attribute__((cleanup(finish), unused))

// The same of what is behind a pointer: SCOPED(free_kept) char *text; for other types,
// after GIVEN_BACK(motion, motion_destroy), SCOPED(motion_destroy_kept) motion *m.
#define GIVEN_BACK(type, destroy)                                                        \
    static inline void destroy##_kept(type **pointer)                                    \
    {                                                                                    \
        destroy(*pointer);                                                               \
    }

static inline void free_kept(void *pointer)
{
    free(*(void **)pointer);
}

// Requests for memory of libimpactlab refused one after the other: each call that is
// refused says so and leaves nothing, or what comes out is whole.
#include "calls.h"

#include "tests/refused_requests.h"

static status call_library(const char *ignored, FILE *out)
{
    (void)ignored;
    return call_everything(out) == 0 ? STATUS_OK : STATUS_NO_MEMORY;
}

TEST(every_call_says_that_it_was_refused)
{
    try_all(call_library, "");
}

REFUSING_MAIN("", use_refusing_allocators, NULL)

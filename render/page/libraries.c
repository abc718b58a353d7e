// Whether a thread is in a library that crashes without memory.
#include <stdatomic.h>
#include <unistd.h>

#include "render/page/page.h"

_Thread_local volatile sig_atomic_t page_libraries;
static atomic_bool fonts_begun;

bool page_in_libraries(void)
{
    return page_libraries > 0 || (atomic_load(&fonts_begun) && gettid() != getpid());
}

void page_begin_fonts(void)
{
    atomic_store(&fonts_begun, true);
}

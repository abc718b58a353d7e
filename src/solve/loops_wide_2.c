// What a stride does link by link and mode by mode, in SSE2's vectors.
#if defined __x86_64__
#define WIDTH 2
#include "src/solve/chain_loops_kernel.h"
#include "src/solve/modal_loops_kernel.h"
#endif

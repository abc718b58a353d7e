// What a stride of the chain's series does link by link, in SSE2's vectors.
#if defined __x86_64__
#define WIDTH 2
#include "src/engines/series/chain_loops_kernel.h"
#endif

// What a stride of the chain's series does link by link, in AVX2's vectors. Built for a processor
// that has them, called on no other.
#if defined __x86_64__
#define WIDTH 4
#include "src/engines/series/chain_loops_kernel.h"
#endif

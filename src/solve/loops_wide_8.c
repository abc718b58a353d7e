// What a stride does link by link and mode by mode, in AVX-512's vectors. Built for a processor
// that has them, called on no other.
#if defined __x86_64__
#define WIDTH 8
#include "src/solve/chain_loops_kernel.h"
#include "src/solve/modal_loops_kernel.h"
#endif

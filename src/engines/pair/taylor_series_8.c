// The series of eight arms, in AVX-512's vectors. Built for a processor that has them, called on no
// other.
#if defined __x86_64__
#define LANES 8
#include "src/engines/pair/taylor_instants.h"
#include "src/engines/pair/taylor_kernel.h"
#endif

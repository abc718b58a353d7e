// The series of two arms, in SSE2's vectors. Built for a processor that has them, called on no
// other.
#if defined __x86_64__
#define LANES 2
#include "src/engines/pair/taylor_instants.h"
#include "src/engines/pair/taylor_kernel.h"
#endif

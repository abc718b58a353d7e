// The sweeps of the stiff engine, in AVX2's vectors. Built for a processor that has them, called on
// no other.
#if defined __x86_64__
#define WIDTH 4
#include "src/engines/stiff/stiff_kernel.h"
#endif

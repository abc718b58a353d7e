// What the sweeps of a stride of modes do, in AVX2's vectors. Built for a processor that has
// them, called on no other.
#if defined __x86_64__
#define LANES 4
#include "src/solve/modal_points_kernel.h"
#include "src/solve/modal_product_kernel.h"
#endif

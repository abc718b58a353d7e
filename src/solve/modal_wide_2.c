// What the sweeps of a stride of modes do, in SSE2's vectors.
#if defined __x86_64__
#define LANES 2
#include "src/solve/modal_points_kernel.h"
#include "src/solve/modal_product_kernel.h"
#endif

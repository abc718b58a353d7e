// What the sweeps of a stride of modes do, number by number.
#define LANES 1
#include "src/solve/modal_points_kernel.h"
#include "src/solve/modal_product_kernel.h"

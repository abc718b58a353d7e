// What a stride of the chain's series does link by link, number by number.
#define WIDTH 1
#include "src/solve/chain_loops_kernel.h"

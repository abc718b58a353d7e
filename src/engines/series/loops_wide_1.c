// What a stride of the chain's series does link by link, number by number.
#define WIDTH 1
#include "src/engines/series/chain_loops_kernel.h"

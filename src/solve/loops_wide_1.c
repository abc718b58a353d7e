// What a stride does link by link and mode by mode, number by number.
#define WIDTH 1
#include "src/solve/chain_loops_kernel.h"
#include "src/solve/modal_loops_kernel.h"

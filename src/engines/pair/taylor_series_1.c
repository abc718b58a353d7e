// The series of one arm at a time.
#define LANES 1
#include "src/engines/pair/taylor_instants.h"
#include "src/engines/pair/taylor_kernel.h"

// The series of one arm at a time.
#define LANES 1
#include "src/solve/taylor_instants.h"
#include "src/solve/taylor_kernel.h"

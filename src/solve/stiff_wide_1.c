// The sweeps of the stiff engine, in the vectors that every processor has.
#define WIDTH 1
#include "src/solve/stiff_kernel.h"

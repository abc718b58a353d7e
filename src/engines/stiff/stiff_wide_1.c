// The sweeps of the stiff engine, in the vectors that every processor has.
#define WIDTH 1
#include "src/engines/stiff/stiff_kernel.h"

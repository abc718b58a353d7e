// The series of one arm, in AVX2's vectors. Built for a processor that has them, called on no
// other.
#if defined __x86_64__
#define LANES    1
#define SERIES   taylor_series_1_avx2
#define INSTANTS taylor_instants_1_avx2
#define ONE_ARM
#include "src/engines/pair/taylor_instants.h"
#include "src/engines/pair/taylor_kernel.h"
#endif

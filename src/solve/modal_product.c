#include "src/solve/modal_product.h"

#include "src/solve/by_width.h"
#include "src/solve/taylor_lanes.h"

void modal_multiply(const modal_product *p, const double *in, double *out)
{
    BY_WIDTH(modal_multiply_, taylor_width())(p, in, out);
}

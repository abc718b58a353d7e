#include "src/solve/modal_product.h"

#include "src/solve/taylor_lanes.h"

void modal_multiply(const modal_product *p, const double *in, double *out)
{
#if defined(__x86_64__)
    const int width = taylor_width();
    if (width == 8) {
        modal_multiply_8(p, in, out);
        return;
    }
    if (width == 4) {
        modal_multiply_4(p, in, out);
        return;
    }
    if (width == 2) {
        modal_multiply_2(p, in, out);
        return;
    }
#endif
    modal_multiply_1(p, in, out);
}

#include "src/solve/modal_points.h"

#include "src/solve/modal_loops.h"
#include "src/solve/taylor_lanes.h"

enum { VECTORS = 12 }; // of a link

size_t modal_points_size(int dof)
{
    return (size_t)dof * VECTORS * MODAL_LANES;
}

void modal_sweep_points(modal_stride *s, const arm *a, const double *q, int first)
{
    const int width = taylor_width();
    for (int point = first; point < MODAL_NODES; point += width) {
#if defined(__x86_64__)
        if (width == 8) {
            modal_sweep_points_8(s, a, q, point);
        } else if (width == 4) {
            modal_sweep_points_4(s, a, q, point);
        } else if (width == 2) {
            modal_sweep_points_2(s, a, q, point);
        } else {
            modal_sweep_points_1(s, a, q, point);
        }
#else
        modal_sweep_points_1(s, a, q, point);
#endif
    }
}

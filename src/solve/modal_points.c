#include "src/solve/modal_points.h"

#include "src/solve/by_width.h"
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
        BY_WIDTH(modal_sweep_points_, width)(s, a, q, point);
    }
}

#include "render/plot/contour.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

int contour_square(const double z[4], double level, contour_piece pieces[2])
{
    assert(z != NULL && pieces != NULL && isfinite(level));
    // corners in the order of going round, and the crossing of the side that begins at each
    static const int corner[4] = {0, 1, 3, 2};
    static const double corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
    double cross_x[4] = {0}, cross_y[4] = {0};
    int side[4], count = 0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(z[i])) {
            return 0;
        }
    }

    // where the level crosses the sides
    for (int i = 0; i < 4; i++) {
        int j = (i + 1) % 4;
        double a = z[corner[i]], b = z[corner[j]];
        if ((a >= level) != (b >= level)) {
            double share = (level - a) / (b - a);
            cross_x[i] = corner_x[i] + share * (corner_x[j] - corner_x[i]);
            cross_y[i] = corner_y[i] + share * (corner_y[j] - corner_y[i]);
            side[count++] = i;
        }
    }

    // four crossings: the pieces cut off the corners that differ from the middle
    bool middle = (z[0] + z[1] + z[2] + z[3]) / 4 >= level;
    int first = count == 4 && (z[0] >= level) != middle ? 3 : 0;
    for (int i = 0; i < count / 2; i++) {
        int from = side[(first + 2 * i) % count], to = side[(first + 2 * i + 1) % count];
        pieces[i] = (contour_piece){cross_x[from], cross_y[from], cross_x[to], cross_y[to]};
    }
    return count / 2;
}

// Contour lines of values over a grid.
#pragma once

// A piece of a contour line. Coordinates count grid points: x from 0 to columns - 1.
typedef struct contour_piece {
    double x0, y0, x1, y1;
} contour_piece;

// The contour of z = level within the square of four neighbouring grid points, by marching squares
// with straight lines: z[0] at (0, 0), z[1] at (1, 0), z[2] at (0, 1), z[3] at (1, 1). A saddle is
// decided by the mean of the four. Returns the number of pieces, 0 to 2; 0 if a corner is not
// finite.
int contour_square(const double z[4], double level, contour_piece pieces[2]);

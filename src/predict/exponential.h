// The propagator of a linear motion.
#pragma once

// result = exp(matrix h) for matrices of size x size, row by row, by Taylor's series of the scaled
// matrix, squared back. power, product: scratch of the same size.
void matrix_exponential(const double *matrix, int size, double h, double *result, double *power,
                        double *product);

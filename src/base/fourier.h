// The discrete Fourier transform, and the spectrum of amplitudes of a series.
#pragma once

#include <stddef.h>

// Transforms n complex numbers in place, X_k = sum_j x_j exp(-2 pi i j k / n), by Cooley
// and Tukey's radix 2. n is a power of two.
void fourier_transform(double *real, double *imaginary, size_t n);

// The amplitudes of sines in a series of n values, n a power of two: its mean is taken
// off, a Hann window laid over it, and amplitude[k], k = 0 .. n/2 - 1, is that of k
// periods in the series; for a sine with a whole number of periods it equals the sine's
// amplitude. `scratch` has 2 n numbers.
void fourier_amplitudes(const double *series, size_t n, double *scratch,
                        double *amplitude);

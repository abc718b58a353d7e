#include "src/base/fourier.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "src/base/sincos.h"

#define PI 3.14159265358979323846

// For assertions, which a build without them does not ask.
static inline bool is_power_of_two(size_t n)
{
    return n > 0 && (n & (n - 1)) == 0;
}

// Puts every number where its index with bits in reverse order says.
static void reverse_bits(double *real, double *imaginary, size_t n)
{
    for (size_t i = 1, j = 0; i < n; i++) {
        // counts j up in reverse: the carry goes down
        size_t bit = n >> 1;
        for (; (j & bit) != 0; bit >>= 1) {
            j ^= bit;
        }
        j ^= bit;

        // each pair once
        if (i < j) {
            const double re = real[i], im = imaginary[i];
            real[i] = real[j];
            imaginary[i] = imaginary[j];
            real[j] = re;
            imaginary[j] = im;
        }
    }
}

// The radix-2 transform of Cooley and Tukey (1965), in place.
void fourier_transform(double *real, double *imaginary, size_t n)
{
    assert(is_power_of_two(n));
    reverse_bits(real, imaginary, n);

    // transforms of twice the length each time
    for (size_t half = 1; half < n; half *= 2) {
        for (size_t k = 0; k < half; k++) {
            const double turn = -PI * (double)k / (double)half;
            double c, s;
            inline_sincos(turn, &s, &c);

            // of two halves one of the double length
            for (size_t i = k; i < n; i += 2 * half) {
                const size_t j = i + half;
                const double re = c * real[j] - s * imaginary[j];
                const double im = c * imaginary[j] + s * real[j];
                real[j] = real[i] - re;
                imaginary[j] = imaginary[i] - im;
                real[i] += re;
                imaginary[i] += im;
            }
        }
    }
}

void fourier_amplitudes(const double *series, size_t n, double *scratch,
                        double *amplitude)
{
    assert(n > 1 && is_power_of_two(n));
    double *real = scratch, *imaginary = scratch + n, mean = 0, weight = 0;
    for (size_t i = 0; i < n; i++) {
        mean += series[i] / (double)n;
    }

    // Hann's window, whose sum is what a sine keeps of its amplitude
    for (size_t i = 0; i < n; i++) {
        const double window = 0.5 - 0.5 * inline_cos(2 * PI * (double)i / (double)n);
        weight += window;
        real[i] = window * (series[i] - mean);
        imaginary[i] = 0;
    }
    fourier_transform(real, imaginary, n);
    for (size_t k = 0; k < n / 2; k++) {
        amplitude[k] = 2 * sqrt(real[k] * real[k] + imaginary[k] * imaginary[k]) / weight;
    }
}

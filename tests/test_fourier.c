// The Fourier transform of sines and other known series.
#include "tests/check.h"

#include "src/base/fourier.h"

enum { N = 256 };
#define PI 3.14159265358979323846

TEST(a_transform_is_the_sum_that_defines_it)
{
    enum { SHORT = 16 };
    double re[SHORT], im[SHORT], re0[SHORT], im0[SHORT];
    for (int i = 0; i < SHORT; i++) {
        re[i] = re0[i] = sin(1.0 + i * i);
        im[i] = im0[i] = cos(3.0 * i);
    }
    fourier_transform(re, im, SHORT);
    for (int k = 0; k < SHORT; k++) {
        double a = 0, b = 0;
        for (int j = 0; j < SHORT; j++) {
            const double turn = -2 * PI * j * k / SHORT;
            a += re0[j] * cos(turn) - im0[j] * sin(turn);
            b += re0[j] * sin(turn) + im0[j] * cos(turn);
        }
        check_close(re[k], a, 1e-13);
        check_close(im[k], b, 1e-13);
    }
}

TEST(amplitudes_are_those_of_the_sines)
{
    double series[N], scratch[2 * N], amplitude[N / 2];
    for (int i = 0; i < N; i++) {
        const double turn = 2 * PI * i / N;
        series[i] = 7 + 3 * sin(10 * turn + 0.3) + 0.5 * cos(60 * turn);
    }
    fourier_amplitudes(series, N, scratch, amplitude);
    check_close(amplitude[0], 0, 1e-12);
    check_close(amplitude[10], 3, 1e-12);
    check_close(amplitude[60], 0.5, 1e-12);

    // Hann's window leaks into the neighbours only, half of it
    check_close(amplitude[9], 1.5, 1e-12);
    check_close(amplitude[30], 0, 1e-12);
}

TEST(nothing_is_written_behind_the_amplitudes)
{
    double series[N] = {0}, scratch[2 * N], amplitude[N / 2 + 1];
    amplitude[N / 2] = 42;
    fourier_amplitudes(series, N, scratch, amplitude);
    check_close(amplitude[N / 2], 42, 0);
}

TEST(the_ends_of_the_window_count_nothing)
{
    double series[N] = {1}, scratch[2 * N], amplitude[N / 2];
    fourier_amplitudes(series, N, scratch, amplitude);
    for (int k = 2; k < N / 2; k++) {
        check_close(amplitude[k], 0, 1e-13);
    }
}

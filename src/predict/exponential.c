#include "src/predict/exponential.h"

#include <math.h>
#include <string.h>

void matrix_exponential(const double *matrix, int size, double h, double *result, double *power,
                        double *product)
{
    const size_t bytes = (size_t)(size * size) * sizeof(double);

    // the largest row sum
    double norm = 0;
    for (int i = 0; i < size; i++) {
        double row = 0;
        for (int j = 0; j < size; j++) {
            row += fabs(matrix[i * size + j]) * h;
        }
        norm = fmax(norm, row);
    }

    // halved until the series converges fast
    int octave;
    const double mantissa = frexp(norm, &octave);
    int squarings = norm > 0.5 ? octave + (mantissa > 0.5) : 0;
    double scale = h / ldexp(1, squarings);
    memset(result, 0, bytes);
    memset(power, 0, bytes);
    for (int i = 0; i < size; i++) {
        result[i * size + i] = power[i * size + i] = 1;
    }

    // first the terms of the series, then the squarings
    enum { TERMS = 14 };
    for (int term = 1; term <= TERMS + squarings; term++) {
        // a term of the series, or the square of what there is so far
        const double *left = term <= TERMS ? matrix : result;
        const double *right = term <= TERMS ? power : result;
        double factor = term <= TERMS ? scale / term : 1;
        for (int i = 0; i < size; i++) {
            for (int j = 0; j < size; j++) {
                double sum = 0;
                for (int k = 0; k < size; k++) {
                    sum += left[i * size + k] * right[k * size + j];
                }
                product[i * size + j] = sum * factor;
            }
        }

        if (term > TERMS) {
            memcpy(result, product, bytes);
            continue;
        }
        memcpy(power, product, bytes);
        for (int i = 0; i < size * size; i++) {
            result[i] += product[i];
        }
    }
}

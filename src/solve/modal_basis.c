#include "src/solve/modal_basis.h"

#include <math.h>
#include <string.h>

size_t modal_basis_size(int n)
{
    return (size_t)n * (2 * (size_t)n + 2);
}

size_t modal_basis_scratch(int n)
{
    return modal_shapes_scratch(n);
}

void modal_basis_place(modal_basis *b, int n, double *storage)
{
    b->count = 0;
    b->rate = storage;
    b->pull = storage + n;
    b->by_mode = storage + 2 * n;
    b->by_dof = b->by_mode + (size_t)n * (size_t)n;
}

// --- modes ------------------------------------------------------------------------------------

// The vector M0^-1 of the gradient of sum q_k, of unit length in M0, as one more mode.
static void add_gradient(modal_basis *b, const arm *a, bool stuck, double *scratch)
{
    double *row = b->by_mode + (size_t)b->count * (size_t)a->dof, *product = scratch + 2 * a->dof;
    modal_tip_answer(a, stuck, row, scratch);
    modal_mass_times(a, row, product);
    double square = 0;
    for (int i = 0; i < a->dof; i++) {
        square += row[i] * product[i];
    }
    for (int i = 0; i < a->dof; i++) {
        row[i] /= sqrt(square);
    }

    // what the modes and it itself pull at it
    modal_stiffness_times(a, row, product);
    for (int k = 0; k <= b->count; k++) {
        const double *mode = b->by_mode + (size_t)k * (size_t)a->dof;
        for (int i = 0; i < a->dof; i++) {
            b->pull[k] += mode[i] * product[i];
        }
    }
    b->across = b->count;
    b->rate[b->count++] = 0;
}

status modal_basis_compute(modal_basis *b, const arm *a, bool contact, bool stuck, double *scratch)
{
    const size_t n = (size_t)a->dof;
    const int modes = modal_shapes(a, contact, stuck, b->rate, b->by_mode, scratch);
    if (modes < 0) {
        return STATUS_SINGULAR;
    }
    b->count = modes;
    b->across = -1;
    memset(b->pull, 0, n * sizeof *b->pull);
    if (contact) {
        add_gradient(b, a, stuck, scratch);
    }

    // the same by degree of freedom
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < (size_t)b->count; k++) {
            b->by_dof[i * n + k] = b->by_mode[k * n + i];
        }
    }
    return STATUS_OK;
}

// --- between angles and modes -----------------------------------------------------------------

// out[column][j] = sum over i < rows of in[column][i] matrix[i][j], j < width.
static inline __attribute__((always_inline)) void combine(const double *matrix, int side, int rows,
                                                          int width, int columns, const double *in,
                                                          double *out, int stride)
{
    for (int c = 0; c < columns; c++) {
        memset(out + (size_t)c * (size_t)stride, 0, (size_t)width * sizeof *out);
    }

    // four rows at a time, so that a sum is loaded and stored once for them
    int i = 0;
    for (; i + 4 <= rows; i += 4) {
        const double *restrict r0 = matrix + (size_t)i * (size_t)side;
        const double *restrict r1 = r0 + side, *restrict r2 = r1 + side, *restrict r3 = r2 + side;
        for (int c = 0; c < columns; c++) {
            const double *x = in + (size_t)c * (size_t)stride + i;
            const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
            double *restrict y = out + (size_t)c * (size_t)stride;
            for (int j = 0; j < width; j++) {
                y[j] += (x0 * r0[j] + x1 * r1[j]) + (x2 * r2[j] + x3 * r3[j]);
            }
        }
    }

    for (; i < rows; i++) {
        const double *restrict row = matrix + (size_t)i * (size_t)side;
        for (int c = 0; c < columns; c++) {
            const double x = in[(size_t)c * (size_t)stride + (size_t)i];
            double *restrict y = out + (size_t)c * (size_t)stride;
            for (int j = 0; j < width; j++) {
                y[j] += x * row[j];
            }
        }
    }
}

// The same operations in the same order, with as many at once as the processor can.
#if defined(__x86_64__)
__attribute__((target("avx2"))) static void combine_by_four(const double *matrix, int side,
                                                            int rows, int width, int columns,
                                                            const double *in, double *out,
                                                            int stride)
{
    combine(matrix, side, rows, width, columns, in, out, stride);
}
#endif

static void combine_rows(const double *matrix, int side, int rows, int width, int columns,
                         const double *in, double *out, int stride)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        combine_by_four(matrix, side, rows, width, columns, in, out, stride);
        return;
    }
#endif
    combine(matrix, side, rows, width, columns, in, out, stride);
}

void modal_to_angles(const modal_basis *b, int dof, int columns, const double *coordinates,
                     double *angles, int stride)
{
    combine_rows(b->by_mode, dof, b->count, dof, columns, coordinates, angles, stride);
}

void modal_from_angles(const modal_basis *b, int dof, int columns, const double *angles,
                       double *coordinates, int stride)
{
    combine_rows(b->by_dof, dof, dof, b->count, columns, angles, coordinates, stride);
}

#include "src/solve/modal_basis.h"

#include <math.h>
#include <string.h>

#include "src/solve/taylor_lanes.h"

typedef double real;
#include "src/solve/modal_straight.h"

// Rates that may be read behind the last, as of modes that do nothing.
enum { BEHIND = 7 };

size_t modal_basis_size(int n)
{
    return (size_t)n * (2 * (size_t)n + 2) + BEHIND;
}

size_t modal_basis_scratch(int n)
{
    return modal_shapes_scratch(n);
}

void modal_basis_place(modal_basis *b, int n, double *storage)
{
    b->count = 0;
    b->rate = storage;
    b->shared = storage + n + BEHIND;
    b->by_mode = b->shared + n;
    b->by_dof = b->by_mode + (size_t)n * (size_t)n;
}

// --- modes ------------------------------------------------------------------------------------

static double product_of(int n, const double *x, const double *y)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

// The vector e, of unit length in M0, as one more mode.
static void add_shift(modal_basis *b, const arm *a, modal_ends ends, double *scratch)
{
    const int n = a->dof;
    double *row = b->by_mode + (size_t)b->count * (size_t)n, *product = scratch;
    modal_tip_shift(a, ends, row);
    modal_mass_times(a, row, product);
    const double length = sqrt(product_of(n, row, product));
    for (int i = 0; i < n; i++) {
        row[i] /= length;
        product[i] /= length;
    }
    b->reach = modal_basis_across(b, a, row);

    // what it has in common with the modes, and its stiffness
    for (int k = 0; k < b->count; k++) {
        b->shared[k] = product_of(n, b->by_mode + (size_t)k * (size_t)n, product);
    }
    modal_stiffness_times(a, row, product);
    b->stiff = ends.stuck ? product_of(n, row, product) : 0;
    b->across = b->count;
    b->rate[b->count++] = 0;
}

double modal_basis_across(const modal_basis *b, const arm *a, const double *x)
{
    return straight_across(a, b->lever, x);
}

status modal_basis_compute(modal_basis *b, const arm *a, modal_ends ends, double *scratch)
{
    const size_t n = (size_t)a->dof;
    const int modes = modal_shapes(a, ends, b->rate, b->by_mode, scratch);
    if (modes < 0) {
        return STATUS_SINGULAR;
    }
    b->count = modes;
    b->across = -1;
    b->lever = ends.lever;
    if (ends.contact) {
        add_shift(b, a, ends, scratch);
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

// Eight elements of an out[column], whose sums stay in registers for `columns` columns and a panel
// of so many rows, read side by side.
typedef double block __attribute__((vector_size(64), aligned(8), may_alias));
enum { LANES = 8, TOGETHER = 12, PANEL = 16, NEAR_ROWS = 256 };

__attribute__((target("avx512f"))) static inline __attribute__((always_inline)) void
combine_block(const double *matrix, int side, int from, int end, int columns, const double *in,
              double *out, int stride)
{
    // what the panels before have left
    block sum[TOGETHER] = {0};
#pragma GCC unroll 12
    for (int c = 0; c < columns && from > 0; c++) {
        sum[c] = *(const block *)(out + (size_t)c * (size_t)stride);
    }

    // the panel's rows
    int i = from;
    for (; i + 4 <= end; i += 4) {
        const double *row = matrix + (size_t)i * (size_t)side;
        const block r0 = *(const block *)row, r1 = *(const block *)(row + side);
        const block r2 = *(const block *)(row + 2 * side), r3 = *(const block *)(row + 3 * side);
#pragma GCC unroll 12
        for (int c = 0; c < columns; c++) {
            const double *x = in + (size_t)c * (size_t)stride + i;
            sum[c] += (x[0] * r0 + x[1] * r1) + (x[2] * r2 + x[3] * r3);
        }
    }
    for (; i < end; i++) {
        const block row = *(const block *)(matrix + (size_t)i * (size_t)side);
#pragma GCC unroll 12
        for (int c = 0; c < columns; c++) {
            sum[c] += in[(size_t)c * (size_t)stride + (size_t)i] * row;
        }
    }

#pragma GCC unroll 12
    for (int c = 0; c < columns; c++) {
        *(block *)(out + (size_t)c * (size_t)stride) = sum[c];
    }
}

__attribute__((target("avx512f"))) static void combine_by_eight(const double *matrix, int side,
                                                                int rows, int width, int columns,
                                                                const double *in, double *out,
                                                                int stride)
{
    // few rows are near enough for one panel: the last block goes back over sums that are made
    const bool few = rows <= NEAR_ROWS && width >= LANES;
    const int panel = few ? rows : PANEL, whole = few ? width : width - width % LANES;
    for (int from = 0; from < rows; from += panel) {
        const int end = from + panel < rows ? from + panel : rows;
        for (int at = 0; at < whole; at += LANES) {
            const int j = at + LANES <= whole ? at : whole - LANES;
            const double *x = in;
            double *y = out + j;
            int left = columns;
            for (; left >= TOGETHER; left -= TOGETHER) {
                combine_block(matrix + j, side, from, end, TOGETHER, x, y, stride);
                x += (size_t)TOGETHER * (size_t)stride;
                y += (size_t)TOGETHER * (size_t)stride;
            }
            if (left == TOGETHER - 2) { // a stride's points without its start
                combine_block(matrix + j, side, from, end, TOGETHER - 2, x, y, stride);
                left = 0;
            }
            if (left == 3) {
                combine_block(matrix + j, side, from, end, 3, x, y, stride);
                left = 0;
            }
            for (; left > 1; left -= 2) {
                combine_block(matrix + j, side, from, end, 2, x, y, stride);
                x += 2 * (size_t)stride;
                y += 2 * (size_t)stride;
            }
            if (left > 0) {
                combine_block(matrix + j, side, from, end, 1, x, y, stride);
            }
        }
    }
    // sums that fill no block
    if (width > whole) {
        combine_by_four(matrix + whole, side, rows, width - whole, columns, in, out + whole,
                        stride);
    }
}
#endif

static void combine_rows(const double *matrix, int side, int rows, int width, int columns,
                         const double *in, double *out, int stride)
{
#if defined(__x86_64__)
    if (taylor_width() >= 8) {
        combine_by_eight(matrix, side, rows, width, columns, in, out, stride);
        return;
    }
    if (taylor_width() >= 4) {
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

// Products of columns with a matrix in vectors of LANES, which whoever includes this gives: LANES
// elements of as many columns as there are registers for stay in these, four rows of the matrix at
// a time.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/solve/modal_product.h"
#include "src/solve/taylor_numbers.h"

#if LANES > 1
typedef double loose __attribute__((vector_size(8 * LANES), aligned(8), may_alias));
#else
typedef double loose;
#endif

// Columns whose sums stay in registers; rows that are gone through for all blocks before the next
// ones, where the matrix has more than are near enough.
enum { TOGETHER = LANES == 8 ? 12 : 6, PANEL = 16, NEAR_ROWS = 256 };

// Some rows.
typedef struct panel {
    int from, end;
} panel;

// Elements j to j + LANES of the first `columns` columns, added to what the panels before have
// left.
KERNEL void block_product(const modal_product *p, panel rows, int j, int columns, const double *in,
                          double *out)
{
    const ptrdiff_t side = p->side, stride = p->stride;
    real sum[TOGETHER] = {0};
    if (rows.from > 0) {
#pragma GCC unroll 12
        for (int c = 0; c < columns; c++) {
            sum[c] = *(const loose *)(out + c * stride + j);
        }
    }

    // the panel's rows
    int i = rows.from;
    for (; i + 4 <= rows.end; i += 4) {
        const double *row = p->matrix + i * side + j;
        const real r0 = *(const loose *)row, r1 = *(const loose *)(row + side);
        const real r2 = *(const loose *)(row + 2 * side), r3 = *(const loose *)(row + 3 * side);
#pragma GCC unroll 12
        for (int c = 0; c < columns; c++) {
            const double *x = in + c * stride + i;
            sum[c] += (x[0] * r0 + x[1] * r1) + (x[2] * r2 + x[3] * r3);
        }
    }
    for (; i < rows.end; i++) {
        const real row = *(const loose *)(p->matrix + i * side + j);
#pragma GCC unroll 12
        for (int c = 0; c < columns; c++) {
            sum[c] += in[c * stride + i] * row;
        }
    }

#pragma GCC unroll 12
    for (int c = 0; c < columns; c++) {
        *(loose *)(out + c * stride + j) = sum[c];
    }
}

// The same of all columns: as many at once as fit, a stride's points without its start, what is
// left.
KERNEL void all_columns(const modal_product *p, panel rows, int j, const double *in, double *out)
{
    int left = p->columns;
    ptrdiff_t at = 0;
    for (; left >= TOGETHER; left -= TOGETHER, at += (ptrdiff_t)TOGETHER * p->stride) {
        block_product(p, rows, j, TOGETHER, in + at, out + at);
    }
    if (left == TOGETHER - 2) {
        block_product(p, rows, j, TOGETHER - 2, in + at, out + at);
        left = 0;
    }
    if (left == 3) {
        block_product(p, rows, j, 3, in + at, out + at);
        left = 0;
    }
    for (; left > 1; left -= 2, at += 2 * p->stride) {
        block_product(p, rows, j, 2, in + at, out + at);
    }
    if (left > 0) {
        block_product(p, rows, j, 1, in + at, out + at);
    }
}

void GLUE(modal_multiply_, LANES)(const modal_product *p, const double *in, double *out)
{
    // few rows are near enough for one panel: the last block goes back over sums that are made
    const bool few = p->rows <= NEAR_ROWS && p->width >= LANES;
    const int most = few ? p->rows : PANEL, whole = few ? p->width : p->width - p->width % LANES;
    for (int from = 0; from < p->rows; from += most) {
        const panel rows = {from, from + most < p->rows ? from + most : p->rows};
        for (int j = 0; j < whole; j += LANES) {
            all_columns(p, rows, j + LANES <= whole ? j : whole - LANES, in, out);
        }
    }

    // sums that fill no block
    for (int c = 0; c < p->columns; c++) {
        const double *x = in + (ptrdiff_t)c * p->stride;
        for (int j = whole; j < p->width; j++) {
            const double *column = p->matrix + j;
            const ptrdiff_t side = p->side;
            double sum = 0;
            int i = 0;
            for (; i + 4 <= p->rows; i += 4) {
                const double *r = column + i * side;
                sum += (x[i] * r[0] + x[i + 1] * r[side]) +
                       (x[i + 2] * r[2 * side] + x[i + 3] * r[3 * side]);
            }
            for (; i < p->rows; i++) {
                sum += x[i] * column[i * side];
            }
            out[(ptrdiff_t)c * p->stride + j] = sum;
        }
    }
}

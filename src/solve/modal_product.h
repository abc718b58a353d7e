// Products of columns with a matrix in the widest vectors of the processor; the same bits in all of
// them.
#pragma once

// out[column][j] = sum over i < rows of in[column][i] matrix[i][j], j < width; columns are `stride`
// doubles apart, the matrix's rows `side`.
typedef struct modal_product {
    const double *matrix;
    int side, rows, width;
    int columns, stride;
} modal_product;
void modal_multiply(const modal_product *p, const double *in, double *out);

// In vectors of as many as the name says (modal_product_kernel.h).
void modal_multiply_1(const modal_product *p, const double *in, double *out);
void modal_multiply_2(const modal_product *p, const double *in, double *out);
void modal_multiply_4(const modal_product *p, const double *in, double *out);
void modal_multiply_8(const modal_product *p, const double *in, double *out);

// MAT files of version 5, which MATLAB, Octave and scipy read: named matrices of doubles.
//
// After a header of 128 bytes each matrix is an element: type, size in bytes, then its
// flags, dimensions, name and columns one after the other, each an element that ends on a
// multiple of eight bytes (MathWorks, MAT-File Format, chapter 1). Byte order is the
// machine's, as the header says.
#pragma once

#include <complex.h>
#include <stdio.h>

// The head of a file. Errors of all three stay in the stream.
void mat_file_begin(FILE *stream);

// A matrix of rows x columns numbers, row by row in memory. A name is a letter, then
// letters, digits and underscores.
void mat_file_matrix(FILE *stream, const char *name, int rows, int columns,
                     const double *values);

// A column of complex numbers.
void mat_file_complex(FILE *stream, const char *name, int count,
                      const double complex *values);

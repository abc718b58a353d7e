// MAT files of version 5, which MATLAB, Octave and scipy read: named matrices of doubles,
// texts, and texts by name in a struct.
//
// After a header of 128 bytes each matrix is an element: type, size in bytes, then its
// flags, dimensions, name and columns one after the other, each an element that ends on a
// multiple of eight bytes (MathWorks, MAT-File Format, chapter 1). Byte order is the
// machine's, as the header says.
#pragma once

#include <complex.h>
#include <stdio.h>

// A matrix takes this many bytes at most in a file of this version.
#define MAT_MOST_BYTES 2147483647.0

// The head of a file. Errors of all of these stay in the stream.
void mat_file_begin(FILE *stream);

// A matrix of rows x columns numbers, row by row in memory. A name is a letter, then
// letters, digits and underscores.
void mat_file_matrix(FILE *stream, const char *name, int rows, int columns,
                     const double *values);

// A column of so many numbers, whose bytes follow.
void mat_file_column(FILE *stream, const char *name, size_t rows);

// A text, and a struct of texts, each under a name of at most 31 characters.
void mat_file_text(FILE *stream, const char *name, const char *text);
void mat_file_texts(FILE *stream, const char *name, const char *const *names,
                    const char *const *texts, int count);

// A column of complex numbers.
void mat_file_complex(FILE *stream, const char *name, int count,
                      const double complex *values);

#include "src/exchange/mat_file.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

// Types of elements, and the class of a matrix of doubles.
enum {
    INT8 = 1,
    INT32 = 5,
    UINT32 = 6,
    DOUBLE = 9,
    MATRIX = 14,
    CLASS_DOUBLE = 6,
    COMPLEX = 1 << 11
};

static void write_word(FILE *stream, size_t word)
{
    const uint32_t four = (uint32_t)word;
    fwrite(&four, sizeof four, 1, stream);
}

// An element's type and size.
static void put_tag(FILE *stream, int type, size_t size)
{
    write_word(stream, (size_t)type);
    write_word(stream, size);
}

static size_t padded_to_eight(size_t size)
{
    return (size + 7) / 8 * 8;
}

void mat_file_begin(FILE *stream)
{
    fprintf(stream, "%-124s", "MATLAB 5.0 MAT-file, written by impactlab");
    const uint16_t version = 0x0100, order = 'M' << 8 | 'I';
    fwrite(&version, sizeof version, 1, stream);
    fwrite(&order, sizeof order, 1, stream);
}

// All of a matrix before its numbers, of which there are `parts` sets: real, or real and
// imaginary.
static void begin_matrix(FILE *stream, const char *name, int rows, int columns,
                         size_t parts)
{
    static const char zeros[8];
    const size_t length = strlen(name), count = (size_t)rows * (size_t)columns;
    assert(length > 0 && rows >= 0 && columns >= 0);

    // the whole matrix, and its flags
    put_tag(stream, MATRIX,
            16 + 16 + 8 + padded_to_eight(length) + parts * (8 + 8 * count));
    put_tag(stream, UINT32, 8);
    size_t class = CLASS_DOUBLE;
    if (parts > 1) {
        class |= COMPLEX;
    }
    write_word(stream, class);
    write_word(stream, 0);

    // its dimensions and its name
    put_tag(stream, INT32, 8);
    write_word(stream, (size_t)rows);
    write_word(stream, (size_t)columns);
    put_tag(stream, INT8, length);
    fwrite(name, 1, length, stream);
    fwrite(zeros, 1, padded_to_eight(length) - length, stream);
}

void mat_file_matrix(FILE *stream, const char *name, int rows, int columns,
                     const double *values)
{
    begin_matrix(stream, name, rows, columns, 1);
    put_tag(stream, DOUBLE, 8 * (size_t)rows * (size_t)columns);
    for (int j = 0; j < columns; j++) {
        for (int i = 0; i < rows; i++) {
            fwrite(&values[i * columns + j], sizeof *values, 1, stream);
        }
    }
}

void mat_file_complex(FILE *stream, const char *name, int count,
                      const double complex *values)
{
    begin_matrix(stream, name, count, 1, 2);
    for (int part = 0; part < 2; part++) {
        put_tag(stream, DOUBLE, 8 * (size_t)count);
        for (int i = 0; i < count; i++) {
            const double number = part == 0 ? creal(values[i]) : cimag(values[i]);
            fwrite(&number, sizeof number, 1, stream);
        }
    }
}

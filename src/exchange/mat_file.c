#include "src/exchange/mat_file.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>

// Types of elements, and classes of matrices.
enum {
    INT8 = 1,
    INT32 = 5,
    UINT32 = 6,
    DOUBLE = 9,
    MATRIX = 14,
    UTF8 = 16,
    CLASS_STRUCT = 2,
    CLASS_TEXT = 4,
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

// Bytes as an element, up to a multiple of eight.
static void put_element(FILE *stream, int type, const char *bytes, size_t size)
{
    static const char zeros[8];
    put_tag(stream, type, size);
    fwrite(bytes, 1, size, stream);
    fwrite(zeros, 1, padded_to_eight(size) - size, stream);
}

// The size of what begin_matrix writes behind the first tag.
static size_t head_size(const char *name)
{
    return 16 + 16 + 8 + padded_to_eight(strlen(name));
}

// All of a matrix before its content, which takes `size` bytes.
static void begin_matrix(FILE *stream, const char *name, size_t class, size_t rows,
                         size_t columns, size_t size)
{
    // the whole matrix, and its flags
    put_tag(stream, MATRIX, head_size(name) + size);
    put_tag(stream, UINT32, 8);
    write_word(stream, class);
    write_word(stream, 0);

    // its dimensions and its name
    put_tag(stream, INT32, 8);
    write_word(stream, rows);
    write_word(stream, columns);
    put_element(stream, INT8, name, strlen(name));
}

void mat_file_column(FILE *stream, const char *name, size_t rows)
{
    assert((double)rows * sizeof(double) < MAT_MOST_BYTES);
    begin_matrix(stream, name, CLASS_DOUBLE, rows, 1, 8 + rows * sizeof(double));
    put_tag(stream, DOUBLE, rows * sizeof(double));
}

void mat_file_matrix(FILE *stream, const char *name, int rows, int columns,
                     const double *values)
{
    assert(name[0] != '\0' && rows >= 0 && columns >= 0);
    const size_t size = sizeof *values * (size_t)rows * (size_t)columns;
    begin_matrix(stream, name, CLASS_DOUBLE, (size_t)rows, (size_t)columns, 8 + size);
    put_tag(stream, DOUBLE, size);
    for (int j = 0; j < columns; j++) {
        for (int i = 0; i < rows; i++) {
            fwrite(&values[i * columns + j], sizeof *values, 1, stream);
        }
    }
}

void mat_file_complex(FILE *stream, const char *name, int count,
                      const double complex *values)
{
    const size_t size = sizeof(double) * (size_t)count;
    begin_matrix(stream, name, CLASS_DOUBLE | COMPLEX, (size_t)count, 1, 2 * (8 + size));
    for (int part = 0; part < 2; part++) {
        put_tag(stream, DOUBLE, size);
        for (int i = 0; i < count; i++) {
            const double number = part == 0 ? creal(values[i]) : cimag(values[i]);
            fwrite(&number, sizeof number, 1, stream);
        }
    }
}

// --- texts -----------------------------------------------------------------------------

// How many characters a text has: bytes that do not continue one.
static size_t characters_in(const char *text)
{
    size_t count = 0;
    for (; *text != '\0'; text++) {
        count += ((unsigned char)*text & 0xc0) != 0x80;
    }
    return count;
}

// The size of a text's element.
static size_t text_size(const char *text)
{
    return 8 + padded_to_eight(strlen(text));
}

void mat_file_text(FILE *stream, const char *name, const char *text)
{
    begin_matrix(stream, name, CLASS_TEXT, 1, characters_in(text), text_size(text));
    put_element(stream, UTF8, text, strlen(text));
}

void mat_file_texts(FILE *stream, const char *name, const char *const *names,
                    const char *const *texts, int count)
{
    enum { NAME_FIELD = 32 };
    size_t size = 8 + 8 + (size_t)count * NAME_FIELD;
    for (int i = 0; i < count; i++) {
        size += 8 + head_size("") + text_size(texts[i]);
    }
    begin_matrix(stream, name, CLASS_STRUCT, 1, 1, size);

    // the length of names, a short element, which has its size and type in one word
    write_word(stream, sizeof(uint32_t) << 16 | INT32);
    write_word(stream, NAME_FIELD);

    // the names, filled up with zeros, and the texts, which have none of their own
    put_tag(stream, INT8, (size_t)count * NAME_FIELD);
    for (int i = 0; i < count; i++) {
        char field[NAME_FIELD] = "";
        assert(strlen(names[i]) < NAME_FIELD);
        memcpy(field, names[i], strlen(names[i]));
        fwrite(field, 1, NAME_FIELD, stream);
    }
    for (int i = 0; i < count; i++) {
        mat_file_text(stream, "", texts[i]);
    }
}

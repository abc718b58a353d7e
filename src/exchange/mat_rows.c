#include "src/exchange/mat_rows.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/exchange/mat_file.h"

enum { BLOCK_ROWS = 1 << 12 };

struct mat_rows {
    whole_file *file;
    int kept;      // descriptor of the full blocks, column after column in each
    int reason;    // errno of the first of their writes that failed, 0 if none did
    double *block; // the block that is being filled: columns of BLOCK_ROWS numbers
    int count;     // columns
    size_t blocks; // full ones
    size_t rows;   // in the block that is being filled
};

mat_rows *mat_rows_begin(whole_file *file, int count, fault *f)
{
    assert(count > 0);
    mat_rows *m = calloc(1, sizeof *m);
    if (m == NULL) {
        fault_no_memory(f);
        return NULL;
    }
    m->file = file;
    m->count = count;
    m->kept = -1;
    m->block = calloc(BLOCK_ROWS * (size_t)count, sizeof *m->block);
    if (m->block == NULL) {
        mat_rows_destroy(m);
        fault_no_memory(f);
        return NULL;
    }

    if (whole_file_scratch(file, &m->kept, f) != STATUS_OK) {
        mat_rows_destroy(m);
        return NULL;
    }
    return m;
}

void mat_rows_destroy(mat_rows *m)
{
    if (m == NULL) {
        return;
    }
    if (m->kept >= 0) {
        close(m->kept);
    }
    free(m->block);
    free(m);
}

void mat_rows_number(mat_rows *m, int column, double value)
{
    m->block[(size_t)column * BLOCK_ROWS + m->rows] = value;
}

// Keeps the block that has become full.
static void keep_block(mat_rows *m)
{
    const char *bytes = (const char *)m->block;
    size_t left = BLOCK_ROWS * (size_t)m->count * sizeof *m->block;
    while (left > 0 && m->reason == 0) {
        const ssize_t written = TEMP_FAILURE_RETRY(write(m->kept, bytes, left));
        if (written < 0) {
            m->reason = errno;
        } else {
            bytes += written;
            left -= (size_t)written;
        }
    }
    m->blocks++;
}

void mat_rows_end_row(mat_rows *m)
{
    m->rows++;
    if (m->rows == BLOCK_ROWS) {
        keep_block(m);
        m->rows = 0;
    }
}

// Reads the numbers of a column in a block that was kept. False with errno.
static bool read_kept(const mat_rows *m, size_t block, int column,
                      double numbers[BLOCK_ROWS])
{
    const size_t size = BLOCK_ROWS * sizeof *numbers;
    const size_t from = (block * (size_t)m->count + (size_t)column) * size;
    const ssize_t got = TEMP_FAILURE_RETRY(pread(m->kept, numbers, size, (off_t)from));
    if (got >= 0 && (size_t)got < size) {
        errno = EIO; // the disk lost some of it
    }
    return got >= 0 && (size_t)got == size;
}

status mat_rows_end(mat_rows *m, const char *const *names, fault *f)
{
    const size_t rows = m->blocks * BLOCK_ROWS + m->rows;
    const double most = MAT_MOST_BYTES / sizeof(double);
    FAULT_IF(m->reason != 0, f, STATUS_CANNOT_WRITE,
             "the rows of '%s' cannot be kept beside it: %s", m->file->path,
             strerror(m->reason));
    FAULT_IF((double)rows > most, f, STATUS_CANNOT_WRITE,
             "'%s' cannot have %zu rows: a MAT file of version 5 takes %.0f; Parquet has "
             "no such limit",
             m->file->path, rows, most);

    // each column from all blocks, the last one from memory
    FILE *stream = m->file->stream;
    mat_file_begin(stream);
    for (int i = 0; i < m->count; i++) {
        mat_file_column(stream, names[i], rows);
        for (size_t b = 0; b < m->blocks; b++) {
            double numbers[BLOCK_ROWS];
            FAULT_IF(!read_kept(m, b, i, numbers), f, STATUS_CANNOT_WRITE,
                     "the rows of '%s' that were kept beside it cannot be read: %s",
                     m->file->path, strerror(errno));
            fwrite(numbers, sizeof *numbers, BLOCK_ROWS, stream);
        }
        fwrite(m->block + (size_t)i * BLOCK_ROWS, sizeof *m->block, m->rows, stream);
    }
    return STATUS_OK;
}

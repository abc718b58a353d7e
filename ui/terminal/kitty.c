// The terminal graphics protocol of kitty: pixels, compressed by zlib, in base 64, in chunks.
#include "ui/terminal/pixel_code.h"

#include <assert.h>
#include <stdlib.h>
#include <zlib.h>

enum { CHUNK = 4096, CHUNK_BYTES = CHUNK / 4 * 3 };

// Writes up to CHUNK_BYTES bytes in base 64.
static void write_base64(FILE *stream, const unsigned char *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < count; i += 3) {
        const unsigned second = i + 1 < count ? bytes[i + 1] : 0;
        const unsigned third = i + 2 < count ? bytes[i + 2] : 0;
        const unsigned three = (unsigned)bytes[i] << 16 | second << 8 | third;
        putc_unlocked(digits[three >> 18], stream);
        putc_unlocked(digits[three >> 12 & 63], stream);
        putc_unlocked(i + 1 < count ? digits[three >> 6 & 63] : '=', stream);
        putc_unlocked(i + 2 < count ? digits[three & 63] : '=', stream);
    }
}

bool kitty_write(FILE *stream, const pixel_block *block, int number, int columns, int rows)
{
    assert(stream != NULL && block != NULL && block->width > 0 && block->height > 0);
    assert(number > 0 && columns > 0 && rows > 0);
    const size_t size = 3 * (size_t)block->width * (size_t)block->height;
    uLongf packed_size = compressBound(size);
    unsigned char *plain = malloc(size), *packed = malloc(packed_size), *at = plain;

    // red, green and blue, row after row
    for (int y = 0; plain != NULL && y < block->height; y++) {
        const uint32_t *row = block->pixels + (long)y * block->stride;
        for (int x = 0; x < block->width; x++) {
            *at++ = (unsigned char)(row[x] >> 16);
            *at++ = (unsigned char)(row[x] >> 8);
            *at++ = (unsigned char)row[x];
        }
    }
    const bool done = plain != NULL && packed != NULL &&
                      compress2(packed, &packed_size, plain, size, Z_BEST_SPEED) == Z_OK;

    // the first chunk says what it is, all but the last that more come; no answer is wanted
    for (size_t sent = 0; done && sent < packed_size; sent += CHUNK_BYTES) {
        const size_t left = packed_size - sent, count = left < CHUNK_BYTES ? left : CHUNK_BYTES;
        fputs("\033_G", stream);
        if (sent == 0) {
            fprintf(stream, "a=T,i=%d,p=1,f=24,s=%d,v=%d,c=%d,r=%d,o=z,C=1,q=2,", number,
                    block->width, block->height, columns, rows);
        }
        fprintf(stream, "m=%d;", left > CHUNK_BYTES);
        write_base64(stream, packed + sent, count);
        fputs("\033\\", stream);
    }

    free(plain);
    free(packed);
    return done;
}

void kitty_delete(FILE *stream, int number)
{
    assert(stream != NULL && number >= 0);
    if (number == 0) {
        fputs("\033_Ga=d,d=A,q=2\033\\", stream);
    } else {
        fprintf(stream, "\033_Ga=d,d=I,i=%d,q=2\033\\", number);
    }
}

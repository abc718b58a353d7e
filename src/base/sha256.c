#include "src/base/sha256.h"

#include <assert.h>
#include <string.h>

enum { BLOCK = 64, LENGTH_AT = 56 };

// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
static const uint32_t constants[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4,
    0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe,
    0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f,
    0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7,
    0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc,
    0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b,
    0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116,
    0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7,
    0xc67178f2};

void sha256_init(sha256 *h)
{
    // the same of the square roots of the first eight
    *h = (sha256){.state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f,
                            0x9b05688c, 0x1f83d9ab, 0x5be0cd19}};
}

static uint32_t rotate_right(uint32_t x, int bits)
{
    return x >> bits | x << (32 - bits);
}

// Takes a whole block into the state.
static void take_block(uint32_t state[8], const unsigned char *block)
{
    // the block's words in big-endian order, and 48 more made of them
    uint32_t w[64];
    for (int i = 0; i < 16; i++) {
        const unsigned char *b = block + 4 * i;
        w[i] = (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
    }
    for (int i = 16; i < 64; i++) {
        const uint32_t a = w[i - 15], b = w[i - 2];
        w[i] = w[i - 16] + (rotate_right(a, 7) ^ rotate_right(a, 18) ^ a >> 3) +
               w[i - 7] + (rotate_right(b, 17) ^ rotate_right(b, 19) ^ b >> 10);
    }

    // 64 rounds, a to h of the standard being v[0] to v[7]
    uint32_t v[8];
    memcpy(v, state, sizeof v);
    for (int i = 0; i < 64; i++) {
        const uint32_t e = v[4], a = v[0];
        const uint32_t first =
            v[7] + (rotate_right(e, 6) ^ rotate_right(e, 11) ^ rotate_right(e, 25)) +
            ((e & v[5]) ^ (~e & v[6])) + constants[i] + w[i];
        const uint32_t second =
            (rotate_right(a, 2) ^ rotate_right(a, 13) ^ rotate_right(a, 22)) +
            ((a & v[1]) ^ (a & v[2]) ^ (v[1] & v[2]));
        memmove(v + 1, v, 7 * sizeof v[0]);
        v[4] += first;
        v[0] = first + second;
    }
    for (int i = 0; i < 8; i++) {
        state[i] += v[i];
    }
}

void sha256_add(sha256 *h, const void *bytes, size_t size)
{
    assert(bytes != NULL || size == 0);
    const unsigned char *from = bytes;
    while (size > 0) {
        // as much as the open block has room for
        const size_t used = h->length % BLOCK, room = BLOCK - used;
        const size_t count = size < room ? size : room;

        memcpy(h->block + used, from, count);
        h->length += count;
        from += count;
        size -= count;

        if (count == room) {
            take_block(h->state, h->block);
        }
    }
}

void sha256_finish(sha256 *h, char text[SHA256_TEXT])
{
    const uint64_t bits = 8 * h->length;
    const unsigned char one = 0x80, zero = 0;

    // a one bit, zeros, and the length in bits at the end of a block
    sha256_add(h, &one, 1);
    while (h->length % BLOCK != LENGTH_AT) {
        sha256_add(h, &zero, 1);
    }
    unsigned char length[8];
    for (int i = 0; i < 8; i++) {
        length[i] = (unsigned char)(bits >> (56 - 8 * i));
    }
    sha256_add(h, length, sizeof length);

    // the state, most significant digit first
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < SHA256_TEXT - 1; i++) {
        text[i] = digits[h->state[i / 8] >> (28 - 4 * (i % 8)) & 15];
    }
    text[SHA256_TEXT - 1] = '\0';
}

void sha256_add_text(sha256 *h, const char *text)
{
    sha256_add(h, text, strlen(text) + 1);
}

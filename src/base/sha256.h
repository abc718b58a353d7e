// SHA-256 (FIPS 180-4): a fingerprint for which nobody can find a second content.
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { SHA256_TEXT = 65 }; // of a digest in hexadecimal digits, with the zero behind it

typedef struct sha256 {
    uint32_t state[8];
    uint64_t length; // taken in so far [bytes]
    unsigned char block[64];
} sha256;

// Begins a digest; sha256_add takes in `size` bytes.
void sha256_init(sha256 *h);
void sha256_add(sha256 *h, const void *bytes, size_t size);

// Writes the digest as 64 hexadecimal digits; nothing more can be added then.
void sha256_finish(sha256 *h, char text[SHA256_TEXT]);

// Takes in a text with its end, so that two texts are not taken for two others.
void sha256_add_text(sha256 *h, const char *text);

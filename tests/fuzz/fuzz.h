// Shared by the fuzz targets. Each target is a program with one function that takes any bytes;
// libFuzzer calls it (tests/fuzz/run), or driver.c with mutations of the corpus.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// Ends the program where a promise is broken; unlike an assertion it is always looked at.
#define FUZZ_CHECK(promise) ((promise) ? (void)0 : fuzz_fail(__FILE__, __LINE__, #promise))

static inline void fuzz_fail(const char *file, int line, const char *promise)
{
    dprintf(2, "%s:%d: broken: %s\n", file, line, promise);
    abort();
}

// The bytes as a text with its end, in memory of exactly that size; to be freed.
static inline char *fuzz_text(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    FUZZ_CHECK(text != NULL);
    for (size_t i = 0; i < size; i++) {
        text[i] = (char)data[i];
    }
    text[size] = '\0';
    return text;
}

// Makes a folder of the target's own the current one, which goes with the program, and empties it.
void fuzz_folder(void);

// Writes the bytes into a file of the target's own, which the next call replaces. Returns its path.
const char *fuzz_file(const uint8_t *data, size_t size);

// A scenario of a text that is a good one.
struct scenario;
void fuzz_scenario(struct scenario *s, const char *yaml);

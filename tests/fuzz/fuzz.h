// Shared by the fuzz targets. Each target is a program with one function that takes any
// bytes; libFuzzer calls it (tests/fuzz/run), or driver.c with mutations of the corpus.
#pragma once

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/scenario/scenario.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// Ends the program where a promise is broken; unlike an assertion it is always looked at.
#define FUZZ_CHECK(promise)                                                              \
    ((promise) ? (void)0 : fuzz_fail(__FILE__, __LINE__, #promise))

static inline void fuzz_fail(const char *file, int line, const char *promise)
{
    dprintf(2, "%s:%d: broken: %s\n", file, line, promise);
    abort();
}

// What was not done is said in a sentence. Returns whether it was done.
static inline bool fuzz_done(status code, const fault *f)
{
    FUZZ_CHECK(code == STATUS_OK || f->text[0] != '\0');
    return code == STATUS_OK;
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

// Cuts a text into its lines, of which it keeps the first so many; returns how many.
static inline int fuzz_lines(char *text, char **lines, int most)
{
    int count = 0;
    for (char *line; count < most && (line = strsep(&text, "\n")) != NULL;) {
        lines[count++] = line;
    }
    return count;
}

// The bytes that are left; at their end there are zeros.
typedef struct source {
    const uint8_t *data;
    size_t size, at;
} source;

static inline uint8_t next(source *s)
{
    return s->at < s->size ? s->data[s->at++] : 0;
}

// One of the texts, by a number or by the next byte: FUZZ_PICK(7, "a", "b"), ONE_OF(s,
// "a", "b").
#define FUZZ_PICK(number, ...)                                                           \
    (((const char *const[]){                                                             \
        __VA_ARGS__})[(number) %                                                         \
                      (sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))])
#define ONE_OF(s, ...) FUZZ_PICK(next(s), __VA_ARGS__)

// Any letters, of no path that leaves the folder and no number that takes minutes to
// compute.
static inline void fuzz_letters(source *s, char *text, size_t most)
{
    int digits = 0;
    for (size_t left = next(s) % most; left > 0; left--) {
        const char c = (char)next(s);
        digits = isdigit((unsigned char)c) ? digits + 1 : 0;
        *text++ = c != '\0' && digits < 3 && strchr("/~eExX", c) == NULL ? c : '_';
    }
    *text = '\0';
}

// Makes a folder of the target's own the current one, which goes with the program, and
// empties it.
void fuzz_folder(void);

// Writes the bytes into a file of the target's own, which the next call replaces. Returns
// its path.
const char *fuzz_file(const uint8_t *data, size_t size);

// A scenario of a text that is a good one, what it writes (to be freed), and one that
// counts the sentences about a bad one, each of which is one.
void fuzz_scenario(scenario *s, const char *yaml);
char *fuzz_written(const scenario *s);
void fuzz_count(void *count, const char *sentence);

// The same of sentences that begin with the file's name, line and column; none shows
// anything that a terminal would obey.
void fuzz_count_placed(void *count, const char *sentence, const char *file);

// Words and numbers as people write them: decimal numbers, and the nearest known word.
#pragma once

#include <stdbool.h>

// Number of insertions, deletions and replacements that turn a into b, at most `limit` (also for
// words of more than 64 bytes).
int edit_distance(const char *a, const char *b, int limit);

// The search for the word nearest to a misspelt one.
typedef struct nearest_word {
    const char *word; // as it was written
    const char *best; // nearest so far, NULL if none is near
    int distance;     // of best; to begin with, the first distance that is too far
} nearest_word;

// Begins a search. Near means: at most half of the letters differ, and at most four.
nearest_word nearest_begin(const char *word);

// Looks at one candidate; the first of several equally near ones is kept. The part after the last
// '/' or '.' counts for the whole ("fig-3-4" finds "thesis/fig-3-4").
void nearest_try(nearest_word *n, const char *candidate);

// Reads a decimal number at the start of text: no hexadecimal, infinity or NaN. *rest is what
// follows number and blanks. False if there is none.
bool decimal_read(const char *text, double *value, const char **rest);

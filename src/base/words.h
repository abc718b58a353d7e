// Words: the one nearest to a misspelt one, and texts that a terminal may show.
#pragma once

// Number of insertions, deletions, replacements and swaps of neighbours that turn a into b, at most
// `limit` (also for words of more than 64 bytes).
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

// Replaces what could disturb a terminal, control characters and broken UTF-8, by '?', in place.
void make_printable(char *text);

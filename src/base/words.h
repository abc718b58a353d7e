// Words: the one nearest to a misspelt one, and texts as they may leave the program.
#pragma once

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

// Number of insertions, deletions, replacements and swaps of neighbours that turn a into
// b, at most `limit` (also for words of more than 64 bytes).
int edit_distance(const char *a, const char *b, int limit);

// The search for the word nearest to a misspelt one.
typedef struct nearest_word {
    const char *word; // as it was written
    const char *best; // nearest so far, NULL if none is near
    int distance;     // of best; to begin with, the first distance that is too far
} nearest_word;

// Begins a search. Near means: at most half of the letters differ, and at most four.
nearest_word nearest_begin(const char *word);

// Looks at one candidate; the first of several equally near ones is kept. The part after
// the last '/' or '.' counts for the whole ("fig-3-4" finds "thesis/fig-3-4").
void nearest_try(nearest_word *n, const char *candidate);

enum { HINT_TEXT = 192 }; // room for a hint

// What a sentence says behind a name that is not known: ", did you mean 'NEAR'?", or
// `otherwise` where no name is near (NULL). Returns the hint.
const char *did_you_mean(char hint[HINT_TEXT], const char *near, const char *otherwise);

// Tables of `count` rows of `size` bytes, each of which begins with its name, a const
// char *. The index of a name, -1 if there is none such; and the name that is nearest to
// a misspelt one, NULL if none is near.
int name_find(const void *table, size_t size, int count, const char *name);
const char *name_nearest(const void *table, size_t size, int count, const char *name);

// Length of a text without an ending: of all of it if that is not its end, or nothing is
// before it.
size_t text_stem(const char *text, const char *ending);

// Whether a character (Unicode) may not leave the program in a text: a control character
// (C0 and C1, line ends too), one that turns the direction of what follows it, or a line
// or paragraph separator.
bool is_unprintable(uint32_t character);

// Length in bytes of the printable character that begins at `text`, which is not empty; 0
// if no printable character begins there.
int printable_length(const char *text);

// The one filter for texts from outside (titles, names of files and plug-ins, cells,
// complaints of other programs) on every way out: terminal, CSV, SVG, HTML. Replaces each
// byte of an unprintable character, and of broken UTF-8, by '?', in place, so that what
// was there is seen to be missing. `kept` stays: the line feed of a text of several
// lines, else 0.
void make_printable(char *text, char kept);

// Prints like printf, with a decimal point, what make_printable leaves of the text, line
// feeds too. What is lost of a long one without memory is noted (text_stream.h); errors
// stay in the stream.
void print_printable(FILE *stream, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void print_printable_list(FILE *stream, const char *format, va_list list)
    __attribute__((format(printf, 2, 0)));

// Appends to a text in `size` bytes as much as has room, with a decimal point.
void text_add(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

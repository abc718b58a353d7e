#include "src/base/words.h"

#include <assert.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

// Optimal string alignment: Levenshtein's distance with swaps of neighbours.
int edit_distance(const char *a, const char *b, int limit)
{
    assert(a != NULL && b != NULL);
    enum { LONGEST = 64 };
    size_t la = strlen(a), lb = strlen(b);
    int rows[3][LONGEST + 1];
    int *before = rows[0], *last = rows[1], *row = rows[2];

    // words that nobody types are all equally far
    if (la > LONGEST || lb > LONGEST) {
        return limit;
    }

    // three rows of the table of distances between prefixes, used in turn
    for (size_t j = 0; j <= lb; j++) {
        row[j] = (int)j;
    }
    for (size_t i = 1; i <= la; i++) {
        int *oldest = before;
        before = last;
        last = row;
        row = oldest;
        row[0] = (int)i;
        for (size_t j = 1; j <= lb; j++) {
            row[j] =
                smaller(last[j - 1] + (a[i - 1] != b[j - 1]), smaller(last[j], row[j - 1]) + 1);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = smaller(row[j], before[j - 2] + 1);
            }
        }
    }
    return smaller(row[lb], limit);
}

nearest_word nearest_begin(const char *word)
{
    assert(word != NULL);
    size_t half = strlen(word) / 2;
    return (nearest_word){.word = word, .distance = half < 4 ? (int)half + 1 : 5};
}

// The part of a name after its last '/' or '.'.
static const char *last_part(const char *name)
{
    const char *part = name;
    for (const char *c = name; *c != '\0'; c++) {
        if (*c == '/' || *c == '.') {
            part = c + 1;
        }
    }
    return part;
}

void nearest_try(nearest_word *n, const char *candidate)
{
    assert(n->word != NULL && candidate != NULL);
    int whole = edit_distance(n->word, candidate, n->distance);
    int part = edit_distance(n->word, last_part(candidate), n->distance);
    int distance = whole < part ? whole : part;
    if (distance < n->distance) {
        n->distance = distance;
        n->best = candidate;
    }
}

void make_printable(char *text)
{
    assert(text != NULL);
    for (unsigned char *c = (unsigned char *)text; *c != '\0';) {
        // bytes of the character that begins here, 0 if none can, and how many of them follow
        int length = *c < 0x80 ? 1 : *c >= 0xf0 ? 4 : *c >= 0xe0 ? 3 : *c >= 0xc2 ? 2 : 0;
        int have = length > 0;
        while (have > 0 && have < length && (c[have] & 0xc0) == 0x80) {
            have++;
        }

        bool control = *c < 0x20 || *c == 0x7f || (*c == 0xc2 && c[1] < 0xa0);
        if (have < length || length == 0 || control) {
            *c = '?';
            c++;
        } else {
            c += length;
        }
    }
}

#include "src/base/words.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

int edit_distance(const char *a, const char *b, int limit)
{
    assert(a != NULL && b != NULL);
    enum { LONGEST = 64 };
    size_t la = strlen(a), lb = strlen(b);
    int row[LONGEST + 1];
    if (la > LONGEST || lb > LONGEST) {
        return limit;
    }
    // one row of the table of prefix distances, overwritten letter by letter
    for (size_t j = 0; j <= lb; j++) {
        row[j] = (int)j;
    }
    for (size_t i = 1; i <= la; i++) {
        int diagonal = row[0];
        row[0] = (int)i;
        for (size_t j = 1; j <= lb; j++) {
            int replaced = diagonal + (a[i - 1] != b[j - 1]);
            int shifted = (row[j] < row[j - 1] ? row[j] : row[j - 1]) + 1;
            diagonal = row[j];
            row[j] = replaced < shifted ? replaced : shifted;
        }
    }
    return row[lb] < limit ? row[lb] : limit;
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

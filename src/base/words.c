#include "src/base/words.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/fault.h"
#include "src/base/text_stream.h"
#include "src/base/numbers.h"

static int smaller_count(int a, int b)
{
    if (a < b) {
        return a;
    }
    return b;
}

// Optimal string alignment: Levenshtein's distance with swaps of neighbours.
int edit_distance(const char *a, const char *b, int limit)
{
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
            // a letter kept or replaced, or one inserted or deleted
            int replaced = last[j - 1];
            if (a[i - 1] != b[j - 1]) {
                replaced++;
            }
            row[j] = smaller_count(replaced, smaller_count(last[j], row[j - 1]) + 1);

            // or two neighbours swapped
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = smaller_count(row[j], before[j - 2] + 1);
            }
        }
    }
    return smaller_count(row[lb], limit);
}

// A search for a word of which at most half of the letters differ, and at most four.
nearest_word nearest_begin(const char *word)
{
    // the first distance that is too far
    enum { MOST_DIFFERENT = 4 };
    const size_t half = strlen(word) / 2;
    nearest_word near = {.word = word, .distance = MOST_DIFFERENT + 1};
    if (half < MOST_DIFFERENT) {
        near.distance = (int)half + 1;
    }
    return near;
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
    const int whole = edit_distance(n->word, candidate, n->distance);
    const int part = edit_distance(n->word, last_part(candidate), n->distance);
    const int distance = smaller_count(whole, part);
    if (distance < n->distance) {
        n->distance = distance;
        n->best = candidate;
    }
}

const char *did_you_mean(char hint[HINT_TEXT], const char *near, const char *otherwise)
{
    if (near == NULL) {
        snprintf(hint, HINT_TEXT, "%s", otherwise);
    } else {
        snprintf(hint, HINT_TEXT, ", did you mean '%.160s'?", near);
    }
    return hint;
}

static const char *name_at(const void *table, size_t size, int index)
{
    const void *row = (const char *)table + (size_t)index * size;
    return *(const char *const *)row;
}

int name_find(const void *table, size_t size, int count, const char *name)
{
    int i = 0;
    while (i < count && strcmp(name_at(table, size, i), name) != 0) {
        i++;
    }
    if (i < count) {
        return i;
    }
    return -1;
}

const char *name_nearest(const void *table, size_t size, int count, const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < count; i++) {
        nearest_try(&near, name_at(table, size, i));
    }
    return near.best;
}

size_t text_stem(const char *text, const char *ending)
{
    const size_t length = strlen(text), tail = strlen(ending);
    const bool ends = length > tail && strcmp(text + length - tail, ending) == 0;
    if (ends) {
        return length - tail;
    }
    return length;
}

bool is_unprintable(uint32_t character)
{
    const bool control = character < 0x20 || (character >= 0x7f && character < 0xa0);
    const bool separator = character == 0x2028 || character == 0x2029;
    const bool direction = character == 0x061c || character == 0x200e ||
                           character == 0x200f ||
                           (character >= 0x202a && character <= 0x202e) ||
                           (character >= 0x2066 && character <= 0x2069);
    return control || separator || direction;
}

// Length in bytes of a character of UTF-8, as its first byte says; 0 if none begins so.
static int length_by_first_byte(unsigned char first)
{
    if (first < 0x80) {
        return 1;
    }
    if (first < 0xc2) {
        return 0;
    }
    if (first < 0xe0) {
        return 2;
    }
    if (first < 0xf0) {
        return 3;
    }
    if (first < 0xf5) {
        return 4;
    }
    return 0;
}

// Length in bytes of the character of UTF-8 that begins at c, 0 if no whole one does;
// sets *number to its number in Unicode.
static int whole_character(const unsigned char *c, uint32_t *number)
{
    const int length = length_by_first_byte(*c);
    *number = *c;
    if (length <= 1) {
        return length;
    }

    // some bits in the first byte, and six in each that follows
    *number = *c & (0x7fu >> length);
    for (int i = 1; i < length; i++) {
        if ((c[i] & 0xc0) != 0x80) {
            return 0;
        }
        *number = *number << 6 | (c[i] & 0x3fu);
    }

    // more bytes than the number needs, half of a surrogate pair, or a number beyond the
    // last character of Unicode
    const bool broken = (length == 3 && *number < 0x800) ||
                        (length == 4 && *number < 0x10000) ||
                        (*number >= 0xd800 && *number < 0xe000) || *number > 0x10ffff;
    if (broken) {
        return 0;
    }
    return length;
}

int printable_length(const char *text)
{
    assert(*text != '\0');
    uint32_t character;
    const int length = whole_character((const unsigned char *)text, &character);
    if (is_unprintable(character)) {
        return 0;
    }
    return length;
}

void make_printable(char *text, char kept)
{
    // the bytes after the first of a character that goes begin none, and go one by one
    while (*text != '\0') {
        int length = 1;
        if (*text != kept) {
            length = printable_length(text);
        }

        if (length == 0) {
            *text = '?';
            length = 1;
        }
        text += length;
    }
}

void print_printable_list(FILE *stream, const char *format, va_list list)
{
    char brief[1024], *text = brief;
    va_list again;
    va_copy(again, list);

    // most texts need no memory; a longer one is cut where there is none
    const int length = decimal_vprint(brief, sizeof brief, format, list);
    loss_unless(length >= 0);
    if (length >= (int)sizeof brief) {
        char *whole = decimal_vtext(format, again);
        loss_unless(whole != NULL);
        if (whole != NULL) {
            text = whole;
        }
    }
    va_end(again);

    make_printable(text, '\n');
    fputs(text, stream);
    if (text != brief) {
        free(text);
    }
}

void print_printable(FILE *stream, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    print_printable_list(stream, format, list);
    va_end(list);
}

void text_add(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list list;
    assert(used < size);
    va_start(list, format);
    decimal_vprint(text + used, size - used, format, list);
    va_end(list);
}

// Calls a fuzz target without libFuzzer: with every file of the folders on the command
// line, and with ROUNDS deterministic mutations of each.
//
// TARGET ROUNDS FOLDER...
#include "tests/fuzz/fuzz.h"

#include <ftw.h>
#include <string.h>

enum { MOST_BYTES = 1 << 16 };

static size_t rounds, inputs;

// Marsaglia's xorshift with 64 bits (Journal of Statistical Software 8, 2003).
static uint64_t random_state = 88172645463325252u;

static size_t random_below(size_t limit)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (size_t)(random_state % limit);
}

// Puts `length` bytes in at `at`; returns the new size.
static size_t insert(char *text, size_t size, size_t at, const char *bytes, size_t length)
{
    if (size + length > MOST_BYTES) {
        return size;
    }
    memmove(text + at + length, text + at, size - at);
    memcpy(text + at, bytes, length);
    return size + length;
}

// Damages the text in one way out of five; returns the new size.
static size_t mutate(char *text, size_t size)
{
    size_t at = random_below(size + 1);
    size_t length = 1 + random_below(24);
    length = length < size - at ? length : size - at;
    const size_t which = random_below(1 << 20);
    switch (random_below(5)) {
    case 0: // another byte
        if (at < size) {
            text[at] = (char)random_below(256);
        }
        return size;
    case 1: // a part is missing
        memmove(text + at, text + at + length, size - at - length);
        return size - length;
    case 2: // a part is there twice
    {
        char part[24] = "";
        memcpy(part, text + at, length);
        return insert(text, size, at, part, length);
    }
    case 3: // the end is missing, now and then
        return random_below(8) == 0 ? at : size;
    default:
        break;
    }

    // what a damaged file may hold
    const char *piece =
        FUZZ_PICK(which, "{", "}", "[", "]", ":", "- ", "\n", "\n  ", "#", "\"", "'",
                  "|\n", ">\n", "&a ", "*a", "!!str ", "---\n", "...\n", "\t", "\xff",
                  "\xc3", "\xef\xbb\xbf", "\xe2\x80\xa8", "%YAML 1.1\n", "? ", "null",
                  "~", "nan", "-1", "1e999", ".inf", "0x1p9", "\"\\0\"", "\"\\e\"",
                  "arm:", "k2: ", "script:\n  - at: 0.1\n    push: 1\n",
                  "set: {motor.voltage: 2 V}",
                  "expect:\n  impacts: {value: 3, tolerance: 0}\n", "at: 1e9", "links: 3",
                  "model: printed", "tolerance: -1", "first_contact_s: null\n",
                  "duration: 1e5", "<<: ");
    return insert(text, size, at, piece, strlen(piece));
}

static size_t read_bytes(const char *path, char *text)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s: cannot be opened, expected a file\n", path);
        exit(1);
    }
    size_t size = fread(text, 1, MOST_BYTES, file);
    fclose(file);
    return size;
}

static void call(const char *text, size_t size)
{
    LLVMFuzzerTestOneInput((const uint8_t *)text, size);
    inputs++;
}

// A file as it is, then with one to eight damages, again and again.
static int try_file(const char *path, const struct stat *about, int kind,
                    struct FTW *where)
{
    static char original[MOST_BYTES], text[MOST_BYTES];
    (void)about;
    (void)where;
    if (kind != FTW_F) {
        return 0;
    }

    const size_t original_size = read_bytes(path, original);
    call(original, original_size);
    for (size_t round = 0; round < rounds; round++) {
        size_t size = original_size;
        memcpy(text, original, size);
        for (size_t damages = 1 + random_below(8); damages > 0; damages--) {
            size = mutate(text, size);
        }
        call(text, size);
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "expected: TARGET ROUNDS FOLDER...\n");
        return 2;
    }
    rounds = strtoul(argv[1], NULL, 10);
    for (int i = 2; i < argc; i++) {
        nftw(argv[i], try_file, 16, FTW_PHYS);
    }
    printf("%zu inputs\n", inputs);
    return inputs > 0 ? 0 : 1;
}

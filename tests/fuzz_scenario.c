// Feeds damaged files to the scenario reader: it may refuse them, with a sentence and a place, but
// never crash, and what it accepts must keep the promises of scenario.h.
//
// With libFuzzer:
//   clang -g -O1 -fsanitize=fuzzer,address,undefined -DLIBFUZZER -D_GNU_SOURCE -I. ... -lyaml
// Without it, main() below runs the files on the command line, or else deterministic mutations of
// the shipped scenarios.
#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "src/run/run.h"
#include "src/scenario/scenario.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// Every sentence begins with "f:line:column: " and holds nothing that a terminal would obey.
static void check_sentence(void *context, const char *sentence)
{
    int *count = context;
    int line = 0, column = 0, length = 0;
    sscanf(sentence, "f:%d:%d: %n", &line, &column, &length);
    assert(line >= 1 && column >= 1 && length > 0 && sentence[length] != '\0');
    for (const char *c = sentence; *c != '\0'; c++) {
        assert(!iscntrl((unsigned char)*c) || (unsigned char)*c >= 0x80);
    }
    ++*count;
}

static void check_accepted(const scenario *s)
{
    assert(s->name && s->file && s->title && s->description);
    assert(strchr(s->title, '\n') == NULL);
    for (int i = 0; i < parameter_count; i++) {
        double value = parameter_get(&s->parameters, i);
        assert(isfinite(value));
        assert(!s->parameters.set[i] ||
               (value >= parameter_table[i].minimum && value <= parameter_table[i].maximum));
    }
    for (int i = 0; i < s->action_count; i++) {
        const action *a = &s->actions[i];
        assert(isfinite(a->value) && a->time >= 0 && a->time <= s->parameters.run.duration);
        assert(i == 0 || s->actions[i - 1].time <= a->time);
        assert(a->kind == ACTION_PUSH || parameter_table[a->parameter].timed);
    }
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        assert(e->is_null || (isfinite(e->value) && e->tolerance >= 0));
        assert(e->line >= 1 && e->column >= 1);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    scenario s;
    int count = 0;
    // a copy of exactly this size, so that reading one byte too far is noticed
    char *text = malloc(size + (size == 0));
    assert(text != NULL);
    if (size > 0) {
        memcpy(text, data, size);
    }
    status result = scenario_parse(&s, text, size, "f", "name", check_sentence, &count);
    assert((result == STATUS_OK) == (count == 0));
    if (result == STATUS_OK) {
        check_accepted(&s);
        scenario_finish(&s);
    }
    free(text);
    return 0;
}

#ifndef LIBFUZZER

enum { MOST_BYTES = 1 << 16, ROUNDS = 400 };

// Marsaglia's xorshift with 64 bits (Journal of Statistical Software 8, 2003).
static uint64_t random_state = 88172645463325252u;

static size_t random_below(size_t limit)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return (size_t)(random_state % limit);
}

// What a damaged file may hold.
static const char *const pieces[] = {
    "{",
    "}",
    "[",
    "]",
    ":",
    "- ",
    "\n",
    "\n  ",
    "#",
    "\"",
    "'",
    "|\n",
    ">\n",
    "&a ",
    "*a",
    "!!str ",
    "---\n",
    "...\n",
    "\t",
    "\xff",
    "\xc3",
    "\xef\xbb\xbf",
    "\xe2\x80\xa8",
    "%YAML 1.1\n",
    "? ",
    "null",
    "~",
    "nan",
    "-1",
    "1e999",
    ".inf",
    "0x1p9",
    "\"\\0\"",
    "\"\\e\"",
    "arm:",
    "k2: ",
    "script:\n  - at: 0.1\n    push: 1\n",
    "set: {motor.voltage: 2 V}",
    "expect:\n  impacts: {value: 3, tolerance: 0}\n",
    "at: 1e9",
    "links: 3",
    "model: printed",
    "tolerance: -1",
    "first_contact_s: null\n",
    "duration: 1e5",
    "<<: ",
};

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
    const char *piece = pieces[random_below(sizeof pieces / sizeof pieces[0])];
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
        char part[24];
        memcpy(part, text + at, length);
        return insert(text, size, at, part, length);
    }
    case 3: // the end is missing, now and then
        return random_below(8) == 0 ? at : size;
    default:
        return insert(text, size, at, piece, strlen(piece));
    }
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

static void run_file(const char *path, char *text)
{
    size_t size = read_bytes(path, text);
    LLVMFuzzerTestOneInput((const uint8_t *)text, size);
}

static void ignore(void *context, const char *sentence)
{
    (void)context;
    fprintf(stderr, "%s\n", sentence);
}

// Mutates one shipped scenario again and again, with one to eight damages each.
static void mutate_scenario(const char *name, char *original, char *text)
{
    scenario s;
    if (scenario_open(&s, name, ignore, NULL) != STATUS_OK) {
        exit(1);
    }
    size_t original_size = read_bytes(s.file, original);
    scenario_finish(&s);
    for (int round = 0; round < ROUNDS; round++) {
        size_t size = original_size;
        memcpy(text, original, size);
        for (size_t damages = 1 + random_below(8); damages > 0; damages--) {
            size = mutate(text, size);
        }
        LLVMFuzzerTestOneInput((const uint8_t *)text, size);
    }
}

int main(int argc, char **argv)
{
    char *text = malloc(MOST_BYTES), *original = malloc(MOST_BYTES);
    char **names = NULL;
    int count = 0;
    fault f;
    if (text == NULL || original == NULL) {
        return 1;
    }
    for (int i = 1; i < argc; i++) {
        run_file(argv[i], text);
    }
    if (argc < 2 && (scenario_list(&names, &count, &f) != STATUS_OK || count == 0)) {
        fprintf(stderr, "no scenarios to mutate\n");
        return 1;
    }
    for (int i = 0; i < count; i++) {
        mutate_scenario(names[i], original, text);
        free(names[i]);
    }
    free(names);
    free(original);
    free(text);
    printf("%d texts read\n", argc > 1 ? argc - 1 : count * ROUNDS);
    return 0;
}

#endif

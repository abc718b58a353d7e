// The cases of a test program, which TEST adds before main, in the order in which they
// are written.
#include "tests/check.h"

#include <ftw.h>

enum { MOST_CASES = 128 };
static struct CMUnitTest cases[MOST_CASES];
static int lines[MOST_CASES], count;

// fontconfig keeps a little memory until the end, whatever its user does
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig\n";
}

// no memory is requested: some programs count or refuse every request
void add_case(struct CMUnitTest added, int line)
{
    int i = count++;
    if (count > MOST_CASES) {
        abort();
    }
    for (; i > 0 && lines[i - 1] > line; i--) {
        cases[i] = cases[i - 1];
        lines[i] = lines[i - 1];
    }
    cases[i] = added;
    lines[i] = line;
}

int run_cases(CMFixtureFunction set_up, CMFixtureFunction tear_down)
{
    return _cmocka_run_group_tests(program_invocation_short_name, cases, (size_t)count,
                                   set_up, tear_down) != 0;
}

char *formatted(const char *format, ...)
{
    enum { KEPT = 64, LONGEST = 8192 };
    static char texts[KEPT][LONGEST];
    static int next;
    char *text = texts[next++ % KEPT];
    va_list values;
    va_start(values, format);
    assert_in_range(vsnprintf(text, LONGEST, format, values), 0, LONGEST - 1);
    va_end(values);
    return text;
}

const char *const *words_of(const char *text)
{
    enum { KEPT = 64, MOST = 40 };
    static const char *lists[KEPT][MOST];
    static int next;
    const char **list = lists[next++ % KEPT];
    char *copy = formatted("%s", text), *rest = NULL;
    int words = 0;
    for (char *one = strtok_r(copy, " ", &rest); one != NULL;
         one = strtok_r(NULL, " ", &rest)) {
        assert_in_range(words, 0, MOST - 2);
        list[words++] = one;
    }
    list[words] = NULL;
    return list;
}

char test_folder[32];

int enter_folder(void **state)
{
    (void)state;
    strcpy(test_folder, "/tmp/impactlab-test-XXXXXX");
    return mkdtemp(test_folder) == NULL || chdir(test_folder) != 0;
}

// Removes a file or an empty folder; a temporary of the program's has no business there.
static int remove_entry(const char *path, const struct stat *about, int kind,
                        struct FTW *place)
{
    (void)about;
    (void)kind;
    const char *journal = strstr(path, "-journal");
    const bool left = strncmp(path + place->base, ".impactlab-", 11) == 0 ||
                      (journal != NULL && journal[8] == '\0');
    if (left) {
        print_error("%s was left behind\n", path);
    }
    return remove(path) != 0 || left;
}

int leave_folder(void **state)
{
    (void)state;
    return chdir("/") != 0 ||
           nftw(test_folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS) != 0;
}

void put_bytes(const char *path, const void *bytes, size_t length)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
}

void put_file(const char *path, const char *text)
{
    put_bytes(path, text, strlen(text));
}

char *file_bytes(const char *path, size_t *length)
{
    char *bytes = NULL;
    FILE *file = fopen(path, "r"), *into = open_memstream(&bytes, length);
    fail_if(file == NULL, "%s: %s", path, strerror(errno));
    for (int c; (c = getc(file)) != EOF;) {
        putc(c, into);
    }
    fclose(into);
    fclose(file);
    return bytes;
}

char *file_text(const char *path)
{
    size_t length;
    return file_bytes(path, &length);
}

bool file_has(const char *path, const char *part)
{
    size_t length;
    KEPT_TEXT(bytes) = file_bytes(path, &length);
    return memmem(bytes, length, part, strlen(part)) != NULL;
}

void free_names(char **names, int how_many)
{
    for (int i = 0; i < how_many; i++) {
        free(names[i]);
    }
    free(names);
}

__attribute__((weak)) int main(void)
{
    return run_cases(NULL, NULL);
}

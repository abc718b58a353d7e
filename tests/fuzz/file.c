#include "tests/fuzz/fuzz.h"

#include <fcntl.h>
#include <ftw.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/impactlab-fuzz-XXXXXX";

// Removes what is in the folder, and in the end the folder.
static int drop(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    (void)about;
    (void)kind;
    return where->level > 0 ? remove(path) : 0;
}

static void drop_folder(void)
{
    nftw(folder, drop, 16, FTW_DEPTH | FTW_PHYS);
    rmdir(folder);
}

void fuzz_folder(void)
{
    // a name that is made may end with an X, too
    if (strstr(folder, "XXXXXX") != NULL) {
        FUZZ_CHECK(mkdtemp(folder) != NULL && chdir(folder) == 0);
        atexit(drop_folder);
    }
    nftw(folder, drop, 16, FTW_DEPTH | FTW_PHYS);
}

const char *fuzz_file(const uint8_t *data, size_t size)
{
    static char path[64];
    if (path[0] == '\0') {
        snprintf(path, sizeof path, "/tmp/impactlab-fuzz-%ld", (long)getpid());
    }

    // a new file each time: some file systems wait for the disk when an old one is
    // emptied
    unlink(path);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    FUZZ_CHECK(file >= 0);
    FUZZ_CHECK(write(file, data, size) == (ssize_t)size);
    close(file);
    return path;
}

static void fail(void *context, const char *sentence)
{
    (void)context;
    fuzz_fail(__FILE__, __LINE__, sentence);
}

void fuzz_scenario(scenario *s, const char *yaml)
{
    FUZZ_CHECK(scenario_parse(s, yaml, strlen(yaml), "f", "base", fail, NULL) ==
               STATUS_OK);
}

char *fuzz_written(const scenario *s)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    FUZZ_CHECK(stream != NULL);
    scenario_write(stream, s);
    FUZZ_CHECK(fclose(stream) == 0);
    return text;
}

void fuzz_count(void *count, const char *sentence)
{
    FUZZ_CHECK(sentence[0] != '\0');
    ++*(int *)count;
}

void fuzz_count_placed(void *count, const char *sentence, const char *file)
{
    const size_t name = strlen(file);
    int line = 0, column = 0, length = 0;
    FUZZ_CHECK(strncmp(sentence, file, name) == 0);
    sscanf(sentence + name, ":%d:%d: %n", &line, &column, &length);
    FUZZ_CHECK(line >= 1 && column >= 1 && length > 0 &&
               sentence[name + (size_t)length] != '\0');
    for (const char *c = sentence; *c != '\0'; c++) {
        FUZZ_CHECK((unsigned char)*c >= 0x20 && *c != 0x7f);
    }
    fuzz_count(count, sentence);
}

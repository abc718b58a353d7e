#include "tests/fuzz/fuzz.h"

#include <fcntl.h>
#include <unistd.h>

const char *fuzz_file(const uint8_t *data, size_t size)
{
    static char path[64];
    if (path[0] == '\0') {
        snprintf(path, sizeof path, "/tmp/impactlab-fuzz-%ld", (long)getpid());
    }

    // a new file each time: some file systems wait for the disk when an old one is emptied
    unlink(path);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    FUZZ_CHECK(file >= 0);
    FUZZ_CHECK(write(file, data, size) == (ssize_t)size);
    close(file);
    return path;
}

#include "src/base/input_file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/base/result_places.h"

status input_file_check_kept(const char *path, fault *why)
{
    struct stat about;
    if (stat(path, &about) != 0 || !S_ISREG(about.st_mode)) {
        return STATUS_OK;
    }
    const char *result = result_places_find(path);
    FAULT_IF(result != NULL, why, STATUS_BAD_ARGUMENT,
             "is read, and a result would be written over it to '%.300s', expected "
             "another file",
             result);
    return STATUS_OK;
}

status input_file_check_plain(const char *path, fault *why)
{
    struct stat about;
    FAULT_IF(stat(path, &about) == 0 && !S_ISREG(about.st_mode) &&
                 !S_ISDIR(about.st_mode),
             why, STATUS_BAD_ARGUMENT, "is a device or a pipe, expected a plain file");
    return STATUS_OK;
}

FILE *input_file_open(const char *path, fault *why)
{
    if (input_file_check_kept(path, why) != STATUS_OK ||
        input_file_check_plain(path, why) != STATUS_OK) {
        return NULL;
    }

    // opening what became a pipe meanwhile would wait for its other end
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) {
        fault_set(why, STATUS_CANNOT_READ, "cannot be opened (%s)", strerror(errno));
        return NULL;
    }

    struct stat about;
    if (fstat(file, &about) != 0 || S_ISDIR(about.st_mode)) {
        fault_set(why, STATUS_CANNOT_READ, "cannot be read (%s)", strerror(EISDIR));
        close(file);
        return NULL;
    }

    FILE *stream = fdopen(file, "r");
    if (stream == NULL) {
        fault_no_memory(why);
        close(file);
    }
    return stream;
}

status input_file_fault(const char *path, const fault *why, fault *f)
{
    return fault_set(f, why->code, "'%.300s' %.600s", path, why->text);
}

// The bytes of a stream, or its first `most`, on the heap with a 0 behind them. NULL and
// a reason in errno if they cannot be read.
static char *read_bytes(FILE *file, size_t most, size_t *length)
{
    enum { FIRST_ROOM = 65536 };
    char *bytes = NULL;
    size_t room = FIRST_ROOM / 2;
    *length = 0;

    // room doubles until the file ends in it
    do {
        room = 2 * room < most ? 2 * room : most;
        char *larger = realloc(bytes, room + 1);
        if (larger == NULL) {
            free(bytes);
            return NULL;
        }
        bytes = larger;
        *length += fread(bytes + *length, 1, room - *length, file);
    } while (*length == room && room < most);

    if (ferror(file)) {
        free(bytes);
        return NULL;
    }
    bytes[*length] = '\0';
    return bytes;
}

// The whole file, or as much of it as is wanted.
char *input_file_read(const char *path, size_t most, size_t *length, fault *why)
{
    assert(most > 0);
    FILE *file = input_file_open(path, why);
    if (file == NULL) {
        return NULL;
    }

    char *bytes = read_bytes(file, most, length);
    if (bytes == NULL) {
        const status code = errno == ENOMEM ? STATUS_NO_MEMORY : STATUS_CANNOT_READ;
        fault_set(why, code, "cannot be read (%s)", strerror(errno));
    }
    fclose(file);
    return bytes;
}

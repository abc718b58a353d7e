#include "src/scenario/outside.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/base/result_places.h"

#define PATH(field) offsetof(parameters, field)

const outside_source outside_table[] = {
    {PATH(control.plugin), PATH(control.law), LAW_PLUGIN, OUTSIDE_LIBRARY},
    {PATH(control.command), PATH(control.law), LAW_PROCESS, OUTSIDE_COMMAND},
    {PATH(control.playback_file), PATH(control.law), LAW_PLAYBACK, OUTSIDE_FILE},
    {PATH(wall.motion_file), PATH(wall.motion), MOTION_FILE, OUTSIDE_FILE},
};
const int outside_count = sizeof outside_table / sizeof outside_table[0];

// What is taken in of each file: its bytes, or only when and where they were written. Of
// a small one the bytes in any case: two writes may come at one tick of the clock of
// files.
enum { SMALL = 256 << 10 };
typedef enum reading {
    CONTENT,
    STAMP,
    KEPT
} reading; // KEPT: nothing, no result may go there

bool outside_is_read(const outside_source *source, const parameters *p)
{
    return parameter_get(p, parameter_at(source->chooser)) == source->choice;
}

unsigned outside_read(const parameters *p)
{
    unsigned sources = 0;
    for (int i = 0; i < outside_count; i++) {
        sources |= (unsigned)outside_is_read(&outside_table[i], p) << i;
    }
    return sources;
}

unsigned outside_files(void)
{
    unsigned sources = 0;
    for (int i = 0; i < outside_count; i++) {
        sources |= (unsigned)(outside_table[i].kind == OUTSIDE_FILE) << i;
    }
    return sources;
}

// Takes in the digest of a plain file's content. False, with the reason in errno, if it
// cannot be read.
static bool add_content(sha256 *h, const char *path)
{
    char bytes[16384], digest[SHA256_TEXT];
    sha256 content;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return false;
    }
    sha256_init(&content);
    for (size_t count; (count = fread(bytes, 1, sizeof bytes, file)) > 0;) {
        sha256_add(&content, bytes, count);
    }
    const bool whole = ferror(file) == 0;
    const int reason = errno;
    fclose(file);
    errno = reason;
    sha256_finish(&content, digest);
    sha256_add_text(h, digest);
    return whole;
}

// Takes in a plain file. False, with the reason in errno, if it cannot be read: ENOENT
// also where something else stands in its place.
static bool add_file(sha256 *h, const char *path, reading how)
{
    struct stat what;
    if (stat(path, &what) != 0) {
        return false;
    }
    if (!S_ISREG(what.st_mode)) {
        errno = ENOENT;
        return false;
    }
    if (how == KEPT) {
        errno = EBUSY;
        return result_places_find(path) == NULL;
    }
    if (how == CONTENT || what.st_size <= SMALL) {
        return add_content(h, path);
    }

    // the time of a file's last change cannot be set back
    const long long stamp[] = {(long long)what.st_dev, (long long)what.st_ino,
                               what.st_size, what.st_ctim.tv_sec, what.st_ctim.tv_nsec};
    sha256_add(h, stamp, sizeof stamp);
    return true;
}

// Whether a name that could not be read may mean something else than a file.
static bool is_no_file(void)
{
    return errno == ENOENT || errno == ENOTDIR;
}

// Takes in the program that a word without a slash starts. True, too, where there is
// none.
static bool add_program(sha256 *h, const char *word, reading how)
{
    const char *folders = getenv("PATH");
    char path[4096];
    while (folders != NULL && *folders != '\0') {
        const int length = (int)strcspn(folders, ":");
        snprintf(path, sizeof path, "%.*s%s%s", length, folders, length > 0 ? "/" : "",
                 word);
        const bool found = access(path, X_OK) == 0,
                   taken = found && add_file(h, path, how);
        if (taken || (found && !is_no_file())) {
            return taken;
        }
        folders += length + (folders[length] == ':');
    }
    return true;
}

// Takes in the command and every file that one of its words names: "law.sh",
// "--table=law.csv", and a program that PATH finds.
static bool add_command(sha256 *h, const char *command, reading how)
{
    char word[PARAMETER_TEXT_SIZE];
    sha256_add_text(h, command);
    for (const char *at = command; *(at += strspn(at, " ")) != '\0'; at += strlen(word)) {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " "), at);
        const char *value = strchr(word, '='),
                   *names[] = {word, value != NULL ? value + 1 : ""};
        for (int i = 0; i < 2; i++) {
            const bool taken = add_file(h, names[i], how);
            if (!taken && !is_no_file()) {
                return false;
            }
            sha256_add_text(h, taken ? "a file" : "no file");
        }

        // options may be anything but programs
        if (strpbrk(word, "/=") == NULL && word[0] != '-' && !add_program(h, word, how)) {
            return false;
        }
    }
    return true;
}

static bool add_source(sha256 *h, const outside_source *source, const char *value,
                       reading how)
{
    sha256_add_text(h, parameter_table[parameter_at(source->parameter)].path);
    if (source->kind == OUTSIDE_COMMAND) {
        return add_command(h, value, how);
    }
    return add_file(h, value, how);
}

bool outside_is_told(const outside_source *source, const parameters *p)
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 ./_+-:,@=%";
    char value[PARAMETER_TEXT_SIZE];
    parameter_format(p, parameter_at(source->parameter), value, sizeof value);
    if (source->kind == OUTSIDE_COMMAND) {
        return value[strspn(value, plain)] == '\0';
    }
    if (source->kind == OUTSIDE_LIBRARY) {
        return strchr(value, '/') != NULL;
    }
    return true;
}

status outside_digest(const outside_source *source, const parameters *p,
                      char digest[SHA256_TEXT], fault *f)
{
    assert(outside_is_told(source, p));
    const int parameter = parameter_at(source->parameter);
    const char *path = parameter_table[parameter].path;
    char value[PARAMETER_TEXT_SIZE];
    sha256 h;
    parameter_format(p, parameter, value, sizeof value);

    sha256_init(&h);
    const bool whole = add_source(&h, source, value, CONTENT);
    const int reason = errno;
    sha256_finish(&h, digest);
    if (!whole) {
        return fault_set_at(f, STATUS_CANNOT_READ, path, "%s = '%s' cannot be read: %s",
                            path, value, strerror(reason));
    }
    return STATUS_OK;
}

status outside_keep(const parameters *p, fault *f)
{
    for (const outside_source *o = outside_table; o < outside_table + outside_count;
         o++) {
        const int parameter = parameter_at(o->parameter);
        char value[PARAMETER_TEXT_SIZE];
        sha256 unused;
        sha256_init(&unused);
        parameter_format(p, parameter, value, sizeof value);
        const char *path = parameter_table[parameter].path;
        const char *result = result_places_find(value);
        if (!add_source(&unused, o, value, KEPT) && errno == EBUSY) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, path,
                                "%s = '%s' names a file that %s would be written over, "
                                "expected another place",
                                path, value, result != NULL ? result : "a result");
        }
    }
    return STATUS_OK;
}

void outside_digest_all(const parameters *p, char digest[SHA256_TEXT])
{
    sha256 whole;
    sha256_init(&whole);
    bool reads = false;
    for (int i = 0; i < outside_count; i++) {
        const outside_source *source = &outside_table[i];
        char one[SHA256_TEXT];
        if (outside_is_read(source, p) && outside_is_told(source, p) &&
            outside_digest(source, p, one, NULL) == STATUS_OK) {
            sha256_add_text(&whole, one);
            reads = true;
        }
    }
    sha256_finish(&whole, digest);
    if (!reads) {
        digest[0] = '\0';
    }
}

void outside_stamp(unsigned sources, const parameters *p, char stamp[SHA256_TEXT])
{
    sha256 h;
    sha256_init(&h);
    for (int i = 0; i < outside_count; i++) {
        if ((sources >> i & 1) != 0 && outside_is_told(&outside_table[i], p)) {
            char value[PARAMETER_TEXT_SIZE];
            parameter_format(p, parameter_at(outside_table[i].parameter), value,
                             sizeof value);
            add_source(&h, &outside_table[i], value, STAMP);
        }
    }
    sha256_finish(&h, stamp);
}

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

// What of a file goes into a digest.
typedef enum reading {
    CONTENT, // its bytes
    STAMP,   // when and where it was written; a file up to SMALL_FILE gives its bytes, as
             // two writes may come at one tick of the file system's clock
    KEPT     // nothing: it is only checked that no result will be written over it
} reading;

enum { SMALL_FILE = 256 << 10 }; // [bytes]

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

bool outside_file_digest(const char *path, char digest[SHA256_TEXT])
{
    char bytes[16384];
    sha256 content;
    digest[0] = '\0';
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return false;
    }

    // the content, and the reason where reading it fails
    sha256_init(&content);
    for (size_t count; (count = fread(bytes, 1, sizeof bytes, file)) > 0;) {
        sha256_add(&content, bytes, count);
    }
    const bool whole = ferror(file) == 0;
    const int reason = errno;
    fclose(file);
    errno = reason;
    sha256_finish(&content, digest);
    return whole;
}

// Adds the digest of a plain file's content to `h`. False, with the reason in errno, if
// the file cannot be read.
static bool add_content(sha256 *h, const char *path)
{
    char digest[SHA256_TEXT];
    const bool whole = outside_file_digest(path, digest);
    if (digest[0] != '\0') {
        sha256_add_text(h, digest);
    }
    return whole;
}

// Adds a plain file to `h`, or checks it only (KEPT). False, with the reason in errno:
// ENOENT if there is no plain file of that name, EBUSY if a result would be written over
// it, else why it cannot be read.
static bool add_file(sha256 *h, const char *path, reading how)
{
    // a plain file
    struct stat what;
    if (stat(path, &what) != 0) {
        return false;
    }
    if (!S_ISREG(what.st_mode)) {
        errno = ENOENT;
        return false;
    }

    // what of it is asked for
    if (how == KEPT) {
        errno = EBUSY;
        return result_places_find(path) == NULL;
    }
    if (how == CONTENT || what.st_size <= SMALL_FILE) {
        return add_content(h, path);
    }

    // which file it is, and when it was last changed, a time that no program can set back
    const long long stamp[] = {(long long)what.st_dev, (long long)what.st_ino,
                               what.st_size, what.st_ctim.tv_sec, what.st_ctim.tv_nsec};
    sha256_add(h, stamp, sizeof stamp);
    return true;
}

// Whether errno says that there is no file of a name, so that the name may mean something
// else.
static bool is_no_file(void)
{
    return errno == ENOENT || errno == ENOTDIR;
}

// Adds to `h` the program that a word without a slash starts: the first one that the
// folders of PATH have. True also if there is none.
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

// Adds to `h` a command and every file that one of its words names, as "law.sh" and
// "--table=law.csv" do, and programs that PATH finds.
static bool add_command(sha256 *h, const char *command, reading how)
{
    char word[PARAMETER_TEXT_SIZE];
    sha256_add_text(h, command);
    for (const char *at = command; *(at += strspn(at, " ")) != '\0'; at += strlen(word)) {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " "), at);

        // the word itself, and what follows an equals sign
        const char *value = strchr(word, '=');
        const char *names[] = {word, value != NULL ? value + 1 : ""};
        for (int i = 0; i < 2; i++) {
            const bool taken = add_file(h, names[i], how);
            if (!taken && !is_no_file()) {
                return false;
            }
            sha256_add_text(h, taken ? "a file" : "no file");
        }

        // any word but an option or an assignment may be a program
        if (strpbrk(word, "/=") == NULL && word[0] != '-' && !add_program(h, word, how)) {
            return false;
        }
    }
    return true;
}

// Adds to `h` the path of a parameter and what its value names, a file or a command.
// False, with the reason in errno, if that cannot be read.
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
    // a command must have no character that is special to a shell, and a library a slash:
    // the system would search for another one
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

    // errno has the reason until the digest is finished
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

#include "ui/explorer/state/consent.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/base/sha256.h"
#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "ui/explorer/state/settings_folder.h"

bool consent_needed(const scenario *s)
{
    assert(s != NULL);
    const parameters *p = &s->parameters;
    return (p->control.law == LAW_PROCESS || p->control.law == LAW_PLUGIN) && !p->code_allowed;
}

// --- the digest -------------------------------------------------------------------------------

// Takes in a text with its end, so that two texts are not taken for two others.
static void add_text(sha256 *h, const char *text)
{
    sha256_add(h, text, strlen(text) + 1);
}

// Takes in a file's content if it is a plain file. False if it cannot be read.
static bool add_file(sha256 *h, const char *path)
{
    char bytes[16384];
    struct stat what;
    FILE *file = stat(path, &what) == 0 && S_ISREG(what.st_mode) ? fopen(path, "rb") : NULL;
    if (file == NULL) {
        return false;
    }
    for (size_t count; (count = fread(bytes, 1, sizeof bytes, file)) > 0;) {
        sha256_add(h, bytes, count);
    }
    const bool whole = ferror(file) == 0;
    fclose(file);
    return whole;
}

// The scenario as text.
static bool add_scenario(sha256 *h, const scenario *s)
{
    text_stream written;
    if (!text_stream_open(&written)) {
        return false;
    }
    scenario_write(written.stream, s);

    // one that is not whole is another one
    size_t size;
    char *text = text_stream_close(&written, &size);
    if (text != NULL) {
        sha256_add(h, text, size);
    }
    free(text);
    return text != NULL;
}

// The command, the folder it starts in, and the content of every file that one of its words names.
// False where a shell would take it for more than words.
static bool add_command(sha256 *h, const char *command)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                " ./_+-:,@=%";
    char folder[4096], word[PARAMETER_TEXT_SIZE];
    if (command[strspn(command, plain)] != '\0' || getcwd(folder, sizeof folder) == NULL) {
        return false;
    }
    add_text(h, command);
    add_text(h, folder);

    // a word that names no file of this folder is an option, or a program that PATH finds
    for (const char *at = command; *(at += strspn(at, " ")) != '\0'; at += strlen(word)) {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " "), at);
        add_text(h, add_file(h, word) ? "a file" : "no file");
    }
    return true;
}

// The digest of a scenario and its program or plug-in. False where their content does not tell.
static bool digest_of(const scenario *s, char digest[SHA256_TEXT])
{
    const control_parameters *c = &s->parameters.control;
    sha256 h;
    sha256_init(&h);

    // the kinds, so that a program never passes for a plug-in
    bool told = add_scenario(&h, s);
    if (c->law == LAW_PROCESS) {
        add_text(&h, "process");
        told = told && add_command(&h, c->command);
    } else if (c->law != LAW_PLUGIN) {
        told = false; // the scenario names neither
    } else {
        add_text(&h, "plugin");
        told = told && strchr(c->plugin, '/') != NULL && add_file(&h, c->plugin);
    }
    sha256_finish(&h, digest);
    return told;
}

// --- the file ---------------------------------------------------------------------------------

static bool allowed_path(char *path, size_t size, bool make)
{
    const char name[] = "/allowed";
    if (!settings_folder(path, size - sizeof name, make)) {
        return false;
    }
    memcpy(path + strlen(path), name, sizeof name);
    return true;
}

// Whether a line of the file begins with the digest; copies the lines to `copy` (may be NULL).
static bool look_through(const char *path, const char *digest, FILE *copy)
{
    char *line = NULL;
    size_t room = 0;
    bool found = false;
    FILE *stream = fopen(path, "r");
    while (stream != NULL && getline(&line, &room, stream) >= 0) {
        found =
            found || (strncmp(line, digest, SHA256_TEXT - 1) == 0 && line[SHA256_TEXT - 1] == ' ');
        if (copy != NULL) {
            fputs(line, copy);
        }
    }
    free(line);
    if (stream != NULL) {
        fclose(stream);
    }
    return found;
}

bool consent_remembered(const scenario *s)
{
    assert(s != NULL);
    char path[1024], digest[SHA256_TEXT];

    // the program is read only if the user has allowed any
    return allowed_path(path, sizeof path, false) && access(path, R_OK) == 0 &&
           digest_of(s, digest) && look_through(path, digest, NULL);
}

status consent_remember(const scenario *s, bool *kept, fault *f)
{
    assert(s != NULL && kept != NULL);
    char path[1024], digest[SHA256_TEXT], what[2 * PARAMETER_TEXT_SIZE];
    *kept = false;
    if (!digest_of(s, digest) || !allowed_path(path, sizeof path, true)) {
        return STATUS_OK;
    }

    // whole or not at all
    whole_file file;
    status code = whole_file_open(&file, path, f);
    if (code != STATUS_OK) {
        return code;
    }
    if (!look_through(path, digest, file.stream)) {
        const control_parameters *c = &s->parameters.control;
        snprintf(what, sizeof what, "%s: %s", s->name,
                 c->law == LAW_PROCESS ? c->command : c->plugin);
        make_printable(what);
        fprintf(file.stream, "%s %s\n", digest, what);
    }
    code = whole_file_commit(&file, f);
    *kept = code == STATUS_OK;
    return code;
}

#include "ui/explorer/state/user_files.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/base/sha256.h"
#include "src/base/text_stream.h"
#include "src/base/words.h"
#include "src/scenario/outside.h"
#include "ui/explorer/state/command_list.h"

// Makes each folder on the way to a file, for its user alone.
static bool make_folders(char *path)
{
    bool there = true;
    for (char *end = strchr(path + 1, '/'); end != NULL; end = strchr(end + 1, '/')) {
        *end = '\0';
        there = mkdir(path, 0700) == 0 || errno == EEXIST;
        *end = '/';
    }
    return there;
}

bool user_file(user_folder folder, const char *name, char *path, size_t size, bool make)
{
    assert(size > 0);
    static const struct {
        const char *variable, *usual;
    } folders[] = {{"XDG_CONFIG_HOME", ".config"}, {"XDG_STATE_HOME", ".local/state"}};
    const char *base = getenv(folders[folder].variable), *home = getenv("HOME");

    // where such files belong, or the usual place below the home folder
    if (base != NULL && base[0] == '/') {
        snprintf(path, size, "%s", base);
    } else if (home != NULL && home[0] == '/') {
        snprintf(path, size, "%s/%s", home, folders[folder].usual);
    } else {
        snprintf(path, size, "~/%s/impactlab/%s", folders[folder].usual, name);
        return false;
    }
    text_add(path, size, "/impactlab/%s", name);
    if (strlen(path) + 1 >= size) {
        return false;
    }
    return !make || make_folders(path);
}

// --- consent ---------------------------------------------------------------------------

bool consent_needed(const scenario *s)
{
    const parameters *p = &s->parameters;
    return (p->control.law == LAW_PROCESS || p->control.law == LAW_PLUGIN) &&
           !p->code_allowed;
}

// Adds the scenario as text. False without memory.
static bool add_scenario(sha256 *h, const scenario *s)
{
    text_stream written;
    size_t size = 0;
    if (!text_stream_open(&written)) {
        return false;
    }
    scenario_write(written.stream, s);
    char *text = text_stream_close(&written, &size);
    if (text == NULL) {
        return false;
    }
    sha256_add(h, text, size);
    free(text);
    return true;
}

// The digest of a scenario, of what it reads from outside, and of the folder in which a
// command starts. False where their content does not tell, or nothing is read.
static bool digest_of(const scenario *s, char digest[SHA256_TEXT])
{
    char folder[4096], content[SHA256_TEXT];
    sha256 h;
    sha256_init(&h);
    bool reads = false;
    if (!add_scenario(&h, s) || getcwd(folder, sizeof folder) == NULL) {
        return false;
    }
    for (int i = 0; i < outside_count; i++) {
        const outside_source *source = &outside_table[i];
        if (!outside_is_read(source, &s->parameters)) {
            continue;
        }
        if (!outside_is_told(source, &s->parameters) ||
            outside_digest(source, &s->parameters, content, NULL) != STATUS_OK) {
            return false;
        }
        sha256_add_text(&h, content);
        if (source->kind == OUTSIDE_COMMAND) {
            sha256_add_text(&h, folder);
        } else {
            sha256_add_text(&h, "");
        }
        reads = true;
    }
    sha256_finish(&h, digest);
    return reads;
}

// Whether a line of the file begins with the digest.
static bool has_digest(const char *path, const char *digest)
{
    char *line = NULL;
    size_t room = 0;
    bool found = false;
    FILE *file = fopen(path, "r");
    while (file != NULL && !found && getline(&line, &room, file) >= 0) {
        found = strncmp(line, digest, SHA256_TEXT - 1) == 0;
    }
    free(line);
    if (file != NULL) {
        fclose(file);
    }
    return found;
}

bool consent_remembered(const scenario *s)
{
    char path[1024], digest[SHA256_TEXT];

    // the program is read only if the user has allowed any
    return user_file(USER_SETTINGS, "allowed", path, sizeof path, false) &&
           access(path, R_OK) == 0 && digest_of(s, digest) && has_digest(path, digest);
}

status consent_remember(const scenario *s, bool *kept, fault *f)
{
    char path[1024], digest[SHA256_TEXT];
    *kept = digest_of(s, digest) &&
            user_file(USER_SETTINGS, "allowed", path, sizeof path, true);
    if (!*kept || has_digest(path, digest)) {
        return STATUS_OK;
    }

    // the names, for people who read the file
    const control_parameters *c = &s->parameters.control;
    const char *code = c->law == LAW_PROCESS ? c->command : c->plugin;
    char names[2 * PARAMETER_TEXT_SIZE];
    snprintf(names, sizeof names, "%s: %s", s->name, code);
    make_printable(names, 0);

    // a line of its own at the end
    FILE *file = fopen(path, "a");
    if (file != NULL) {
        fprintf(file, "%s %s\n", digest, names);
    }
    *kept = file != NULL && fclose(file) == 0;
    FAULT_IF(!*kept, f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path,
             strerror(errno));
    return STATUS_OK;
}

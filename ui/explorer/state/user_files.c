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
#include "src/base/whole_file.h"
#include "src/base/words.h"
#include "src/scenario/outside.h"
#include "ui/explorer/state/command_list.h"

bool user_file(user_folder folder, const char *name, char *path, size_t size, bool make)
{
    static const struct {
        const char *variable, *usual;
    } folders[] = {{"XDG_CONFIG_HOME", ".config"}, {"XDG_STATE_HOME", ".local/state"}};
    assert(size > 0);
    const char *base = getenv(folders[folder].variable), *home = getenv("HOME");

    // where such files belong, or the usual place below the home folder
    const bool given = base != NULL && base[0] == '/';
    const bool usual = home != NULL && home[0] == '/';
    if (given) {
        snprintf(path, size, "%s", base);
    } else {
        snprintf(path, size, "%s/%s", usual ? home : "~", folders[folder].usual);
    }
    text_add(path, size, "/impactlab/%s", name);
    if ((!given && !usual) || strlen(path) + 1 >= size) {
        return false;
    }

    // each folder on the way
    bool there = true;
    for (char *end = path; make && (end = strchr(end + 1, '/')) != NULL; *end = '/') {
        *end = '\0';
        there = mkdir(path, 0700) == 0 || errno == EEXIST;
    }
    return there;
}

// --- consent ---------------------------------------------------------------------------

bool consent_needed(const scenario *s)
{
    const parameters *p = &s->parameters;
    return (p->control.law == LAW_PROCESS || p->control.law == LAW_PLUGIN) &&
           !p->code_allowed;
}

// --- the digest ------------------------------------------------------------------------

// The scenario as text.
static bool add_scenario(sha256 *h, const scenario *s)
{
    text_stream written;
    size_t size = 0;
    char *text = NULL;
    if (text_stream_open(&written)) {
        scenario_write(written.stream, s);
        text = text_stream_close(&written, &size);
    }

    // one that is not whole is another one
    if (text != NULL) {
        sha256_add(h, text, size);
    }
    free(text);
    return text != NULL;
}

// The digest of a scenario, of what it reads from outside, and of the folder in which a
// command starts. False where their content does not tell.
static bool digest_of(const scenario *s, char digest[SHA256_TEXT])
{
    char folder[4096], content[SHA256_TEXT];
    sha256 h;
    sha256_init(&h);

    // the scenario may read nothing that needs a consent
    int named = 0;
    bool told = add_scenario(&h, s);
    for (int i = 0; i < outside_count && told; i++) {
        const outside_source *source = &outside_table[i];
        if (outside_is_read(source, &s->parameters)) {
            told = outside_is_told(source, &s->parameters) &&
                   outside_digest(source, &s->parameters, content, NULL) == STATUS_OK &&
                   getcwd(folder, sizeof folder) != NULL;
            sha256_add_text(&h, told ? content : "");
            sha256_add_text(&h, told && source->kind == OUTSIDE_COMMAND ? folder : "");
            named++;
        }
    }
    sha256_finish(&h, digest);
    return told && named > 0;
}

// --- the file --------------------------------------------------------------------------

// Whether a line of the file begins with the digest; copies the lines to `copy` (may be
// NULL).
static bool look_through(const char *path, const char *digest, FILE *copy)
{
    char *line = NULL;
    size_t room = 0;
    bool found = false;
    FILE *stream = fopen(path, "r");
    while (stream != NULL && getline(&line, &room, stream) >= 0) {
        const bool same = strncmp(line, digest, SHA256_TEXT - 1) == 0;
        found = found || (same && line[SHA256_TEXT - 1] == ' ');
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
    char path[1024], digest[SHA256_TEXT];

    // the program is read only if the user has allowed any
    return user_file(USER_SETTINGS, "allowed", path, sizeof path, false) &&
           access(path, R_OK) == 0 && digest_of(s, digest) &&
           look_through(path, digest, NULL);
}

status consent_remember(const scenario *s, bool *kept, fault *f)
{
    char path[1024], digest[SHA256_TEXT], what[2 * PARAMETER_TEXT_SIZE];
    *kept = false;
    if (!digest_of(s, digest) ||
        !user_file(USER_SETTINGS, "allowed", path, sizeof path, true)) {
        return STATUS_OK;
    }

    // whole or not at all
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    if (!look_through(path, digest, file.stream)) {
        const control_parameters *c = &s->parameters.control;
        snprintf(what, sizeof what, "%s: %s", s->name,
                 c->law == LAW_PROCESS ? c->command : c->plugin);
        make_printable(what, 0);
        fprintf(file.stream, "%s %s\n", digest, what);
    }
    TRY(whole_file_commit(&file, f));
    *kept = true;
    return STATUS_OK;
}

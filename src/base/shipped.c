#include "src/base/shipped.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/base/build_config.h"

static const struct {
    const char *in_prefix, *configured;
} places[] = {
    [SHIPPED_SCENARIOS] = {IMPACTLAB_SCENARIOS_IN_PREFIX, IMPACTLAB_SCENARIOS},
    [SHIPPED_MANUAL] = {IMPACTLAB_MANUAL_IN_PREFIX, IMPACTLAB_MANUAL},
    [SHIPPED_PROGRAM] = {IMPACTLAB_PROGRAM_IN_PREFIX, IMPACTLAB_PROGRAM},
    [SHIPPED_PAGE] = {IMPACTLAB_PAGE_IN_PREFIX, IMPACTLAB_PAGE},
    [SHIPPED_DRAWING] = {IMPACTLAB_DRAWING_IN_PREFIX, IMPACTLAB_DRAWING},
};

// The file that this very code was loaded from: the program, or the shared library in
// another one. path has PATH_MAX bytes; false if nobody knows.
static bool own_file(char *path)
{
    Dl_info about;
    if (dladdr(places, &about) != 0 && about.dli_fname != NULL &&
        strstr(about.dli_fname, ".so") != NULL) {
        return realpath(about.dli_fname, path) != NULL;
    }

    // the program, which the kernel knows
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    if (length <= 0) {
        path[0] = '\0';
        return false;
    }
    path[length] = '\0';
    return true;
}

// FOLDER/NAME, links followed, if it is there, to be freed. True unless there is no
// memory; *path is NULL if there is no such file.
static bool path_in(const char *folder, const char *name, char **path)
{
    char *joined;
    *path = NULL;
    if (asprintf(&joined, "%s/%s", folder, name) < 0) {
        return false;
    }
    *path = realpath(joined, NULL);
    const bool known = *path != NULL || errno != ENOMEM;
    free(joined);
    return known;
}

// Beside this program, under the prefix or in a build folder, or where it was configured.
char *shipped_path(shipped_part part)
{
    // PREFIX/bin/impactlab, PREFIX/lib/x86_64-linux-gnu/libimpactlab.so.1,
    // BUILD/src/api/libimpactlab.so.1
    char *path, *end = NULL;
    char own[PATH_MAX];
    if (own_file(own)) {
        end = strrchr(own, '/');
    }
    for (int above = 0; above < 4 && end != NULL && end != own; above++) {
        *end = '\0';
        if (!path_in(own, places[part].in_prefix, &path) || path != NULL) {
            return path;
        }
        end = strrchr(own, '/');
    }
    return strdup(places[part].configured);
}

const char *lab_version(void)
{
    return IMPACTLAB_VERSION;
}

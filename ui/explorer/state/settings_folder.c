#include "ui/explorer/state/settings_folder.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

bool settings_folder(char *path, size_t size, bool make)
{
    assert(path != NULL && size > 0);
    const char *base = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    int length;

    // where settings belong, or the usual place below the home folder
    if (base != NULL && base[0] == '/') {
        length = snprintf(path, size, "%s", base);
    } else if (home != NULL && home[0] == '/') {
        length = snprintf(path, size, "%s/.config", home);
    } else {
        return false;
    }
    if (length < 0 || (size_t)length + 16 > size) {
        return false;
    }

    // the folders above it must exist
    if (make) {
        mkdir(path, 0700);
    }
    snprintf(path + length, size - (size_t)length, "/impactlab");
    return !make || mkdir(path, 0700) == 0 || errno == EEXIST;
}

#include "src/base/result_places.h"

#include <assert.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>

#include "src/base/whole_file.h"

// Paths of results as they were added, for the whole program.
enum { MOST_RESULTS = 16 };
static char results[MOST_RESULTS][PATH_MAX];
static int result_count;

const char *result_places_find(const char *path)
{
    for (int i = 0; i < result_count; i++) {
        if (whole_file_same_place(results[i], path)) {
            return results[i];
        }
    }
    return NULL;
}

bool result_places_add(const char *path)
{
    assert(result_count < MOST_RESULTS);
    if (result_places_find(path) != NULL) {
        return false;
    }
    snprintf(results[result_count++], PATH_MAX, "%s", path);
    return true;
}

void result_places_forget(void)
{
    result_count = 0;
}

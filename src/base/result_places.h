// The places that the results of a command go to, named before anything is read, so that
// no result takes the place of what the command reads.
#pragma once

#include <stdbool.h>

// Names a place. False where another result goes there already. One at a time, and no
// thread reads meanwhile.
bool result_places_add(const char *path);

// The result that goes to the place to which `path` leads, NULL if none does.
const char *result_places_find(const char *path);

void result_places_forget(void);

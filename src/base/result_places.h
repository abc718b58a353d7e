// The places that the results of a command go to, named before anything is read, so that
// no result takes the place of what the command reads.
#pragma once

#include <stdbool.h>

// Adds the place of a result; there are 16 at most. False where another result goes there
// already. Not to be called while another thread calls any of these functions.
bool result_places_add(const char *path);

// The path of the result that goes to the place to which `path` leads, as it was added;
// NULL if none does. The text belongs to this list and lasts until
// result_places_forget().
const char *result_places_find(const char *path);

// Empties the list.
void result_places_forget(void);

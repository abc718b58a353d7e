// The limits at which a run may end, as docs/explanation/trust.md lists them: each row of
// its section "Where a run ends" begins with the words by which the run's message tells
// it. LIMITS is that file.
#pragma once

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_LIMITS = 32 };

typedef struct listed_limits {
    char words[MOST_LIMITS][80];
    int count;
} listed_limits;

// Reads the list; gives up if there is none.
static inline void listed_limits_read(listed_limits *l)
{
    FILE *file = fopen(LIMITS, "r");
    char line[4096];
    bool within = false;
    l->count = 0;
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, "## ", 3) == 0) {
            within = strcmp(line, "## Where a run ends\n") == 0;
        } else if (within && l->count < MOST_LIMITS) {
            l->count += sscanf(line, "| `%79[^`]` |", l->words[l->count]) == 1;
        }
    }
    if (l->count == 0 || l->count == MOST_LIMITS) {
        fprintf(stderr, "%s: %d limits at which a run ends\n", LIMITS, l->count);
        exit(2);
    }
    fclose(file);
}

// The limit that a message tells, as an index of the list; -1: none of it.
static inline int listed_limits_find(const listed_limits *l, const char *message)
{
    for (int i = 0; i < l->count; i++) {
        if (strstr(message, l->words[i]) != NULL) {
            return i;
        }
    }
    return -1;
}

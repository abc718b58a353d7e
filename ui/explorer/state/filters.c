#include "ui/explorer/state/filters.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

bool filter_passes(const char *filter, const char *text)
{
    assert(filter != NULL && text != NULL);
    char word[FILTER_TEXT];
    while (*(filter += strspn(filter, " ")) != '\0') {
        const size_t length = strcspn(filter, " ");
        snprintf(word, sizeof word, "%.*s", (int)length, filter);
        if (strcasestr(text, word) == NULL) {
            return false;
        }
        filter += length;
    }
    return true;
}

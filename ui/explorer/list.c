// The list of scenarios: their titles, and which of them the filter lets through.
#include <stdlib.h>
#include <string.h>

#include "ui/explorer/lab.h"

// A scenario with faults is listed all the same; opening it tells them.
static void ignore_fault(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

void lab_load_titles(lab *l)
{
    if (l->titles != NULL || l->name_count == 0) {
        return;
    }
    l->titles = calloc((size_t)l->name_count, sizeof *l->titles);
    for (int i = 0; l->titles != NULL && i < l->name_count; i++) {
        scenario s;
        if (scenario_open(&s, l->names[i], ignore_fault, NULL) == STATUS_OK) {
            l->titles[i] = s.title != NULL ? strdup(s.title) : NULL;
            scenario_finish(&s);
        }
    }
}

void lab_forget_titles(lab *l)
{
    for (int i = 0; l->titles != NULL && i < l->name_count; i++) {
        free(l->titles[i]);
    }
    free(l->titles);
    l->titles = NULL;
}

const char *lab_title(const lab *l, int index)
{
    return l->titles != NULL && l->titles[index] != NULL ? l->titles[index] : "";
}

bool lab_listed(const lab *l, int index)
{
    return strcasestr(l->names[index], l->filter) != NULL ||
           strcasestr(lab_title(l, index), l->filter) != NULL;
}

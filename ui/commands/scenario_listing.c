#include "ui/commands/scenario_listing.h"

#include <stdio.h>
#include <stdlib.h>

int scenario_listing_open(scenario_listing *l, const arguments *a)
{
    fault f = {0};
    *l = (scenario_listing){0};
    if (scenario_list(&l->names, &l->count, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (a->json != NULL) {
        l->entries = json_array();
    }
    return EXIT_DONE;
}

int scenario_listing_close(scenario_listing *l, const arguments *a, int result)
{
    for (int i = 0; i < l->count; i++) {
        free(l->names[i]);
    }
    free(l->names);

    if (a->json != NULL) {
        result = worse(result, write_json_file(a->json, l->entries));
    }
    return result;
}

// A fault_handler that keeps the last of several faults.
static void keep_last_fault(void *context, const char *sentence)
{
    fault_set(context, STATUS_OK, "%s", sentence);
}

int scenario_heading_read(const char *name, scenario_heading *h)
{
    scenario s;
    fault f = {0};
    const status code = scenario_open(&s, name, keep_last_fault, &f);
    *h = (scenario_heading){.faulty = code != STATUS_OK};

    if (code == STATUS_OK) {
        h->is_lesson = s.lesson.step_count > 0;
        if (s.title != NULL) {
            snprintf(h->title, sizeof h->title, "%s", s.title);
        }
        scenario_finish(&s);
        return EXIT_DONE;
    }

    // faults of the scenario itself are told where it is opened
    if (code == STATUS_BAD_SCENARIO) {
        return EXIT_DONE;
    }
    f.code = code;
    return complain_fault(&f);
}

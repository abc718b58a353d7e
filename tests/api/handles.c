#include "handles.h"

impactlab_error told;
handles *h;

void check_done(int status)
{
    fail_if(status != IMPACTLAB_OK, "status %d: %s", status, told.sentence);
}

int make_handles(void **state)
{
    (void)state;
    h = calloc(1, sizeof *h);
    check_done(impactlab_scenario_open(&h->scenario, "corrected/first-impact", &told));
    check_done(impactlab_scenario_set(h->scenario, "run.duration", "0.3", &told));
    check_done(impactlab_run_create(&h->run, h->scenario, IMPACTLAB_KEEP_ROWS, &told));
    check_done(impactlab_loop_create(&h->loop, h->scenario, IMPACTLAB_COMMAND, &told));
    return 0;
}

int free_handles(void **state)
{
    (void)state;
    impactlab_loop_destroy(h->loop);
    impactlab_run_destroy(h->run);
    impactlab_scenario_destroy(h->scenario);
    free(h);
    return 0;
}

void check_refused(int status, const char *words)
{
    fail_if(status == IMPACTLAB_OK || told.status != status || strstr(told.sentence, words) == NULL,
            "status %d, %d: '%s' has no '%s'", status, told.status, told.sentence, words);
}

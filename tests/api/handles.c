#include "handles.h"

void check_done(int status, const impactlab_error *error)
{
    if (status != IMPACTLAB_OK) {
        fail_msg("status %d: %s", status, error->sentence);
    }
}

int make_handles(void **state)
{
    handles *h = calloc(1, sizeof *h);
    check_done(impactlab_scenario_open(&h->scenario, "corrected/first-impact", &h->error),
               &h->error);
    check_done(impactlab_scenario_set(h->scenario, "run.duration", "0.3", &h->error), &h->error);
    check_done(impactlab_run_create(&h->run, h->scenario, IMPACTLAB_KEEP_ROWS, &h->error),
               &h->error);
    check_done(impactlab_loop_create(&h->loop, h->scenario, IMPACTLAB_COMMAND, &h->error),
               &h->error);
    *state = h;
    return 0;
}

int free_handles(void **state)
{
    SCOPED(free_kept) handles *h = *state;
    impactlab_loop_destroy(h->loop);
    impactlab_run_destroy(h->run);
    impactlab_scenario_destroy(h->scenario);
    return 0;
}

void check_refused(const handles *h, int status, const char *words)
{
    if (status == IMPACTLAB_OK || h->error.status != status ||
        strstr(h->error.sentence, words) == NULL) {
        fail_msg("status %d, %d: '%s' has no '%s'", status, h->error.status, h->error.sentence,
                 words);
    }
}

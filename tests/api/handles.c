#include "handles.h"

impactlab_error told;
handles *h;

void check_done(int status)
{
    fail_if(status != IMPACTLAB_OK, "status %d: %s", status, told.sentence);
}

impactlab_scenario *opened(const char *name)
{
    impactlab_scenario *scenario;
    check_done(impactlab_scenario_open(&scenario, name, &told));
    return scenario;
}

impactlab_run *run_of(const impactlab_scenario *scenario, int flags)
{
    impactlab_run *run;
    check_done(impactlab_run_create(&run, scenario, flags, &told));
    return run;
}

impactlab_loop *loop_of(const impactlab_scenario *scenario, int flags)
{
    impactlab_loop *loop;
    check_done(impactlab_loop_create(&loop, scenario, flags, &told));
    return loop;
}

double number_of(const impactlab_scenario *scenario, const char *path)
{
    double value;
    check_done(impactlab_scenario_number(scenario, path, &value, &told));
    return value;
}

double quantity_of(const impactlab_run *run, const char *key)
{
    double value;
    check_done(impactlab_run_quantity(run, key, &value, &told));
    return value;
}

double signal_of(impactlab_loop *loop, const char *name)
{
    double value;
    check_done(impactlab_loop_signal(loop, name, &value, &told));
    return value;
}

int make_handles(void **state)
{
    (void)state;
    h = calloc(1, sizeof *h);
    h->scenario = opened("corrected/first-impact");
    check_done(impactlab_scenario_set(h->scenario, "run.duration", "0.3", &told));
    h->run = run_of(h->scenario, IMPACTLAB_KEEP_ROWS);
    h->loop = loop_of(h->scenario, IMPACTLAB_COMMAND);
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
    fail_if(status == IMPACTLAB_OK || told.status != status ||
                strstr(told.sentence, words) == NULL,
            "status %d, %d: '%s' has no '%s'", status, told.status, told.sentence, words);
}

// Many runs at once give what single runs give.
#include <stdlib.h>

#include "src/study/batch.h"
#include "tests/arm_fixture.h"

enum { RUNS = 200 };

// Voltages from 0.5 V to 10 V on arms of 2, 3 and 5 links.
static void make(void *context, size_t i, scenario *made)
{
    static const char *const links[] = {"arm.links=2", "arm.links=3", "arm.links=5"};
    (void)context;
    made->parameters = fixture_parameters(SETTINGS(links[i % 3], "run.duration=0.5"));
    made->parameters.motor.voltage = 0.5 + 9.5 * (double)i / RUNS;
}

static void check_same(const summary *a, const summary *b)
{
    for (int i = 0; i < summary_count; i++) {
        double x = 0, y = 0;
        x = summary_value(a, i);
        y = summary_value(b, i);
        if (!summary_table[i].timing && memcmp(&x, &y, sizeof x) != 0 && !(isnan(x) && isnan(y))) {
            fail_msg("%s is %.17g in a batch, %.17g alone", summary_table[i].key, x, y);
        }
    }
}

static void batches_equal_single_runs_to_the_last_bit(void **state)
{
    (void)state;
    summary *batch = calloc(RUNS, sizeof *batch);
    for (int jobs = 1; jobs <= 3; jobs++) {
        memset(batch, 0, RUNS * sizeof *batch);
        assert_int_equal(batch_run(make, NULL, RUNS, jobs, batch), STATUS_OK);
        for (size_t i = 0; i < RUNS; i++) {
            scenario s = {0};
            run_result single;
            make(NULL, i, &s);
            run_scenario(&s, false, &single);
            check_same(&batch[i], &single.summary);
            run_finish(&single);
        }
    }
    free(batch);
}

static void make_bad(void *context, size_t i, scenario *made)
{
    make(context, i, made);
    made->parameters.motor.stiction = i == 7 ? (double)NAN : 0.045;
}

static void a_failing_run_does_not_touch_the_others(void **state)
{
    (void)state;
    summary *batch = calloc(RUNS, sizeof *batch);
    assert_int_equal(batch_run(make_bad, NULL, RUNS, 2, batch), STATUS_OK);
    for (int i = 0; i < RUNS; i++) {
        assert_int_equal(batch[i].status, i == 7 ? STATUS_NOT_FINITE : STATUS_OK);
    }
    assert_non_null(strstr(batch[7].message, "t = "));
    free(batch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(batches_equal_single_runs_to_the_last_bit),
        cmocka_unit_test(a_failing_run_does_not_touch_the_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

// Many runs at once give what single runs give.
#include "src/engines/pair/taylor_lanes.h"
#include "src/study/batch.h"
#include "tests/arm_fixture.h"

enum { RUNS = 200 };

// Voltages from 0.5 V to 10 V on arms of 2, 3 and 5 links.
static status make(void *context, size_t i, scenario *made, fault *f)
{
    static const char *const links[] = {"arm.links=2", "arm.links=3", "arm.links=5"};
    (void)context, (void)f;
    made->parameters = fixture_parameters(SETTINGS(links[i % 3], "run.duration=0.5"));
    made->parameters.motor.voltage = 0.5 + 9.5 * (double)i / RUNS;
    return STATUS_OK;
}

// All on that many threads.
static void run_all(status (*maker)(void *, size_t, scenario *, fault *), void *context,
                    size_t count, int jobs, summary *summaries)
{
    const batch all = {.context = context,
                       .count = count,
                       .make = maker,
                       .summaries = summaries};
    DONE(batch_run(&all, jobs, &f));
}

static void check_same(const summary *a, const summary *b)
{
    for (int i = 0; i < summary_count; i++) {
        double x = 0, y = 0;
        x = summary_value(a, i);
        y = summary_value(b, i);
        fail_if(!summary_table[i].timing && memcmp(&x, &y, sizeof x) != 0 &&
                    !(isnan(x) && isnan(y)),
                "%s is %.17g in a batch, %.17g alone", summary_table[i].key, x, y);
    }
}

TEST(batches_equal_single_runs_to_the_last_bit)
{
    SCOPED(free_kept) summary *runs = calloc(RUNS, sizeof *runs);
    for (int jobs = 1; jobs <= 3; jobs++) {
        memset(runs, 0, RUNS * sizeof *runs);
        run_all(make, NULL, RUNS, jobs, runs);
        for (size_t i = 0; i < RUNS; i++) {
            scenario s = {0};
            KEPT_RUN(single);
            make(NULL, i, &s, NULL);
            run_scenario(&s, false, &single);
            check_same(&runs[i], &single.summary);
        }
    }
}

static status make_bad(void *context, size_t i, scenario *made, fault *f)
{
    make(context, i, made, f);
    made->parameters.motor.stiction = i == 7 ? (double)NAN : 0.045;
    return i == 8 ? fault_set(f, STATUS_BAD_SCENARIO, "no such run") : STATUS_OK;
}

TEST(a_failing_run_does_not_touch_the_others)
{
    SCOPED(free_kept) summary *runs = calloc(RUNS, sizeof *runs);
    run_all(make_bad, NULL, RUNS, 2, runs);
    for (int i = 0; i < RUNS; i++) {
        assert_int_equal(runs[i].status, i == 7   ? STATUS_NOT_FINITE
                                         : i == 8 ? STATUS_BAD_SCENARIO
                                                  : STATUS_OK);
    }
    assert_non_null(strstr(runs[7].message, "t = "));
    assert_string_equal(runs[8].message, "no such run");
}

typedef struct random_base {
    scenario scenario; // what all runs share
    size_t first;      // number of the first
} random_base;

// Motor, arm, wall and restitution at random: a number is the same run for every caller.
static status make_random(void *context, size_t i, scenario *made, fault *f)
{
    const random_base *from = context;
    random_generator g = seeded(from->first + i + 1);
    (void)f;
    double u[8];
    for (int k = 0; k < 8; k++) {
        u[k] = random_uniform(&g);
    }
    *made = from->scenario;
    parameters *p = &made->parameters;
    p->motor.voltage = -1 + 6 * u[0];
    p->motor.stiction = u[1] < 0.2 ? 0 : 0.1 * u[1];
    p->arm.k2 = 2 + 20 * u[2];
    p->arm.damping_ratio = u[3] < 0.5 ? 0 : 0.2 * (u[3] - 0.5);
    p->wall.angle = 0.02 + 0.4 * u[4];
    p->wall.restitution = u[5] < 0.4 ? 0 : u[5];
    p->wall.kind = u[6] < 0.5 ? WALL_POINT : u[6] < 0.95 ? WALL_PLANE : WALL_NONE;
    p->arm.hub_joint = u[7] < 0.03 ? HUB_SPRING : HUB_RIGID;
    p->arm.k1 = 200;
    return STATUS_OK;
}

// Runs from a number on with vectors of each width: none differs in a bit from one by
// itself, and none fails. Returns their impacts.
static double compare_widths(size_t first, size_t runs)
{
    char name[] = "random", none[] = "";
    random_base from = {.first = first};
    from.scenario =
        (scenario){.name = name, .file = none, .title = none, .description = none};
    from.scenario.parameters = fixture_parameters(NULL);
    SCOPED(free_kept)
    summary *scalar = calloc(runs, sizeof *scalar), *wide = calloc(runs, sizeof *wide);
    assert_int_equal(taylor_limit_width(1), 1);
    run_all(make_random, &from, runs, 2, scalar);
    for (int width = 2; width <= TAYLOR_WIDEST; width *= 2) {
        if (taylor_limit_width(width) != width) {
            print_message("no vectors of %d on this processor\n", width);
            continue;
        }
        run_all(make_random, &from, runs, 2, wide);
        for (size_t i = 0; i < runs; i++) {
            assert_int_equal(wide[i].status, scalar[i].status);
            check_same(&wide[i], &scalar[i]);
        }
    }
    taylor_limit_width(0);

    double impacts = 0;
    for (size_t i = 0; i < runs; i++) {
        impacts += scalar[i].impacts;
        assert_int_equal(scalar[i].status, STATUS_OK);
    }
    return impacts;
}

// As many runs as the environment's IMPACTLAB_RANDOM_RUNS says, or 1000; 100 000 take a
// minute.
TEST(every_width_of_vectors_gives_the_same_bits)
{
    const char *asked = getenv("IMPACTLAB_RANDOM_RUNS");
    const size_t runs = asked != NULL ? (size_t)atol(asked) : 1000;
    assert_true(compare_widths(0, runs) > (double)runs);

    // in number 15073 a bound of the force decides that only narrow vectors had
    assert_true(compare_widths(15064, 16) > 0);
}

#include "src/study/bench.h"

#include "tests/check.h"

static int calls;

// 9, 1, 2, 3 ...: the first one, which warms the caches, must not count
static status count_up(const benchmark *b, double *value, fault *f)
{
    (void)b;
    (void)f;
    *value = calls == 0 ? 9 : calls;
    calls++;
    return STATUS_OK;
}

static status give_up(const benchmark *b, double *value, fault *f)
{
    (void)b;
    *value = 0;
    return fault_set(f, STATUS_NOT_FINITE, "it went wrong");
}

TEST(median_and_extremes_leave_out_the_first)
{
    const benchmark b = {"name", "us", false, count_up, "", 0};
    bench_result r;
    calls = 0;
    DONE(bench_run(&b, &r, &f));
    assert_int_equal(calls, BENCH_REPETITIONS + 1);
    check_close(r.min, 1, 0);
    check_close(r.max, BENCH_REPETITIONS, 0);
    check_close(r.median, (BENCH_REPETITIONS + 1) / 2.0, 0);
}

TEST(a_measurement_that_fails_is_passed_on)
{
    const benchmark b = {"name", "us", false, give_up, "", 0};
    bench_result r;
    fault f;
    assert_int_equal(bench_run(&b, &r, &f), STATUS_NOT_FINITE);
    assert_string_equal(f.text, "it went wrong");
}

TEST(slower_is_said_of_times_and_rates)
{
    const benchmark time = {"t", "us", false, NULL, "", 0},
                    rate = {"r", "1/s", true, NULL, "", 0};
    const bench_result half = {10, 9, 11}, twice = {20, 19, 21}, noisy = {20, 9.5, 30},
                       little = {11, 10.5, 12};
    assert_true(bench_is_slower(&time, &twice, 10));
    assert_false(bench_is_slower(&time, &half, 20));
    assert_false(bench_is_slower(&time, &noisy, 10));
    assert_false(bench_is_slower(&time, &little, 10));
    assert_false(bench_is_slower(&rate, &twice, 10));
    assert_true(bench_is_slower(&rate, &half, 20));
    check_close(bench_slowdown(&time, 20, 10), 2, 0);
    check_close(bench_slowdown(&rate, 20, 10), 0.5, 0);
}

TEST_IN_FOLDER(what_is_written_is_read_back)
{
    const bench_result written[BENCHMARKS] = {[1] = {1.25, 1, 2}, [9] = {3e7, 2e7, 4e7}};
    double read[BENCHMARKS];
    json_t *object = bench_export(written);
    KEPT_TEXT(text) = json_dumps(object, 0);
    put_file("times", text);
    json_decref(object);
    DONE(bench_read("times", read, &f));
    for (int i = 0; i < BENCHMARKS; i++) {
        check_close(read[i], written[i].median, 0);
    }
}

TEST_IN_FOLDER(a_file_that_is_no_baseline_is_refused)
{
    double read[BENCHMARKS];
    for (EACH_TEXT(c, "{", "[]", "{\"bench\": 3}", "{\"bench\": [{\"name\": \"x\"}]}",
                   "{\"bench\": [{\"name\": \"x\", \"unit\": \"s\"}]}")) {
        put_file("times", *c);
        REFUSED(STATUS_CANNOT_READ, "times:", bench_read("times", read, &f));
    }
    REFUSED(STATUS_CANNOT_READ, "/nowhere/x.json",
            bench_read("/nowhere/x.json", read, &f));
}

static void every_benchmark_of_the_library_gives_a_number(void **state)
{
    (void)state;
    bench_window = 1e-3;
    for (const benchmark *b = bench_table; b < bench_table + BENCHMARKS; b++) {
        double value = -1;
        fault f = {0};
        fail_if(b->measure(b, &value, &f) != STATUS_OK, "%s: %s", b->name, f.text);
        assert_true(value > 0 && isfinite(value));
    }
}

// Without an argument all but what really measures, with one just that.
int main(int count, char **arguments)
{
    (void)arguments;
    const struct CMUnitTest measuring[] = {
        cmocka_unit_test(every_benchmark_of_the_library_gives_a_number),
    };
    return (count > 1 ? cmocka_run_group_tests(measuring, NULL, NULL)
                      : run_cases(NULL, NULL)) != 0;
}

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
    assert_string_equal(r.name, "name");
    assert_string_equal(r.unit, "us");
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
    const benchmark time = {"t", "us", false, NULL, "", 0}, rate = {"r", "1/s", true, NULL, "", 0};
    const bench_result before = {.median = 10, .min = 9, .max = 11};
    const bench_result twice = {.median = 20, .min = 19, .max = 21};
    const bench_result noisy = {.median = 20, .min = 9.5, .max = 30};
    const bench_result little = {.median = 11, .min = 10.5, .max = 12};
    assert_true(bench_is_slower(&time, &twice, &before));
    assert_false(bench_is_slower(&time, &before, &twice));
    assert_false(bench_is_slower(&time, &noisy, &before));
    assert_false(bench_is_slower(&time, &little, &before));
    assert_false(bench_is_slower(&rate, &twice, &before));
    assert_true(bench_is_slower(&rate, &before, &twice));
    check_close(bench_slowdown(&time, &twice, &before), 2, 0);
    check_close(bench_slowdown(&rate, &twice, &before), 0.5, 0);
}

// A file with the given text, to be unlinked.
static void make_file(char *path, const char *text)
{
    strcpy(path, "/tmp/impactlab-test-XXXXXX");
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, text, strlen(text)), (ssize_t)strlen(text));
    close(descriptor);
}

TEST(what_is_written_is_read_back)
{
    const bench_result written[] = {{"one", "us/ms", 1.25, 1, 2}, {"two", "1/s", 3e7, 2e7, 4e7}};
    char path[64], *text;
    json_t *object = bench_export(written, 2);
    text = json_dumps(object, 0);
    make_file(path, text);
    bench_result *read;
    int count;
    DONE(bench_read(path, &read, &count, &f));
    assert_int_equal(count, 2);
    for (int i = 0; i < 2; i++) {
        assert_string_equal(read[i].name, written[i].name);
        assert_string_equal(read[i].unit, written[i].unit);
        check_close(read[i].median, written[i].median, 0);
        check_close(read[i].min, written[i].min, 0);
        check_close(read[i].max, written[i].max, 0);
    }
    free(read);
    free(text);
    json_decref(object);
    unlink(path);
}

TEST(a_file_that_is_no_baseline_is_refused)
{
    bench_result *read;
    int count;
    fault f;
    for (EACH_TEXT(c, "{", "[]", "{\"bench\": 3}", "{\"bench\": [{\"name\": \"x\"}]}",
                   "{\"bench\": [{\"name\": \"x\", \"unit\": \"s\"}]}")) {
        char path[64];
        make_file(path, *c);
        f.text[0] = '\0';
        assert_int_equal(bench_read(path, &read, &count, &f), STATUS_CANNOT_READ);
        assert_non_null(strstr(f.text, path));
        assert_null(read);
        unlink(path);
    }
    assert_int_equal(bench_read("/nowhere/x.json", &read, &count, &f), STATUS_CANNOT_READ);
    assert_non_null(strstr(f.text, "/nowhere/x.json"));
}

static void every_benchmark_of_the_library_gives_a_number(void **state)
{
    (void)state;
    bench_window = 1e-3;
    for (int i = 0; i < bench_count; i++) {
        double value = -1;
        fault f = {0};
        fail_if(bench_table[i].measure(&bench_table[i], &value, &f) != STATUS_OK, "%s: %s",
                bench_table[i].name, f.text);
        assert_true(value > 0 && isfinite(value));
        assert_true(strlen(bench_table[i].name) < BENCH_NAME);
        assert_true(strlen(bench_table[i].unit) < BENCH_UNIT);
    }
}

// Without an argument all but what really measures, with one just that.
int main(int count, char **arguments)
{
    (void)arguments;
    const struct CMUnitTest measuring[] = {
        cmocka_unit_test(every_benchmark_of_the_library_gives_a_number),
    };
    return (count > 1 ? cmocka_run_group_tests(measuring, NULL, NULL) : run_cases(NULL, NULL)) != 0;
}

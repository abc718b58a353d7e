// Rows of a comparison and what counts as a difference.
#include <stdlib.h>
#include <string.h>

#include "src/lab/compare.h"
#include "tests/rig_fixture.h"

static void differences_are_shares_of_the_larger_value(void **state)
{
    (void)state;
    const double none = (double)NAN;
    assert_false(compare_differs(1.0, 1.05, 0.05));
    assert_true(compare_differs(1.0, 1.06, 0.05));
    assert_true(compare_differs(-1.0, 1.0, 0.5));
    assert_false(compare_differs(0, 0, 0));
    assert_true(compare_differs(0, 1e-9, 0.05));
    assert_false(compare_differs(none, none, 0.05));
    assert_true(compare_differs(none, 1, 0.05));
}

// The row of the impact of 5.4 under a law, named like it.
static compare_row row_of(scenario *s, const char *name, const char *law)
{
    run_result r;
    *s = (scenario){.name = (char *)name, .parameters = rig_parameters(SETTINGS(law))};
    assert_int_equal(run_scenario(s, false, &r), STATUS_OK);
    compare_row row = compare_row_of(s, &r.summary);
    run_finish(&r);
    return row;
}

static void rows_reach_every_form(void **state)
{
    (void)state;
    scenario a, b;
    compare_row rows[2] = {row_of(&a, "a \"b\"", "control.law=hybrid"),
                           row_of(&b, "bare", "control.law=none")};
    assert_string_equal(rows[0].law, "hybrid");
    assert_string_equal(rows[1].law, "none");
    char *text = NULL, *csv = NULL;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    compare_text(stream, rows, 2, &rows[0], 0.05);
    fclose(stream);
    stream = open_memstream(&csv, &size);
    compare_csv(stream, rows, 2);
    fclose(stream);
    // the reference differs from itself in nothing, the bare arm in its peak
    char *second = strchr(text, '\n') + 1, *third = strchr(second, '\n') + 1;
    assert_null(memchr(second, '*', (size_t)(third - second)));
    assert_non_null(strchr(third, '*'));
    assert_non_null(strstr(csv, "\n\"a \"\"b\"\"\",hybrid,ok,"));
    assert_non_null(strstr(csv, ",,,\n")); // no error, command and energy without a rig
    json_t *whole = compare_json(rows, 2, &rows[0], 0.05), *runs = json_object_get(whole, "runs");
    assert_int_equal(json_array_size(runs), 2);
    assert_int_equal(json_array_size(json_object_get(json_array_get(runs, 0), "differs")), 0);
    assert_true(json_is_null(json_object_get(json_array_get(runs, 1), "steady_error_N")));
    check_close(json_number_value(json_object_get(json_array_get(runs, 0), "peak_force_N")),
                rows[0].values[0], 0);
    json_decref(whole);
    free(text);
    free(csv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(differences_are_shares_of_the_larger_value),
        cmocka_unit_test(rows_reach_every_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

// The values of a varied parameter: grids, lists and shares of a range.
#include "src/study/sweep_axis.h"

#include "tests/check.h"

static sweep_axis parsed(const char *path, const char *values, bool drawn)
{
    sweep_axis axis = {.parameter = parameter_find(path)};
    fault f = {0};
    fail_if(sweep_axis_parse(&axis, values, drawn, &f) != STATUS_OK, "%s=%s: %s", path,
            values, f.text);
    return axis;
}

TEST(shares_of_a_range_are_even)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = parsed("arm.k2", "4:8", true);
    check_close(sweep_axis_value_at(&axis, 0), 4, 0);
    check_close(sweep_axis_value_at(&axis, 0.25), 5, 1e-14);
    sweep_axis_finish(&axis);

    // the same the other way round, and even in the logarithm
    axis = parsed("arm.k2", "8:4", true);
    check_close(sweep_axis_value_at(&axis, 0.25), 5, 1e-14);
    sweep_axis_finish(&axis);
    axis = parsed("arm.k2", "1:16:2:log", true);
    check_relative(sweep_axis_value_at(&axis, 0.25), 2.0, 1e-14);
    check_relative(sweep_axis_value_at(&axis, 0.75), 8.0, 1e-14);
    sweep_axis_finish(&axis);
    axis = parsed("arm.k2", "3:48:log", true);
    check_relative(sweep_axis_value_at(&axis, 0), 3.0, 1e-14);
    check_relative(sweep_axis_value_at(&axis, 0.25), 6.0, 1e-14);
    check_relative(sweep_axis_value_at(&axis, 0.75), 24.0, 1e-14);
}

// Whole numbers come alike often, the first and the last of the range, too.
TEST(whole_numbers_have_equal_shares)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = parsed("arm.links", "2:5", true);
    int found[8] = {0};
    for (int i = 0; i < 400; i++) {
        const double value = sweep_axis_value_at(&axis, (i + 0.5) / 400);
        assert_true(value >= 2 && value <= 5 && value == floor(value));
        found[(int)value]++;
    }
    for (int links = 2; links <= 5; links++) {
        assert_int_equal(found[links], 100);
    }
}

TEST(values_of_a_list_have_equal_shares)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = parsed("arm.k2", "7,3,5", true);
    check_close(sweep_axis_value_at(&axis, 0.1), 7, 0);
    check_close(sweep_axis_value_at(&axis, 0.5), 3, 0);
    check_close(sweep_axis_value_at(&axis, 0.999), 5, 0);
}

TEST(a_grid_has_both_ends)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = parsed("arm.k2", "1:16:3:log", false);
    assert_int_equal(axis.count, 3);
    check_close(sweep_axis_value(&axis, 0), 1, 0);
    check_relative(sweep_axis_value(&axis, 1), 4.0, 1e-14);
    check_close(sweep_axis_value(&axis, 2), 16, 0);
}

TEST(what_is_no_axis_is_refused)
{
    for (EACH_TEXT(c, "", "1:2", "1:2:0", "1:2:3:lag", "1:2:3:log:4", "0:1:3:log",
                   "x:1:3", "1,,2", "1:2:1e16", "-1:2:3", "1:2:2.5")) {
        SCOPED(sweep_axis_finish)
        sweep_axis axis = {.parameter = parameter_find("arm.k2")};
        fault f = {0};
        fail_if(sweep_axis_parse(&axis, *c, false, &f) == STATUS_OK, "'%s' was accepted",
                *c);
        assert_true(strlen(f.text) > 0);
    }
}

// Refusals are reported: the values of a parameter, and the words of a sentence.
static void check_refused(const char *name, const char *values, bool drawn,
                          const char *what)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = {0};
    fault f = {0};
    status code = sweep_axis_find(&axis, name, &f);
    code = code == STATUS_OK ? sweep_axis_parse(&axis, values, drawn, &f) : code;
    fail_if(code == STATUS_OK || strstr(f.text, what) == NULL,
            "%s=%s: expected a refusal about '%s', not '%s'", name, values, what, f.text);
}

TEST(a_refusal_says_what_is_expected)
{
    check_refused("motor.volts", "1:2:3", false, "motor.volt");
    check_refused("control.settings", "1:2:3", false, "is a text");
    check_refused("arm.joint_stiffness", "1:2:3", false, "its first number is");
    check_refused("arm.k2[1]", "1:2:3", false, "is no list");
    for (EACH_TEXT(c, "arm.joint_stiffness[0]", "arm.joint_stiffness[1.5]",
                   "arm.joint_stiffness[]", "arm.joint_stiffness[1",
                   "arm.joint_stiffness[1]x", "arm.joint_stiffness[999]")) {
        check_refused(*c, "1:2:3", false, "is no number of a list");
    }
    check_refused("arm.joint_stiffness[1]", "[]:4:2", false, "is no number");
    check_refused("wall.kind", "point:plane:2", false, "expected a list such as");
    check_refused("printed.sign_dead_band", "false:true:2", false, "true,false");
    check_refused("arm.k2", "4:4:2", false, "two different ends");
    check_refused("arm.k2", "4:5:6:7:8", true, "a:b or a:b:n");
    check_refused("arm.k2", "-1:4:log", true, "out of range");
    check_refused("initial.angle", "-1:1:3:log", false, "ends above zero");
    check_refused("initial.angle", "0.1:-1:3:log", false, "ends above zero");
    check_refused("initial.angle", "0:1:3:log", false, "ends above zero");
    check_refused("initial.angle", "0.1:0:3:log", false, "ends above zero");
    check_refused("arm.links", "2:4:9", false, "links");
    check_refused("arm.k2", "4:5:many", false, "no number of values");
    check_refused("arm.k2", "4:5:1", false, "no number of values");
}

// One number of a list is exchanged, the others stay as they are.
TEST(a_number_of_a_list_is_set_alone)
{
    static const double numbers[] = {5.25, 12, 30.5};
    for (int k = 1; k <= 3; k++) {
        parameters p;
        SCOPED(sweep_axis_finish) sweep_axis axis = {0};
        fault f = {0};
        const char *name = formatted("arm.joint_stiffness[%d]", k);
        char text[PARAMETER_VALUE_SIZE];
        double found[PARAMETER_LIST_MOST];
        parameters_defaults(&p, ARM_CORRECTED);
        const int list = parameter_find("arm.joint_stiffness");
        assert_int_equal(parameter_set_text(&p, list, "5.25,12,30.5", &f), STATUS_OK);
        assert_int_equal(sweep_axis_find(&axis, name, &f), STATUS_OK);
        assert_string_equal(axis.name, name);
        assert_int_equal(axis.element, k);
        assert_int_equal(axis.parameter, list);
        assert_int_equal(sweep_axis_apply(&axis, 0.1, &p, &f), STATUS_OK);
        parameter_format(&p, list, text, sizeof text);
        assert_int_equal(parameter_list_numbers(text, found), 3);
        for (int i = 0; i < 3; i++) {
            check_close(found[i], i + 1 == k ? 0.1 : numbers[i], 0);
        }

        // a number that the list does not have, and one that it cannot have
        axis.element = 4;
        assert_int_equal(sweep_axis_apply(&axis, 1, &p, &f), STATUS_BAD_ARGUMENT);
        assert_string_equal(f.path, "arm.joint_stiffness");
        axis.element = k;
        assert_int_not_equal(sweep_axis_apply(&axis, -1, &p, &f), STATUS_OK);
    }

    // the last number that a list can have
    sweep_axis axis = {0};
    const char *last = formatted("arm.joint_stiffness[%d]", PARAMETER_LIST_MOST);
    DONE(sweep_axis_find(&axis, last, &f));
    assert_int_equal(axis.element, PARAMETER_LIST_MOST);
    const char *beyond = formatted("arm.joint_stiffness[%d]", PARAMETER_LIST_MOST + 1);
    REFUSED(STATUS_BAD_ARGUMENT, "", sweep_axis_find(&axis, beyond, &f));
}

// Every value of a grid, a list or a draw, and the text by which a database knows it.
TEST(values_and_texts_are_those_that_were_asked_for)
{
    static const struct {
        const char *path, *asked;
        bool drawn;
        size_t count;
        double values[5];
        const char *text;
    } cases[] = {
        {"arm.k2", "1:3:5", false, 5, {1, 1.5, 2, 2.5, 3}, "1:3:5"},
        {"arm.k2", "3:1:3", false, 3, {3, 2, 1}, "3:1:3"},
        {"arm.k2", "4:5:2", false, 2, {4, 5}, "4:5:2"},
        {"arm.k2", "16:1:3:log", false, 3, {16, 4, 1}, "16:1:3:log"},
        {"arm.links", "2:10:5", false, 5, {2, 4, 6, 8, 10}, "2:10:5"},
        {"arm.links", "2:32:5:log", false, 5, {2, 4, 8, 16, 32}, "2:32:5:log"},
        {"arm.k2", "7,3,5", false, 3, {7, 3, 5}, "7,3,5"},
        {"arm.k2", "7", false, 1, {7}, "7"},
        {"wall.kind",
         "none,plane,point",
         false,
         3,
         {WALL_NONE, WALL_PLANE, WALL_POINT},
         "none,plane,point"},
        {"sensor.ideal", "true,false", false, 2, {1, 0}, "true,false"},
        {"arm.k2", "4:8", true, 0, {0}, "4:8"},
        {"arm.k2", "4:8:9", true, 0, {0}, "4:8"},
        {"arm.k2", "4:8:10000000", true, 0, {0}, "4:8"},
        {"arm.k2", "4:8:log", true, 0, {0}, "4:8:log"},
        {"arm.joint_stiffness[2]", "4:6:3", false, 3, {4, 5, 6}, "4:6:3"},
        {"arm.joint_stiffness[2]", "4.5,6", false, 2, {4.5, 6}, "4.5,6"},
    };
    for (EACH(c, cases)) {
        SCOPED(sweep_axis_finish) sweep_axis axis = {0};
        fault f = {0};
        assert_int_equal(sweep_axis_find(&axis, c->path, &f), STATUS_OK);
        fail_if(sweep_axis_parse(&axis, c->asked, c->drawn, &f) != STATUS_OK, "%s=%s: %s",
                c->path, c->asked, f.text);
        assert_int_equal(axis.count, c->count);
        assert_int_equal(axis.is_range, strchr(c->asked, ':') != NULL);
        for (size_t k = 0; k < axis.count; k++) {
            check_relative(sweep_axis_value(&axis, k), c->values[k], 1e-14);
        }
        assert_string_equal(axis.text, c->text);
    }

    // the same value twice is refused wherever it stands
    check_refused("arm.k2", "5,3,5", false, "twice");
    check_refused("arm.k2", "3,5,5", false, "twice");
    check_refused("arm.links", "2:4:9:log", false, "9 values give 2 twice");
    check_refused("arm.k2", "4:8:9007199254740994", true, "2 to 9007199254740992");
    check_refused("arm.k2", "4:5:6:log:7", false, "a:b:n");
    check_refused("arm.k2", "4:5:6:7", true, "a:b or a:b:n");
    check_refused("arm.k2", "4:log", true, "log");
}

// A range of whole numbers, evenly or logarithmically spaced, is refused just where one
// of its values is none or comes twice, as all of them tell.
TEST(whole_numbers_of_a_range_are_different)
{
    random_generator g = seeded(6);
    int taken = 0;
    enum { TRIED = 4000, MOST = 400 };
    for (int i = 0; i < TRIED; i++) {
        const int from = 1 + (int)random_below(&g, 300),
                  to = 1 + (int)random_below(&g, 300),
                  n = 2 + (int)random_below(&g, i % 2 == 0 ? 20 : MOST);
        const bool logarithmic = i % 4 < 2;
        if (from == to) {
            continue;
        }

        // each value from its definition
        bool good = logarithmic || (to - from) % (n - 1) == 0;
        double before = from;
        for (int k = 1; k < n; k++) {
            const double ratio = pow((double)to / from, (double)k / (n - 1));
            const double even = from + (double)(to - from) * k / (n - 1);
            const double value = logarithmic ? round(from * ratio) : even;
            good = good && value != before;
            before = value;
        }

        SCOPED(sweep_axis_finish) sweep_axis axis = {0};
        fault f = {0};
        assert_int_equal(sweep_axis_find(&axis, "control.seed", &f), STATUS_OK);
        const char *text =
            formatted("%d:%d:%d%s", from, to, n, logarithmic ? ":log" : "");
        const bool read = sweep_axis_parse(&axis, text, false, &f) == STATUS_OK;
        fail_if(read != good, "%s: %s", text, read ? "taken" : f.text);
        taken += read;
    }
    assert_true(taken > 100 && taken < TRIED - 100);
}

// The table of parameters: properties of every entry, and reading of values.
#include "tests/given_parameters.h"

// The text is refused, nothing changes, and the sentence mentions the path and
// `expected`.
static void check_refused(const char *path, const char *text, const char *expected)
{
    parameters p = fresh(ARM_CORRECTED), before = p;
    fault f = {0};
    int index = parameter_find(path);
    assert_true(index >= 0);
    fail_if(parameter_set_text(&p, index, text, &f) == STATUS_OK,
            "%s = '%s' was accepted", path, text);
    assert_int_equal(f.code, STATUS_BAD_SCENARIO);
    assert_memory_equal(&p, &before, sizeof p);
    assert_string_equal(f.path, path);
    fail_if(strstr(f.text, path) == NULL || strstr(f.text, expected) == NULL,
            "'%s' does not mention %s and '%s'", f.text, path, expected);
}

TEST(every_path_is_unique_and_found)
{
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        fault f = {0};
        assert_int_equal(parameter_find(path), i);
        assert_int_equal(parameter_look_up(path, &f), i);
        assert_string_equal(f.text, "");
        const char *dot = strchr(path, '.');
        assert_non_null(dot);
        assert_null(strchr(dot + 1, '.'));
    }
    assert_int_equal(parameter_find("arm.k3"), -1);
    assert_int_equal(parameter_find(""), -1);
}

TEST(every_field_is_a_place_of_its_own)
{
    for (int i = 0; i < parameter_count; i++) {
        for (int j = 0; j < i; j++) {
            fail_if(parameter_table[i].offset == parameter_table[j].offset,
                    "%s and %s share a field", parameter_table[i].path,
                    parameter_table[j].path);
        }
    }
}

// Number of words in "a|b|c".
static int choice_count(const char *choices)
{
    int count = 1;
    for (const char *c = choices; *c != '\0'; c++) {
        count += *c == '|';
    }
    return count;
}

TEST(every_entry_is_complete)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        assert_non_null(info->unit);
        assert_true(strlen(info->description) > 0);
        assert_int_not_equal(info->description[strlen(info->description) - 1], '.');
        check_below(info->minimum, info->maximum);
        if (info->type == PARAMETER_CHOICE) {
            assert_non_null(info->choices);
            check_close(info->maximum, choice_count(info->choices) - 1, 0);
        } else if (info->type != PARAMETER_TEXT) {
            assert_null(info->choices);
        }
    }
}

TEST(defaults_are_in_range)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        double both[] = {info->default_corrected, info->default_printed};
        for (int k = 0; k < 2; k++) {
            bool derived = isnan(both[k]);
            fail_if(!derived && !parameter_is_text(info) &&
                        (both[k] < info->minimum || both[k] > info->maximum),
                    "%s: default %g is not in %g to %g", info->path, both[k],
                    info->minimum, info->maximum);
            assert_true(!derived || strcmp(info->path, "arm.link_inertia") == 0 ||
                        strcmp(info->path, "arm.EI") == 0 ||
                        strcmp(info->path, "wall.stiffness") == 0 ||
                        strcmp(info->path, "wall.damping") == 0 ||
                        strcmp(info->path, "motor.transconductance") == 0);
        }
    }
}

// Steps through the range of one parameter; text made of a value reads back as the same
// value.
static void check_round_trip(int index)
{
    const parameter_info *info = &parameter_table[index];
    bool whole = info->type != PARAMETER_REAL;
    for (int k = 0; k <= 40; k++) {
        double share = k / 40.0;
        double value =
            info->minimum + (info->maximum - info->minimum) * share * share * share;
        parameters p = fresh(ARM_CORRECTED), q = p;
        char text[64], again[64];
        value = whole ? floor(value) : value;
        DONE(parameter_set_number(&p, index, value, &f));
        check_close(parameter_get(&p, index), value, 0);
        parameter_format(&p, index, text, sizeof text);
        give(&q, info->path, text);
        check_close(parameter_get(&q, index), value, 0);
        parameter_format(&q, index, again, sizeof again);
        assert_string_equal(text, again);
        assert_int_equal(q.set[index], 1);
    }
}

TEST(text_and_value_go_both_ways)
{
    for (int i = 0; i < parameter_count; i++) {
        if (!parameter_is_text(&parameter_table[i])) {
            check_round_trip(i);
        }
    }
}

TEST(the_own_unit_is_accepted)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        parameters p = fresh(ARM_PRINTED), q = p;
        char number[64];
        if (info->unit[0] == '\0' || isnan(parameter_get(&p, i)) ||
            parameter_is_text(info)) {
            continue; // no unit, or a default that follows from others
        }
        parameter_format(&p, i, number, sizeof number);
        give(&q, info->path, formatted("  %s   %s ", number, info->unit));
        check_close(parameter_get(&q, i), parameter_get(&p, i), 0);
    }
}

TEST(notations_of_numbers)
{
    static const struct {
        const char *text;
        double value;
    } cases[] = {
        {"49.2", 49.2}, {"4.92e1", 49.2}, {"+3", 3}, {".5", 0.5}, {"1e-6", 1e-6}};
    for (EACH(c, cases)) {
        parameters p = fresh(ARM_CORRECTED);
        give(&p, "arm.k2", c->text);
        check_close(p.arm.k2, c->value, 0);
    }
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "motor.voltage", "-2.5 V");
    check_close(p.motor.voltage, -2.5, 0);
}

TEST(words_for_truth)
{
    static const char *const truths[] = {"true", "True", "TRUE", "yes", "on", "1"};
    static const char *const lies[] = {"false", "False", "FALSE", "no", "off", "0"};
    for (int i = 0; i < 6; i++) {
        parameters p = fresh(ARM_PRINTED);
        give(&p, "printed.sign_dead_band", lies[i]);
        assert_false(p.printed.sign_dead_band);
        give(&p, "printed.sign_dead_band", truths[i]);
        assert_true(p.printed.sign_dead_band);
    }
}

TEST(wrong_values_are_refused)
{
    check_refused("arm.k2", "stiff", "not a number");
    check_refused("arm.k2", "", "no value");
    check_refused("arm.k2", "   ", "no value");
    check_refused("arm.k2", "-4.92", "out of range");
    check_refused("arm.k2", "1e10", "out of range");
    check_refused("arm.k2", "4.92 N/m", "expected N m/rad");
    check_refused("arm.k2", "4.92 4.92", "expected N m/rad");
    check_refused("arm.k2", "0x10", "not a number");
    check_refused("arm.k2", "nan", "not finite");
    check_refused("arm.k2", ".nan", "is not");
    check_refused("arm.k2", "-inf", "not finite");
    check_refused("arm.k2", "1e999", "not a finite number");
    check_refused("arm.damping_ratio", "0.1 s", "pure number");
    check_refused("arm.links", "2.5", "whole number");
    check_refused("arm.links", "two", "whole number");
    check_refused("arm.links", "99999999999999999999", "out of range");
    check_refused("arm.links", "0", "1 to 1024");
    check_refused("arm.hub_joint", "glued", "rigid|spring");
    check_refused("arm.hub_joint", "1", "rigid|spring");
    check_refused("arm.model", "Printed", "corrected|printed");
    check_refused("printed.sign_dead_band", "maybe", "neither true nor false");
    check_refused("printed.sign_dead_band", "2", "neither true nor false");
}

// 5e-324 H for the motor ended the program: what is divided by such a number is none.
TEST(values_next_to_nothing_are_refused)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        for (double value = 1e-101; value > 0; value /= 1e37) {
            parameters p;
            fault f;
            parameters_defaults(&p, ARM_CORRECTED);
            if (info->type == PARAMETER_REAL && info->minimum <= 0) {
                assert_int_not_equal(parameter_set_number(&p, i, value, &f), STATUS_OK);
                assert_non_null(strstr(f.text, "too small"));
            }
        }
    }
    check_refused("motor.inductance", "5e-324 H",
                  "too small to be computed with, expected 0 or at least 1e-100 H");
}

TEST(an_endless_value_is_refused)
{
    char *text = repeated('1', 4095);
    check_refused("arm.k2", text, "127");
    check_refused("control.plugin", text, "127");

    // 127 characters are no more than 127, blanks around them not counted
    parameters p = fresh(ARM_CORRECTED);
    text = repeated('0', PARAMETER_TEXT_SIZE);
    check_refused("arm.k2", text, "127");
    check_refused("control.plugin", text, "127");
    text = formatted("5.0%s  ", repeated('0', PARAMETER_TEXT_SIZE - 4));
    give(&p, "arm.k2", text);
    check_close(p.arm.k2, 5, 0);
    give(&p, "control.plugin", text);
    assert_int_equal(strlen(p.control.plugin), PARAMETER_TEXT_SIZE - 1);
}

TEST(numbers_are_checked_too)
{
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    int links = PARAMETER_INDEX(arm.links), model = PARAMETER_INDEX(arm.model);
    assert_int_equal(parameter_set_number(&p, links, 2.5, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, (double)NAN, &f),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, (double)INFINITY, &f),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, model, 2, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, 1025, NULL), STATUS_BAD_SCENARIO);
    assert_int_equal(p.set[links], 0);

    // what takes no number says so
    const int plugin = PARAMETER_INDEX(control.plugin),
              list = PARAMETER_INDEX(arm.link_lengths);
    assert_int_equal(parameter_set_number(&p, plugin, 1, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.text, "control.plugin is a text and takes no number");
    assert_int_equal(parameter_set_number(&p, list, 1, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.text, "arm.link_lengths is a list and takes no number");
    assert_string_equal(f.path, "arm.link_lengths");
    assert_int_equal(p.arm.links, 2);
}

// A text is one line: wherever a control character stands in it, it is refused, and
// nothing changes.
TEST(texts_are_lines)
{
    const char *const plain = "a text of one line";
    const int length = (int)strlen(plain), index = parameter_find("control.plugin");
    for (int at = 1; at + 1 < length; at++) {
        static const char characters[] = {'\x01', '\n', '\t', '\x1b', '\x1f', '\x7f'};
        for (size_t i = 0; i < sizeof characters; i++) {
            parameters p = fresh(ARM_CORRECTED), before = p;
            fault f = {0};
            char *text = formatted("%s", plain);
            text[at] = characters[i];
            assert_int_equal(parameter_set_text(&p, index, text, &f),
                             STATUS_BAD_SCENARIO);
            assert_memory_equal(&p, &before, sizeof p);
            assert_non_null(strstr(f.text, "control character"));
        }
    }

    // what is longer than the one before leaves nothing of it
    parameters p = fresh(ARM_CORRECTED), once = p;
    give(&once, "control.plugin", "short");
    give(&p, "control.plugin", plain);
    assert_string_equal(p.control.plugin, plain);
    give(&p, "control.plugin", "short");
    assert_memory_equal(&p, &once, sizeof p);
}

// Every number may be its least and its largest value, nothing beyond, and whole ones no
// other.
TEST(ranges_include_their_ends)
{
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        if (parameter_is_text(info)) {
            continue;
        }
        const bool real = info->type == PARAMETER_REAL;
        const double ends[2] = {info->minimum, info->maximum};
        for (int k = 0; k < 2; k++) {
            parameters p = fresh(ARM_CORRECTED);
            fault f = {0};
            const double away = k == 0 ? -HUGE_VAL : HUGE_VAL;
            const double beyond =
                real ? nextafter(ends[k], away) : ends[k] + (k == 0 ? -1 : 1);
            assert_int_equal(parameter_set_number(&p, i, ends[k], &f), STATUS_OK);
            check_close(parameter_get(&p, i), ends[k], 0);
            assert_int_equal(p.set[i], 1);
            if (isfinite(beyond)) {
                assert_int_equal(parameter_set_number(&p, i, beyond, &f),
                                 STATUS_BAD_SCENARIO);
                assert_string_equal(f.path, info->path);
                assert_non_null(strstr(f.text, "is out of range, expected "));
            }
            if (!real) {
                const double between = ends[k] + (k == 0 ? 0.5 : -0.5);
                assert_int_equal(parameter_set_number(&p, i, between, &f),
                                 STATUS_BAD_SCENARIO);
                assert_non_null(strstr(f.text, "is not a whole number"));
            }
            check_close(parameter_get(&p, i), ends[k], 0);
        }
    }
}

TEST(a_misspelt_path_suggests_the_nearest)
{
    assert_string_equal(parameter_suggest("arm.k22"), "arm.k2");
    assert_string_equal(parameter_suggest("motor.voltag"), "motor.voltage");
    assert_string_equal(parameter_suggest("wall.angel"), "wall.angle");
    assert_string_equal(parameter_suggest("stiction"), "motor.stiction");
    assert_string_equal(parameter_suggest("method.stepp"), "method.step");
    assert_string_equal(parameter_suggest("control.k2_factor"), "belief.k2_factor");
    assert_string_equal(parameter_suggest("control.wall_error"), "belief.wall_error");
    assert_null(parameter_suggest("something.quite.different"));
    assert_null(parameter_suggest(repeated('a', 4999)));
}

TEST(defaults_follow_the_model)
{
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "arm.k2", "49.2");
    give(&p, "arm.model", "printed");
    DONE(parameters_resolve(&p, &f));
    assert_int_equal(p.arm.hub_joint, HUB_SPRING);
    assert_int_equal(p.method.name, METHOD_NEWMARK);
    check_close(p.arm.link_inertia, 1.67e-5, 0);
    check_close(p.arm.k2, 49.2, 0);
    // and back again
    give(&p, "arm.model", "corrected");
    DONE(parameters_resolve(&p, &f));
    assert_int_equal(p.arm.hub_joint, HUB_RIGID);
    assert_int_equal(p.method.name, METHOD_EVENT);
    check_close(p.arm.k2, 49.2, 0);
}

// A uniform rod of mass m and length l has m l^2/12 about its centre.
TEST(a_link_is_a_uniform_rod_unless_told)
{
    static const int links[] = {1, 2, 3, 10, 1024};
    for (EACH(c, links)) {
        parameters p = fresh(ARM_CORRECTED);
        fault f;
        assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.links), *c, &f),
                         STATUS_OK);
        assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
        double n = *c;
        check_relative(p.arm.link_inertia * n * n * n, 0.40108 / 12, 1e-14);
    }
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    give(&p, "arm.link_inertia", "1.67e-5 kg m2");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_close(p.arm.link_inertia, 1.67e-5, 0);
}

// The table of parameters: what every entry has to keep, and how values are read and resolved.
#include "src/quantities/parameters.h"

#include <stdlib.h>
#include <string.h>

#include "tests/check.h"

static parameters fresh(arm_model_kind model)
{
    parameters p;
    parameters_defaults(&p, model);
    return p;
}

// Sets one parameter that has to be accepted.
static void give(parameters *p, const char *path, const char *text)
{
    fault f = {0};
    if (parameter_set_text(p, parameter_find(path), text, &f) != STATUS_OK) {
        fail_msg("%s = %s was refused: %s", path, text, f.text);
    }
}

// The text is refused, nothing changes, and the sentence mentions the path and `expected`.
static void check_refused(const char *path, const char *text, const char *expected)
{
    parameters p = fresh(ARM_CORRECTED), before = p;
    fault f = {0};
    int index = parameter_find(path);
    assert_true(index >= 0);
    if (parameter_set_text(&p, index, text, &f) == STATUS_OK) {
        fail_msg("%s = '%s' was accepted", path, text);
    }
    assert_int_equal(f.code, STATUS_BAD_SCENARIO);
    assert_memory_equal(&p, &before, sizeof p);
    assert_string_equal(f.path, path);
    if (strstr(f.text, path) == NULL || strstr(f.text, expected) == NULL) {
        fail_msg("'%s' does not mention %s and '%s'", f.text, path, expected);
    }
}

static void every_path_is_unique_and_found(void **state)
{
    (void)state;
    for (int i = 0; i < parameter_count; i++) {
        const char *path = parameter_table[i].path;
        assert_int_equal(parameter_find(path), i);
        const char *dot = strchr(path, '.');
        assert_non_null(dot);
        assert_null(strchr(dot + 1, '.'));
    }
    assert_int_equal(parameter_find("arm.k3"), -1);
    assert_int_equal(parameter_find(""), -1);
}

static void every_field_is_a_place_of_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < parameter_count; i++) {
        for (int j = 0; j < i; j++) {
            if (parameter_table[i].offset == parameter_table[j].offset) {
                fail_msg("%s and %s share a field", parameter_table[i].path,
                         parameter_table[j].path);
            }
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

static void every_entry_is_complete(void **state)
{
    (void)state;
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

static void defaults_are_in_range(void **state)
{
    (void)state;
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        double both[] = {info->default_corrected, info->default_printed};
        for (int k = 0; k < 2; k++) {
            bool derived = isnan(both[k]);
            if (!derived && !parameter_is_text(info) &&
                (both[k] < info->minimum || both[k] > info->maximum)) {
                fail_msg("%s: default %g is not in %g to %g", info->path, both[k], info->minimum,
                         info->maximum);
            }
            assert_true(!derived || strcmp(info->path, "arm.link_inertia") == 0 ||
                        strcmp(info->path, "arm.EI") == 0 ||
                        strcmp(info->path, "wall.stiffness") == 0 ||
                        strcmp(info->path, "wall.damping") == 0 ||
                        strcmp(info->path, "motor.transconductance") == 0);
        }
    }
}

// Steps through the range of one parameter; text made of a value reads back as the same value.
static void check_round_trip(int index)
{
    const parameter_info *info = &parameter_table[index];
    bool whole = info->type != PARAMETER_REAL;
    for (int k = 0; k <= 40; k++) {
        double share = k / 40.0;
        double value = info->minimum + (info->maximum - info->minimum) * share * share * share;
        parameters p = fresh(ARM_CORRECTED), q = p;
        fault f = {0};
        char text[64], again[64];
        value = whole ? floor(value) : value;
        assert_int_equal(parameter_set_number(&p, index, value, &f), STATUS_OK);
        check_close(parameter_get(&p, index), value, 0);
        parameter_format(&p, index, text, sizeof text);
        give(&q, info->path, text);
        check_close(parameter_get(&q, index), value, 0);
        parameter_format(&q, index, again, sizeof again);
        assert_string_equal(text, again);
        assert_int_equal(q.set[index], 1);
    }
}

static void text_and_value_go_both_ways(void **state)
{
    (void)state;
    for (int i = 0; i < parameter_count; i++) {
        if (!parameter_is_text(&parameter_table[i])) {
            check_round_trip(i);
        }
    }
}

static void the_own_unit_is_accepted(void **state)
{
    (void)state;
    for (int i = 0; i < parameter_count; i++) {
        const parameter_info *info = &parameter_table[i];
        parameters p = fresh(ARM_PRINTED), q = p;
        char number[64], text[128];
        if (info->unit[0] == '\0' || isnan(parameter_get(&p, i)) || parameter_is_text(info)) {
            continue; // no unit, or a default that follows from others
        }
        parameter_format(&p, i, number, sizeof number);
        snprintf(text, sizeof text, "  %s   %s ", number, info->unit);
        give(&q, info->path, text);
        check_close(parameter_get(&q, i), parameter_get(&p, i), 0);
    }
}

static void notations_of_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = {{"49.2", 49.2}, {"4.92e1", 49.2}, {"+3", 3}, {".5", 0.5}, {"1e-6", 1e-6}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parameters p = fresh(ARM_CORRECTED);
        give(&p, "arm.k2", cases[i].text);
        check_close(p.arm.k2, cases[i].value, 0);
    }
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "motor.voltage", "-2.5 V");
    check_close(p.motor.voltage, -2.5, 0);
}

static void words_for_truth(void **state)
{
    (void)state;
    static const char *const truths[] = {"true", "yes", "on", "1"};
    static const char *const lies[] = {"false", "no", "off", "0"};
    for (int i = 0; i < 4; i++) {
        parameters p = fresh(ARM_PRINTED);
        give(&p, "printed.sign_dead_band", lies[i]);
        assert_false(p.printed.sign_dead_band);
        give(&p, "printed.sign_dead_band", truths[i]);
        assert_true(p.printed.sign_dead_band);
    }
}

static void wrong_values_are_refused(void **state)
{
    (void)state;
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

static void an_endless_value_is_refused(void **state)
{
    (void)state;
    char text[4096];
    memset(text, '1', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    check_refused("arm.k2", text, "127");
    check_refused("control.plugin", text, "127");
}

static void numbers_are_checked_too(void **state)
{
    (void)state;
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    int links = PARAMETER_INDEX(arm.links), model = PARAMETER_INDEX(arm.model);
    assert_int_equal(parameter_set_number(&p, links, 2.5, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, (double)NAN, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, (double)INFINITY, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, model, 2, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(parameter_set_number(&p, links, 1025, NULL), STATUS_BAD_SCENARIO);
    assert_int_equal(p.set[links], 0);

    // what takes no number says so
    const int plugin = PARAMETER_INDEX(control.plugin), list = PARAMETER_INDEX(arm.link_lengths);
    assert_int_equal(parameter_set_number(&p, plugin, 1, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.text, "control.plugin is a text and takes no number");
    assert_int_equal(parameter_set_number(&p, list, 1, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.text, "arm.link_lengths is a list and takes no number");
    assert_string_equal(f.path, "arm.link_lengths");
    assert_int_equal(p.arm.links, 2);
}

// A text is one line: wherever a control character stands in it, it is refused, and nothing
// changes.
static void texts_are_lines(void **state)
{
    (void)state;
    const char *const plain = "a text of one line";
    const int length = (int)strlen(plain), index = parameter_find("control.plugin");
    for (int at = 1; at + 1 < length; at++) {
        static const char characters[] = {'\x01', '\n', '\t', '\x1b', '\x1f', '\x7f'};
        for (size_t i = 0; i < sizeof characters; i++) {
            parameters p = fresh(ARM_CORRECTED), before = p;
            fault f = {0};
            char text[64];
            snprintf(text, sizeof text, "%s", plain);
            text[at] = characters[i];
            assert_int_equal(parameter_set_text(&p, index, text, &f), STATUS_BAD_SCENARIO);
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

// Every number may be its least and its largest value, nothing beyond, and whole ones no other.
static void ranges_include_their_ends(void **state)
{
    (void)state;
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
            const double beyond = real ? nextafter(ends[k], away) : ends[k] + (k == 0 ? -1 : 1);
            assert_int_equal(parameter_set_number(&p, i, ends[k], &f), STATUS_OK);
            check_close(parameter_get(&p, i), ends[k], 0);
            assert_int_equal(p.set[i], 1);
            if (isfinite(beyond)) {
                assert_int_equal(parameter_set_number(&p, i, beyond, &f), STATUS_BAD_SCENARIO);
                assert_string_equal(f.path, info->path);
                assert_non_null(strstr(f.text, "is out of range, expected "));
            }
            if (!real) {
                const double between = ends[k] + (k == 0 ? 0.5 : -0.5);
                assert_int_equal(parameter_set_number(&p, i, between, &f), STATUS_BAD_SCENARIO);
                assert_non_null(strstr(f.text, "is not a whole number"));
            }
            check_close(parameter_get(&p, i), ends[k], 0);
        }
    }
}

static void a_misspelt_path_suggests_the_nearest(void **state)
{
    (void)state;
    assert_string_equal(parameter_suggest("arm.k22"), "arm.k2");
    assert_string_equal(parameter_suggest("motor.voltag"), "motor.voltage");
    assert_string_equal(parameter_suggest("wall.angel"), "wall.angle");
    assert_string_equal(parameter_suggest("stiction"), "motor.stiction");
    assert_string_equal(parameter_suggest("method.stepp"), "method.step");
    assert_string_equal(parameter_suggest("control.k2_factor"), "belief.k2_factor");
    assert_string_equal(parameter_suggest("control.wall_error"), "belief.wall_error");
    assert_null(parameter_suggest("something.quite.different"));
    char endless[5000];
    memset(endless, 'a', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_null(parameter_suggest(endless));
}

static void defaults_follow_the_model(void **state)
{
    (void)state;
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    give(&p, "arm.k2", "49.2");
    give(&p, "arm.model", "printed");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    assert_int_equal(p.arm.hub_joint, HUB_SPRING);
    assert_int_equal(p.method.name, METHOD_NEWMARK);
    check_close(p.arm.link_inertia, 1.67e-5, 0);
    check_close(p.arm.k2, 49.2, 0);
    // and back again
    give(&p, "arm.model", "corrected");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    assert_int_equal(p.arm.hub_joint, HUB_RIGID);
    assert_int_equal(p.method.name, METHOD_EVENT);
    check_close(p.arm.k2, 49.2, 0);
}

// A uniform rod of mass m and length l has m l^2/12 about its centre.
static void a_link_is_a_uniform_rod_unless_told(void **state)
{
    (void)state;
    static const int links[] = {1, 2, 3, 10, 1024};
    for (size_t i = 0; i < sizeof links / sizeof links[0]; i++) {
        parameters p = fresh(ARM_CORRECTED);
        fault f;
        assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.links), links[i], &f),
                         STATUS_OK);
        assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
        double n = links[i];
        check_relative(p.arm.link_inertia * n * n * n, 0.40108 / 12, 1e-14);
    }
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    give(&p, "arm.link_inertia", "1.67e-5 kg m2");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_close(p.arm.link_inertia, 1.67e-5, 0);
}

// The pair of settings cannot be resolved and the sentence says `expected`.
static void check_conflict(const char *first, const char *first_text, const char *second,
                           const char *second_text, const char *expected)
{
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    give(&p, first, first_text);
    give(&p, second, second_text);
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    if (strstr(f.text, expected) == NULL) {
        fail_msg("'%s' does not say '%s'", f.text, expected);
    }
    // to blame is the one that the sentence begins with, of those that were given
    assert_true(strcmp(f.path, first) == 0 || strcmp(f.path, second) == 0);
    assert_non_null(strstr(f.text, f.path));
}

static void impossible_combinations_are_refused(void **state)
{
    (void)state;
    check_conflict("arm.link_inertia", "1e-5", "arm.links", "3", "two links only");
    check_conflict("arm.model", "printed", "arm.links", "3", "two links");
    check_conflict("arm.model", "printed", "arm.hub_joint", "rigid", "hub spring");
    check_conflict("arm.model", "printed", "arm.hub_joint", "beam", "hub spring");
    check_conflict("arm.EI", "2.46", "arm.k2", "4.92", "both given");
    check_conflict("arm.hub_joint", "beam", "arm.k1", "90", "k2 N = 9.84");
    check_conflict("arm.model", "printed", "method.name", "event", "newmark");
    check_conflict("arm.model", "printed", "wall.kind", "plane", "point or none");
    check_conflict("arm.model", "printed", "arm.tip_mass", "0.02", "carries nothing");
    check_conflict("wall.contact", "hunt-crossley", "wall.restitution", "0.5", "rigid");
    check_conflict("wall.contact", "hunt-crossley", "wall.mass", "0.5", "kelvin-voigt");
    check_conflict("wall.contact", "kelvin-voigt", "wall.mass", "1e-12", "at least");
    check_conflict("arm.hub_joint", "beam", "arm.hub_inertia", "0", "nothing to move");
    check_conflict("wall.contact", "kelvin-voigt", "method.name", "newmark", "event only");
    check_conflict("control.delay", "0.02", "control.rate", "100",
                   "longer than the period of 0.01 s");
    check_conflict("control.delay_periods", "0.8", "control.delay", "0.002", "period of 0.005 s");
}

// Two settings that look like a conflict and are none.
static void check_goes_together(const char *const *settings)
{
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    for (int i = 0; settings[i] != NULL; i += 2) {
        give(&p, settings[i], settings[i + 1]);
    }
    if (parameters_resolve(&p, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
}

static void what_only_looks_like_a_conflict_is_none(void **state)
{
    (void)state;
    // a limit that the amplifier holds by itself, a face that bounces
    check_goes_together((const char *const[]){"method.name", "generalized-alpha", "motor.drive",
                                              "current", "motor.current_limit", "5", NULL});
    check_goes_together((const char *const[]){"wall.contact", "kelvin-voigt", "wall.mass", "0.5",
                                              "wall.restitution", "0.5", NULL});

    // and what is given as nothing
    check_goes_together((const char *const[]){"method.name", "generalized-alpha",
                                              "arm.joint_stiffness", "", "arm.stiffening", "0",
                                              NULL});
}

// Of several that contradict one another the first that was given is to blame; defaults are not.
static void defaults_are_never_to_blame(void **state)
{
    (void)state;
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    give(&p, "wall.angle", "-2 rad");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "wall.angle");
    give(&p, "initial.angle", "-1 rad");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "initial.angle");
}

// The bound of what the ledger may lack follows the method, unless it was given.
static void the_ledgers_bound_follows_the_method(void **state)
{
    (void)state;
    static const char *const methods[] = {"event", "newmark", "generalized-alpha"};
    double bound[3];
    for (int i = 0; i < 3; i++) {
        parameters p = fresh(ARM_CORRECTED), own = p, back;
        fault f = {0};
        give(&p, "method.name", methods[i]);
        give(&own, "method.name", methods[i]);
        give(&own, "method.residual_bound", "3e-5");
        back = p;
        assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
        assert_int_equal(parameters_resolve(&own, &f), STATUS_OK);
        bound[i] = p.method.residual_bound;
        check_close(own.method.residual_bound, 3e-5, 0);

        // resolved for one method and then for another it is the other's
        parameters_resolve(&back, &f);
        give(&back, "method.name", "event");
        assert_int_equal(parameters_resolve(&back, &f), STATUS_OK);
        check_close(back.method.residual_bound, bound[0], 0);
    }
    check_close(bound[0],
                parameter_table[parameter_find("method.residual_bound")].default_corrected, 0);
    check_close(bound[1], 1e-2, 0);
    check_close(bound[2], 1e-2, 0);
}

static void resolving_twice_changes_nothing(void **state)
{
    (void)state;
    parameters p = fresh(ARM_CORRECTED);
    fault f;
    give(&p, "arm.links", "7");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    parameters once = p;
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    assert_memory_equal(&p, &once, sizeof p);
}

// What a combination of settings is resolved to: accepted, or refused for one of them.
static void conditions_hold_up_to_their_limits(void **state)
{
    (void)state;
    static const struct {
        const char *settings[4]; // path=value
        const char *blamed;      // NULL: accepted
    } cases[] = {
        // faces that are none
        {{"wall.contact=kelvin-voigt", "wall.mass=0"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.mass=1e-9"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.mass=0.999e-9"}, "wall.mass"},
        {{"wall.contact=hunt-crossley", "wall.mass=0"}, NULL},
        {{"wall.contact=rigid", "wall.mass=0.1"}, "wall.mass"},
        {{"wall.contact=hunt-crossley", "wall.mass=0.1"}, "wall.mass"},

        // restitution is of what has a mass to be thrown back
        {{"wall.contact=rigid", "wall.restitution=0.5"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.restitution=0.5"}, "wall.restitution"},
        {{"wall.contact=kelvin-voigt", "wall.restitution=0.5", "wall.mass=0.1"}, NULL},
        {{"wall.contact=rigid", "method.name=newmark"}, NULL},
        {{"wall.contact=hunt-crossley", "method.name=newmark"}, "wall.contact"},

        // delays and jitter as long as the period allows, and beyond
        {{"control.rate=100", "control.delay=0.01"}, NULL},
        {{"control.rate=100", "control.delay=0.0101"}, "control.delay"},
        {{"control.rate=64", "control.delay=0.0078125", "control.delay_periods=0.5"}, NULL},
        {{"control.rate=64", "control.delay=0.0078125", "control.delay_periods=0.51"},
         "control.delay_periods"},
        {{"control.delay_periods=1"}, NULL},
        {{"control.rate=64", "control.jitter=0.0078125"}, NULL},
        {{"control.rate=64", "control.jitter=0.00782"}, "control.jitter"},

        // a sensor that is asked for is there, unless it was left out
        {{"control.impact_angle=film"}, NULL},
        {{"control.impact_angle=film", "sensor.film=true"}, NULL},
        {{"control.impact_angle=film", "sensor.film=false"}, "control.impact_angle"},
        {{"sensor.film=false"}, NULL},
        {{"control.impact_angle=accelerometer"}, NULL},
        {{"control.impact_angle=accelerometer", "sensor.accelerometer=false"},
         "control.impact_angle"},
        {{"control.impact_angle=accelerometer", "sensor.film=false"}, NULL},
        {{"sensor.force=piezo"}, NULL},
        {{"sensor.force=piezo", "sensor.piezo=false"}, "sensor.force"},
        {{"sensor.piezo=false"}, NULL},

        // a band-pass has its edges in order
        {{"sensor.piezo_leak_time=1e-3", "sensor.piezo_rise_time=1e-3"}, NULL},
        {{"sensor.piezo_leak_time=0.99e-3", "sensor.piezo_rise_time=1e-3"},
         "sensor.piezo_leak_time"},
        {{"sensor.piezo_leak_time=0", "sensor.piezo_rise_time=1e-3"}, NULL},

        // motors
        {{"motor.inductance=1e-3"}, NULL},
        {{"motor.inductance=1e-3", "method.name=newmark"}, "motor.inductance"},
        {{"motor.inductance=1e-3", "motor.drive=current"}, "motor.inductance"},
        {{"motor.current_limit=2", "method.name=newmark"}, "motor.current_limit"},
        {{"motor.current_limit=2", "motor.drive=current", "method.name=newmark"}, NULL},
        {{"motor.current_limit=2"}, NULL},
        {{"motor.transconductance=1", "motor.drive=current"}, NULL},
        {{"motor.transconductance=1"}, "motor.transconductance"},

        // laws that are found elsewhere
        {{"control.law=plugin"}, "control.law"},
        {{"control.law=plugin", "control.plugin=x.so"}, NULL},
        {{"control.law=process"}, "control.law"},
        {{"control.law=process", "control.command=x"}, NULL},
        {{"control.plugin=x.so", "control.command=x"}, NULL},

        // the printed arm
        {{"arm.model=printed"}, NULL},
        {{"arm.model=printed", "wall.kind=none"}, NULL},
        {{"arm.model=printed", "arm.links=1"}, "arm.links"},
        {{"arm.model=printed", "method.name=generalized-alpha"}, "method.name"},
        {{"arm.model=printed", "arm.hub_joint=spring"}, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parameters p = fresh(ARM_CORRECTED);
        fault f = {0};
        for (int k = 0; k < 4 && cases[i].settings[k] != NULL; k++) {
            char path[64];
            const char *equals = strchr(cases[i].settings[k], '=');
            snprintf(path, sizeof path, "%.*s", (int)(equals - cases[i].settings[k]),
                     cases[i].settings[k]);
            give(&p, path, equals + 1);
        }
        const status code = parameters_resolve(&p, &f);
        if ((code == STATUS_OK) != (cases[i].blamed == NULL) ||
            (cases[i].blamed != NULL && strcmp(f.path, cases[i].blamed) != 0)) {
            fail_msg("case %zu, %s ...: %s %s", i, cases[i].settings[0], f.path, f.text);
        }
    }
}

// What nobody gave follows from the rest.
static void walls_motors_and_sensors_follow_what_was_given(void **state)
{
    (void)state;
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    give(&p, "motor.amplifier_gain", "3");
    give(&p, "motor.resistance", "4");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_close(p.motor.transconductance, 0.75, 0);
    assert_false(p.sensor.film || p.sensor.accelerometer || p.sensor.piezo);

    // damping of a Hunt-Crossley wall is 3/2 of its loss times its stiffness
    give(&p, "wall.contact", "hunt-crossley");
    give(&p, "wall.stiffness", "2e5");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_relative(p.wall.damping, 0.3 * 2e5, 1e-15);
    p = fresh(ARM_CORRECTED);
    give(&p, "wall.contact", "hunt-crossley");
    give(&p, "wall.damping", "7");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_close(p.wall.stiffness, 1e6, 0);
    check_close(p.wall.damping, 7, 0);
    p = fresh(ARM_CORRECTED);
    give(&p, "wall.contact", "kelvin-voigt");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
    check_close(p.wall.stiffness, 75e3, 0);
    check_close(p.wall.damping, 20, 0);

    // what a law or a signal is taken from is there
    static const char *const asked[][2] = {{"control.impact_angle", "film"},
                                           {"control.impact_angle", "accelerometer"},
                                           {"sensor.force", "piezo"}};
    for (int i = 0; i < 3; i++) {
        p = fresh(ARM_CORRECTED);
        give(&p, asked[i][0], asked[i][1]);
        assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
        assert_int_equal(p.sensor.film, i == 0);
        assert_int_equal(p.sensor.accelerometer, i == 1);
        assert_int_equal(p.sensor.piezo, i == 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_path_is_unique_and_found),
        cmocka_unit_test(every_field_is_a_place_of_its_own),
        cmocka_unit_test(every_entry_is_complete),
        cmocka_unit_test(defaults_are_in_range),
        cmocka_unit_test(text_and_value_go_both_ways),
        cmocka_unit_test(the_own_unit_is_accepted),
        cmocka_unit_test(notations_of_numbers),
        cmocka_unit_test(words_for_truth),
        cmocka_unit_test(wrong_values_are_refused),
        cmocka_unit_test(an_endless_value_is_refused),
        cmocka_unit_test(numbers_are_checked_too),
        cmocka_unit_test(ranges_include_their_ends),
        cmocka_unit_test(texts_are_lines),
        cmocka_unit_test(a_misspelt_path_suggests_the_nearest),
        cmocka_unit_test(defaults_follow_the_model),
        cmocka_unit_test(a_link_is_a_uniform_rod_unless_told),
        cmocka_unit_test(impossible_combinations_are_refused),
        cmocka_unit_test(what_only_looks_like_a_conflict_is_none),
        cmocka_unit_test(conditions_hold_up_to_their_limits),
        cmocka_unit_test(walls_motors_and_sensors_follow_what_was_given),
        cmocka_unit_test(defaults_are_never_to_blame),
        cmocka_unit_test(the_ledgers_bound_follows_the_method),
        cmocka_unit_test(resolving_twice_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

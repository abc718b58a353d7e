// The look-up table of (5.26): reading, interpolating and measuring it, and its benefit.
#include "src/study/calibrate.h"
#include "tests/rig_fixture.h"

static const double commands[] = {1.125, 2.25, 4.5, 6.75};
enum { COMMANDS = 4 };

static calibration calibrated(const char *const *settings)
{
    calibration c;
    scenario s = {.parameters = rig_parameters(settings)};
    DONE(calibrate(&s, commands, COMMANDS, NULL, &c, &f));
    assert_int_equal(c.count, COMMANDS);
    return c;
}

// "control.k2_table=..." as --set takes it.
static void table_setting(const calibration *c, char *text, size_t size)
{
    k2_table t;
    size_t length = (size_t)snprintf(text, size, "control.k2_table=");
    DONE(calibration_table(c, &t, &f));
    assert_true(k2_table_write(&t, text + length, size - length));
}

// --- the table -------------------------------------------------------------------------

TEST(wrong_tables_are_refused)
{
    const struct {
        const char *text, *sentence;
    } cases[] = {{"1", "'1' is wrong"},
                 {"1:0", "'1:0' is wrong"},
                 {"-1:2", "'-1:2' is wrong"},
                 {"1:2 soft", "'soft' is wrong"},
                 {"1:2,3:4", "',3:4' is wrong"},
                 {"1:1e999", "'1:1e999' is wrong"},
                 {"2:4 1:4", "'1:4' is not above the one before"}};
    for (EACH(c, cases)) {
        k2_table t;
        scenario s = {.parameters = rig_parameters(NULL)};
        REFUSED(STATUS_BAD_SCENARIO, c->sentence, k2_table_read(&t, c->text, &f));
        REFUSED(STATUS_BAD_SCENARIO, c->sentence,
                scenario_override(&s, formatted("control.k2_table=%s", c->text), &f));
    }
}

TEST(the_commanded_force_chooses_the_entry)
{
    // (5.23) with the K2 of the table: the angle that the hybrid law goes to
    const char *const table = "control.k2_table=0.5:2 1.5:4";
    const char *const forces[] = {"control.force=0.25", "control.force=1",
                                  "control.force=2"};
    const double wanted[] = {0.25 * 0.5 / (2 * 2), 0.5 / (2 * 3), 2 * 0.5 / (2 * 4)};
    for (int i = 0; i < 3; i++) {
        for (int doubted = 0; doubted < 2; doubted++) {
            KEPT_RUN(r) =
                rig_run(SETTINGS("control.law=hybrid", table, forces[i],
                                 doubted ? "belief.k2_factor=2" : "belief.k2_factor=1"),
                        true);
            double angle = LAST_ROW(&r.trace)->desired_angle;
            check_close(angle, wanted[i] / (doubted ? 2 : 1), 1e-12);
        }
    }
}

// --- measuring -------------------------------------------------------------------------

TEST(two_links_have_the_stiffness_of_their_joint)
{
    calibration ideal = calibrated(SETTINGS("sensor.ideal=true", "control.law=hybrid"));
    calibration noisy = calibrated(SETTINGS("control.law=hybrid"));
    for (int i = 0; i < COMMANDS; i++) {
        const calibration_point *p = &ideal.points[i], *n = &noisy.points[i];
        // the joint's moment k2 (x - y) is that of the force at the contact point, d from
        // the joint
        double x = p->angle, y = -atan2(sin(x), 2 - cos(x)),
               d = 0.5 * sqrt(5 - 4 * cos(x));
        check_relative(p->k2, 4.92 * (x - y) / d * 0.5 / (2 * x), 1e-6);
        // half a count of the encoder, and the mean of 400 readings of the force
        double count = 3.1416 / 8000 / p->angle,
               noise = 3 * n->force_spread / sqrt(400) / n->force;
        check_relative(n->k2, p->k2, count + noise + 1e-3);
        check_below(fabs(p->drift), 1e-5);
        // the motor's torque over two levers, but for what friction holds
        check_close(p->force, 0.4377 * commands[i], 0.05 + 0.03 * p->force);
    }
}

TEST(a_spring_at_the_hub_is_measured_with_the_beam)
{
    // the encoder sits before it: 1/K2 = 1/k2 + 4/k1
    calibration c = calibrated(SETTINGS("sensor.ideal=true", "arm.hub_joint=spring",
                                        "arm.k1=90", "control.law=hybrid"));
    check_relative(c.points[0].k2, 1 / (1 / 4.92 + 4.0 / 90), 0.005);
}

// Where friction holds the hub is one thing under a press that comes gently and another
// one behind an impact; force and angle then differ together, their ratio does not.
TEST(stiction_does_not_spoil_the_ratio)
{
    double force[3], k2[3];
    const char *const starts[] = {"initial.angle=0", "initial.angle=-0.1",
                                  "initial.angle=-0.3"};
    for (int i = 0; i < 3; i++) {
        KEPT_RUN(r) =
            rig_run(SETTINGS("control.law=open-loop", "sensor.ideal=true", starts[i],
                             "control.approach_voltage=2.25", "run.duration=6"),
                    true);
        const sample *last = LAST_ROW(&r.trace);
        force[i] = last->force_reading;
        k2[i] = last->force_reading * 0.5 / (2 * last->encoder);
    }
    double low = fmin(force[0], fmin(force[1], force[2]));
    double high = fmax(force[0], fmax(force[1], force[2]));
    check_below(0.02, high / low - 1);
    check_relative(k2[1], k2[0], 2e-3);
    check_relative(k2[2], k2[0], 2e-3);
}

// Where the calibrated table is believed, the force at rest is the commanded one but for
// what friction holds; without it the arm of twelve links presses a third too softly.
static void many_links_press_as_commanded_with_their_table(void **state)
{
    (void)state;
    // (the recovering law takes the ringing of twelve links for lost contact)
    const char *const laws[] = {"control.law=hybrid", "control.law=reverse-torque",
                                "control.law=speed-limit", "control.law=bang-bang"};
    for (EACH_TEXT(each, "sensor.ideal=true", "sensor.ideal=false")) {
        char table[PARAMETER_TEXT_SIZE + 32];
        calibration c = calibrated(SETTINGS("arm.links=12", *each, "control.law=hybrid"));
        table_setting(&c, table, sizeof table);
        for (int k = 0; k < 4; k++) {
            for (int force = k == 0 ? 1 : 2; force <= (k == 0 ? 3 : 2); force++) {
                summary with = rig_summary(SETTINGS("arm.links=12", *each, laws[k], table,
                                                    formatted("control.force=%d", force),
                                                    "run.duration=5"));
                check_close(with.steady_force_N, force, 0.03 * force);
            }
        }
        summary without = rig_summary(
            SETTINGS("arm.links=12", *each, "control.law=hybrid", "run.duration=5"));
        check_below(without.steady_force_N, 0.75);
    }
}

TEST(what_does_not_press_is_said)
{
    const struct {
        const char *setting, *sentence;
    } cases[] = {{"wall.kind=none", "nothing to press against"},
                 {"belief.wall_error=0.3", "does not press"},
                 {"motor.stiction=3", "does not press"}};
    for (size_t i = 0; i < 3; i++) {
        fault f;
        calibration c;
        scenario s = {.parameters = rig_parameters(SETTINGS(cases[i].setting))};
        assert_int_not_equal(calibrate(&s, commands, COMMANDS, NULL, &c, &f), STATUS_OK);
        assert_non_null(strstr(f.text, cases[i].sentence));
    }
    k2_table t;
    calibration alike = {.count = 2,
                         .points = {{.force = 1, .k2 = 5}, {.force = 1.001, .k2 = 5}}};
    REFUSED(STATUS_BAD_ARGUMENT, "press alike", calibration_table(&alike, &t, &f));
}

TEST(results_reach_every_form)
{
    calibration c = {
        .count = 2,
        .points = {
            {.command = 2, .force = 1.5, .angle = 0.05, .k2 = 4.5},
            {.command = 1, .force = 0.5, .angle = 0.02, .k2 = 4.92, .k2_over_arm = 1}}};
    char setting[PARAMETER_TEXT_SIZE + 32];
    table_setting(&c, setting, sizeof setting);
    assert_string_equal(setting, "control.k2_table=0.5:4.92 1.5:4.5");
    SCOPED(free_kept) WRITTEN(csv, calibration_csv(stream, &c));
    assert_non_null(
        strstr(csv, "command[V],force[N],hub_angle[rad],k2[N m/rad],k2_over_arm[],"));
    assert_non_null(strstr(csv, "\n1,0.5,0.02,4.92,1,"));
    json_t *whole = calibration_json(&c, "arm", "0.5:4.92 1.5:4.5");
    json_t *first = json_array_get(json_object_get(whole, "points"), 0);
    check_close(json_number_value(json_object_get(first, "k2_Nm_per_rad")), 4.5, 0);
    assert_string_equal(json_string_value(json_object_get(whole, "k2_table")),
                        "0.5:4.92 1.5:4.5");
    json_decref(whole);
}

// With an argument the case that takes most of the time, without one the others. The arm
// is pressed with a voltage: the settings of the scenario for its own law, and the mode
// that it holds it in, are none of that.
TEST(what_another_law_is_told_changes_nothing)
{
    static const char *const told[][2] = {{"control.law=observer",
                                           "control.settings=wall_doubt=0"},
                                          {"control.law=hybrid", "control.lock=force"}};
    const calibration plain = calibrated(SETTINGS("control.law=hybrid"));
    for (int i = 0; i < 2; i++) {
        const calibration c = calibrated(SETTINGS(told[i][0], told[i][1]));
        for (int k = 0; k < COMMANDS; k++) {
            check_close(c.points[k].k2, plain.points[k].k2, 0);
        }
    }
}

int main(int argc, char **argv)
{
    (void)argv;
    const struct CMUnitTest longest[] = {
        cmocka_unit_test(many_links_press_as_commanded_with_their_table),
    };
    return (argc > 1 ? cmocka_run_group_tests(longest, NULL, NULL)
                     : run_cases(NULL, NULL)) != 0;
}

// Sensors and converters against their data, and the sampled loop.
#include <string.h>

#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

#define PI 3.14159265358979323846

static sensors fresh_sensors(const char *const *settings, int seed)
{
    sensors s;
    parameters p = rig_parameters(settings);
    sensors_init(&s, &p.sensor, seed);
    return s;
}

static sensor_reading read_hub(sensors *s, double angle, double velocity, double force)
{
    return sensors_read(s, &(sensed_motion){.angle = angle, .velocity = velocity, .force = force});
}

// A stride of the force alone.
static void follow_force(sensors *s, double h, double first, double last, double mean)
{
    sensors_follow(s, h, &(sensed_motion){.force = first}, &(sensed_motion){.force = last}, mean);
}

static void encoder_steps_by_one_count(void **state)
{
    (void)state;
    sensors s = fresh_sensors(SETTINGS("sensor.encoder_counts=500"), 1);
    const double count = 2 * PI / 500;
    double last = read_hub(&s, -0.1, 0, 0).encoder;
    int steps = 0;
    for (double angle = -0.1; angle < 0.1; angle += count / 50) {
        double read = read_hub(&s, angle, 0, 0).encoder;
        check_close(read, angle, count / 2 * (1 + 1e-9));
        check_close(read / count, round(read / count), 1e-9);
        if (read != last) {
            check_close(read - last, count, 1e-12);
            steps++;
        }
        last = read;
    }
    assert_in_range(steps, 15, 16); // 0.2 rad of 500 counts a revolution
}

static void converter_has_its_bits_and_range(void **state)
{
    (void)state;
    const double step = 20.0 / 4096;
    check_close(converter_value(0.4 * step, 12, 10), 0, 0);
    check_close(converter_value(0.6 * step, 12, 10), step, 1e-15);
    check_close(converter_value(3, 12, 10), round(3 / step) * step, 1e-12);
    check_close(converter_value(25, 12, 10), 10 - step, 1e-12);
    check_close(converter_value(-25, 12, 10), -10, 0);
    check_close(converter_value(1.23456789, 0, 10), 1.23456789, 0);
    check_close(converter_value(25, 0, 10), 10, 0);
}

// Time at which the lagged force crosses a level after a step of 1 N.
static double rise_to(double level)
{
    sensors s = fresh_sensors(NULL, 1);
    const double h = 1e-6;
    double t = 0;
    for (; s.fsr.value < level && t < 1; t += h) {
        follow_force(&s, h, 1, 1, 1);
    }
    return t;
}

static void force_sensor_rises_in_its_time(void **state)
{
    (void)state;
    check_close(rise_to(0.9) - rise_to(0.1), 1.5e-3, 4e-6);
}

static void force_sensor_follows_a_stride_exactly(void **state)
{
    (void)state;
    // f = 2 - 3 u + 5 u^2 over 4 ms, at once and in a thousand short strides
    const double h = 4e-3;
    sensors once = fresh_sensors(NULL, 1), often = once;
    once.fsr.value = often.fsr.value = 0.7;
    follow_force(&once, h, 2, 4, 2 - 1.5 + 5.0 / 3);
    for (int i = 0; i < 1000; i++) {
        double a = i / 1000.0, b = (i + 1) / 1000.0;
        double mean = 2 - 1.5 * (a + b) + 5.0 / 3 * (a * a + a * b + b * b);
        follow_force(&often, h / 1000, 2 - 3 * a + 5 * a * a, 2 - 3 * b + 5 * b * b, mean);
    }
    check_close(once.fsr.value, often.fsr.value, 1e-9);
    // a stride of no length changes nothing
    double before = once.fsr.value;
    follow_force(&once, 1e-17, 1, 3, 1e9);
    check_close(once.fsr.value, before, 1e-4);
}

static void impulse_arrives_whole(void **state)
{
    (void)state;
    sensors s = fresh_sensors(NULL, 1);
    double arrived = 0;
    const double h = 1e-6, impulse = 0.02;
    sensors_strike(&s, impulse);
    for (int i = 0; i < 20000; i++) {
        double before = s.fsr.value;
        follow_force(&s, h, 0, 0, 0);
        arrived += h * (before + s.fsr.value) / 2;
    }
    check_relative(arrived, impulse, 1e-4);
}

static void divider_follows_the_power_law(void **state)
{
    (void)state;
    parameters p = rig_parameters(NULL);
    // half the supply where the sensor has the measuring resistor's 40 kohm: 30 kohm f^-0.75
    double force = pow(40.0 / 30, -1 / 0.75);
    check_close(fsr_volts(&p.sensor, force), 5, 1e-12);
    check_close(fsr_volts(&p.sensor, 1), 10 * 40.0 / 70, 1e-12);
    check_close(fsr_volts(&p.sensor, 0), 0, 0);
    check_close(fsr_volts(&p.sensor, 50), fsr_volts(&p.sensor, 10), 0);
    for (double f = 0.01; f < 10; f *= 1.3) {
        check_relative(fsr_force(&p.sensor, fsr_volts(&p.sensor, f)), f, 1e-12);
    }
    check_close(fsr_force(&p.sensor, 11), 10, 0);
    check_close(fsr_force(&p.sensor, -0.1), 0, 0);
}

static void noise_has_its_spread_and_follows_its_seed(void **state)
{
    (void)state;
    const char *const *quiet = SETTINGS("sensor.tachometer_ripple=0", "sensor.adc_bits=0");
    sensors s = fresh_sensors(quiet, 7), twin = fresh_sensors(quiet, 7);
    sensors other = fresh_sensors(quiet, 8);
    double sum = 0, squares = 0;
    const int count = 40000;
    int same = 0;
    for (int i = 0; i < count; i++) {
        double v = read_hub(&s, 0, 0.5, 1).tachometer - 0.5;
        assert_true(read_hub(&twin, 0, 0.5, 1).tachometer - 0.5 == v);
        same += read_hub(&other, 0, 0.5, 1).tachometer - 0.5 == v;
        sum += v;
        squares += v * v;
    }
    // 10 mV at 2 V s/rad
    check_relative(sqrt(squares / count), 0.005, 0.02);
    check_close(sum / count, 0, 0.0001);
    assert_true(same < 10);
}

static void ripple_follows_the_shaft(void **state)
{
    (void)state;
    sensors s = fresh_sensors(
        SETTINGS("sensor.tachometer_noise=0", "sensor.adc_bits=0", "sensor.tachometer_ripple=0.05"),
        1);
    check_close(read_hub(&s, 0.5 * PI / 79, 2, 0).tachometer, 2.1, 1e-9);
    check_close(read_hub(&s, 1.5 * PI / 79, 2, 0).tachometer, 1.9, 1e-9);
}

static void ideal_sensors_tell_the_truth(void **state)
{
    (void)state;
    sensors s = fresh_sensors(SETTINGS("sensor.ideal=true"), 1);
    sensor_reading r = read_hub(&s, 0.1234567, -1.2345678, 3.456789);
    check_close(r.encoder, 0.1234567, 0);
    check_close(r.tachometer, -1.2345678, 1e-12);
    check_close(r.force_reading, 3.456789, 1e-12);
}

// --- the loop -------------------------------------------------------------------------------

static void command_holds_between_samples(void **state)
{
    (void)state;
    run_result r = rig_run(SETTINGS("control.law=hybrid"), true);
    const trace *t = &r.trace;
    int changes = 0;
    for (size_t i = 1; i < t->row_count; i++) {
        const sample *row = &t->rows[i];
        check_close(row->voltage, row->command, 0.5 * 20 / 4096 * (1 + 1e-9));
        if (row->voltage != row[-1].voltage) {
            changes++;
            check_close(row->time * 200, round(row->time * 200), 1e-6);
        }
    }
    assert_true(changes > 50);
    run_finish(&r);
}

static void delay_shifts_the_command(void **state)
{
    (void)state;
    run_result r = rig_run(SETTINGS("control.law=hybrid", "control.delay=0.002"), true);
    const trace *t = &r.trace;
    for (size_t i = 1; i < t->row_count; i++) {
        if (t->rows[i].voltage != t->rows[i - 1].voltage) {
            double since = t->rows[i].time * 200;
            check_close(since - floor(since), 0.002 * 200, 1e-6);
        }
    }
    run_finish(&r);
}

// A program that takes a whole period to compute: its command goes out with the next sample, also
// where jitter brings that one early.
static void a_command_a_period_late_goes_out_with_the_next_sample(void **state)
{
    (void)state;
    const char *const jitters[] = {"control.jitter=0", "control.jitter=0.002"};
    for (int k = 0; k < 2; k++) {
        rig *r;
        fault f;
        bool changed;
        double latest = 0;
        parameters p = rig_parameters(SETTINGS("control.law=force-pd", "control.delay_periods=1",
                                               jitters[k], "sensor.ideal=true"));
        assert_int_equal(rig_create(&r, &p, &f), STATUS_OK);
        for (int i = 0; i < 300; i++) {
            // forces that never repeat, so that every command is another one
            sensed_motion now = {.force = 0.5 + 0.003 * i};
            long samples = r->samples;
            assert_int_equal(rig_act(r, rig_next_time(r), &now, &changed, &f), STATUS_OK);
            if (r->samples == samples) {
                continue; // only a command took effect
            }
            assert_true(r->voltage == latest || samples == 0);
            assert_true(r->pending != r->voltage);
            latest = r->pending;
        }
        rig_destroy(r);
    }
}

static void a_delay_is_at_most_a_period(void **state)
{
    (void)state;
    fault f;
    scenario s = {.parameters = rig_parameters(SETTINGS("control.delay=0.003"))};
    assert_int_equal(scenario_override(&s, "control.delay_periods=0.4", &f), STATUS_OK);
    assert_int_equal(scenario_override(&s, "control.delay_periods=0.5", &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "together longer than the period of 0.005 s"));
}

static void jitter_stays_within_its_width(void **state)
{
    (void)state;
    rig *r;
    fault f;
    bool changed;
    double widest = 0;
    parameters p = rig_parameters(SETTINGS("control.law=open-loop", "control.jitter=0.001"));
    assert_int_equal(rig_create(&r, &p, &f), STATUS_OK);
    for (int i = 0; i < 500; i++) {
        double time = rig_next_time(r), off = time - i * 0.005;
        check_below(fabs(off), 0.0005 + 1e-12);
        widest = fmax(widest, fabs(off));
        assert_int_equal(rig_act(r, time, &(sensed_motion){0}, &changed, &f), STATUS_OK);
        assert_int_equal(changed, i == 0);
    }
    check_below(0.00045, widest);
    rig_destroy(r);
}

static void rig_changes_the_bare_arm_only_by_its_converter(void **state)
{
    (void)state;
    summary bare = rig_summary(SETTINGS("control.law=none"));
    summary on = rig_summary(SETTINGS("control.law=open-loop", "sensor.ideal=true"));
    check_close(on.first_contact_s, bare.first_contact_s, 1e-9);
    check_relative(on.peak_force_N, bare.peak_force_N, 1e-6);
    check_close(on.impacts, bare.impacts, 0);
    // and what the amplifier feeds in is at least the motor's mechanical work
    check_below(on.motor_work_J, on.electrical_energy_J);
    assert_true(isnan(bare.force_command_N));
}

static void same_seed_same_bytes(void **state)
{
    (void)state;
    run_result a = rig_run(SETTINGS("control.law=optimal", "control.jitter=0.0005"), true);
    run_result b = rig_run(SETTINGS("control.law=optimal", "control.jitter=0.0005"), true);
    run_result c =
        rig_run(SETTINGS("control.law=optimal", "control.jitter=0.0005", "control.seed=2"), true);
    assert_int_equal(a.trace.row_count, b.trace.row_count);
    assert_memory_equal(a.trace.rows, b.trace.rows, a.trace.row_count * sizeof(sample));
    assert_true(a.summary.peak_force_N != c.summary.peak_force_N);
    run_finish(&a);
    run_finish(&b);
    run_finish(&c);
}

// A beam of twelve links bends further at the hub than two links with the same k2: the stiffness
// that the controller has to believe in, (5.26), is the one measured there.
static void many_links_want_their_own_stiffness(void **state)
{
    (void)state;
    run_result r =
        rig_run(SETTINGS("control.law=open-loop", "arm.links=12", "run.duration=4"), true);
    const sample *last = &r.trace.rows[r.trace.row_count - 1];
    double measured = last->force * 0.5 / (2 * last->first_angle);
    char factor[64];
    run_finish(&r);
    snprintf(factor, sizeof factor, "control.k2_factor=%.6g", measured / 4.92);
    summary nominal =
        rig_summary(SETTINGS("control.law=hybrid", "arm.links=12", "run.duration=2.5"));
    summary looked_up =
        rig_summary(SETTINGS("control.law=hybrid", "arm.links=12", factor, "run.duration=2.5"));
    check_below(nominal.steady_force_N, 0.8);
    check_close(looked_up.steady_force_N, 1, 0.12); // it still swings a little
}

// --- plug-ins -------------------------------------------------------------------------------

static const char *soft_push_file, *broken_file, *outdated_file;

static const char *plugin_setting(char *text, size_t size, const char *file)
{
    snprintf(text, size, "control.plugin=%s", file);
    return text;
}

static void plugin_controls_the_arm(void **state)
{
    (void)state;
    char file[160];
    plugin_setting(file, sizeof file, soft_push_file);
    summary s = rig_summary(SETTINGS("control.law=plugin", file, "control.force=1.5"));
    check_close(s.separations, 0, 0);
    check_relative(s.steady_force_N, 1.5, 0.06);
    summary slow = rig_summary(SETTINGS("control.law=plugin", file, "control.force=1.5",
                                        "control.settings=rise_time=0.4 damping=1"));
    check_below(s.settling_time_s, slow.settling_time_s);
}

static void check_refused(const char *const *settings, const char *sentence)
{
    run_result r;
    scenario s = {.parameters = rig_parameters(settings)};
    assert_int_not_equal(run_scenario(&s, false, &r), STATUS_OK);
    if (strstr(r.summary.message, sentence) == NULL) {
        fail_msg("'%s' does not say '%s'", r.summary.message, sentence);
    }
    run_finish(&r);
}

static void wrong_plugins_are_refused(void **state)
{
    (void)state;
    char file[160];
    plugin_setting(file, sizeof file, soft_push_file);
    check_refused(SETTINGS("control.law=plugin", "control.plugin=/nonexistent.so"),
                  "/nonexistent.so");
    check_refused(SETTINGS("control.law=plugin", file, "control.settings=dampin=1"),
                  "did you mean 'damping'?");
    check_refused(SETTINGS("control.law=plugin", file, "control.settings=damping=-1"),
                  "from 0 to 100");
    check_refused(SETTINGS("control.law=plugin", file, "control.lock=force"),
                  "expected none, approach or push");
    check_refused(SETTINGS("control.law=plugin", file, "control.settings=damping"),
                  "damping=NUMBER");
    check_refused(SETTINGS("control.law=plugin", file, "motor.amplifier_gain=0"), "no torque");
    plugin_setting(file, sizeof file, outdated_file);
    check_refused(SETTINGS("control.law=plugin", file), "compile it again");
}

// A stop of the run and a sample that differ by rounding are one instant: a stride between them
// would be too short for an implicit method.
static void instants_apart_by_rounding_are_one(void **state)
{
    (void)state;
    summary s = rig_summary(SETTINGS("control.law=hybrid", "arm.links=12", "wall.kind=plane",
                                     "method.name=newmark", "run.duration=1.5"));
    check_below(0, s.impacts);
}

static void command_that_is_not_finite_stops_the_run(void **state)
{
    (void)state;
    char file[160];
    const char *const models[] = {"arm.model=corrected", "arm.model=printed"};
    for (int i = 0; i < 2; i++) {
        run_result r;
        plugin_setting(file, sizeof file, broken_file);
        scenario s = {.parameters =
                          rig_parameters(SETTINGS("control.law=plugin", file, models[i]))};
        assert_int_equal(run_scenario(&s, true, &r), STATUS_NOT_FINITE);
        assert_non_null(strstr(r.summary.message, "at t = 0.1 s the controller 'broken'"));
        check_close(r.trace.rows[r.trace.row_count - 1].time, 0.1, 0.0011);
        run_finish(&r);
    }
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(encoder_steps_by_one_count),
        cmocka_unit_test(converter_has_its_bits_and_range),
        cmocka_unit_test(force_sensor_rises_in_its_time),
        cmocka_unit_test(force_sensor_follows_a_stride_exactly),
        cmocka_unit_test(impulse_arrives_whole),
        cmocka_unit_test(divider_follows_the_power_law),
        cmocka_unit_test(noise_has_its_spread_and_follows_its_seed),
        cmocka_unit_test(ripple_follows_the_shaft),
        cmocka_unit_test(ideal_sensors_tell_the_truth),
        cmocka_unit_test(command_holds_between_samples),
        cmocka_unit_test(delay_shifts_the_command),
        cmocka_unit_test(a_command_a_period_late_goes_out_with_the_next_sample),
        cmocka_unit_test(a_delay_is_at_most_a_period),
        cmocka_unit_test(jitter_stays_within_its_width),
        cmocka_unit_test(rig_changes_the_bare_arm_only_by_its_converter),
        cmocka_unit_test(same_seed_same_bytes),
        cmocka_unit_test(many_links_want_their_own_stiffness),
        cmocka_unit_test(plugin_controls_the_arm),
        cmocka_unit_test(wrong_plugins_are_refused),
        cmocka_unit_test(instants_apart_by_rounding_are_one),
        cmocka_unit_test(command_that_is_not_finite_stops_the_run),
    };
    if (count != 4) {
        fprintf(stderr, "usage: test_rig SOFT_PUSH.so BROKEN.so OUTDATED.so\n");
        return 2;
    }
    soft_push_file = arguments[1];
    broken_file = arguments[2];
    outdated_file = arguments[3];
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

// The optional sensors, each against its data: piezoelectric force sensor, piezo film
// along the beam, accelerometer on the hub.

#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

#define ALL_FITTED     "sensor.piezo=true sensor.film=true sensor.accelerometer=true"
#define RISE_CONSTANTS 2.1972245773362196 // ln 9: time constants from 10 % to 90 %
#define CONVERTER_STEP (20.0 / 4096)      // [V]

static sensors fresh_sensors(const char *const *settings)
{
    sensors s;
    parameters p = rig_parameters(settings);
    sensors_init(&s, &p.sensor, 1);
    return s;
}

// Lets the arm stay as it is.
static void hold(sensors *s, double h, sensed_motion m)
{
    sensed_motion first = m;
    first.velocity -= m.acceleration * h;
    sensors_follow(s, h, &first, &m, m.force);
}

static double piezo(sensors *s, double force)
{
    return sensors_read(s, &(sensed_motion){.force = force}).piezo_force;
}

static double film(sensors *s, double bending)
{
    return sensors_read(s, &(sensed_motion){.bending = bending}).film;
}

static double accelerometer(sensors *s, double acceleration)
{
    sensed_motion m = {.acceleration = acceleration};
    m.velocity = isnan(s->seen_velocity) ? 0 : s->seen_velocity;
    return sensors_read(s, &m).accelerometer;
}

// --- whether they are there ------------------------------------------------------------

TEST(sensors_not_fitted_read_nothing)
{
    sensors s = fresh_sensors(NULL);
    sensor_reading r = sensors_read(&s, &(sensed_motion){.force = 1, .bending = 1});
    assert_true(isnan(r.piezo_force) && isnan(r.film) && isnan(r.accelerometer));
    assert_false(isnan(r.force_reading));
}

TEST(choice_of_the_piezo_fits_it)
{
    fault f;
    parameters p = rig_parameters_with("sensor.force=piezo");
    assert_true(p.sensor.piezo);
    parameter_set_text(&p, PARAMETER_INDEX(sensor.piezo), "false", &f);
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "sensor.piezo = false"));
    parameter_set_text(&p, PARAMETER_INDEX(sensor.piezo), "true", &f);
    parameter_set_text(&p, PARAMETER_INDEX(sensor.piezo_leak_time), "1e-5", &f);
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "sensor.piezo_leak_time"));
}

// Checks that fitting these sensors, `count` of them, changes no other signal of a run
// under a law that reads none of them.
static void check_unchanged(const char *law, const char *these, size_t count)
{
    RIG_RUN(without, "control.law=%s", law);
    RIG_RUN(with, "control.law=%s %s", law, these);
    assert_int_equal(without.trace.row_count, with.trace.row_count);
    size_t readings = 0; // of each sensor one in every row
    for (size_t row = 0; row < with.trace.row_count; row++) {
        for (int i = 0; i < signal_count; i++) {
            double a = signal_value(&without.trace.rows[row], i);
            double b = signal_value(&with.trace.rows[row], i);
            bool fitted = signal_table[i].needs != 0 && isnan(a) && !isnan(b);
            fail_if(!fitted && memcmp(&a, &b, sizeof a) != 0, "%s: %s differs in row %zu",
                    law, signal_table[i].name, row);
            readings += fitted;
        }
    }
    assert_int_equal(readings, count * with.trace.row_count);
}

TEST(fitting_them_changes_no_other_signal)
{
    for (EACH_TEXT(law, "touch", "hybrid", "recovering", "force-pd", "force-integral",
                   "impedance", "admittance")) {
        check_unchanged(*law, ALL_FITTED, 3);
    }
    check_unchanged("observer", "sensor.piezo=true sensor.film=true", 2);
}

TEST(ideal_sensors_tell_the_truth)
{
    sensors s = fresh_sensors(given("sensor.ideal=true " ALL_FITTED));
    sensed_motion m = {.acceleration = -1234.567, .bending = 2.345678, .force = 98.7654};
    sensors_strike(&s, 0.1);
    hold(&s, 3, m);
    m.velocity += 1;
    sensor_reading r = sensors_read(&s, &m);
    check_relative(r.piezo_force, 98.7654, 1e-14);
    check_relative(r.film, 2.345678, 1e-14);
    check_relative(r.accelerometer, -1234.567, 1e-14);
}

// --- converter, range, noise -----------------------------------------------------------

// Checks that a reading goes up in whole steps of the converter, read back through the
// gain.
static void check_steps(double (*read)(sensors *, double), sensors *s, double gain)
{
    const double step = CONVERTER_STEP / gain;
    double last = read(s, 0);
    int steps = 0;
    for (int i = 0; i <= 400; i++) {
        double truth = i * step / 40, reading = read(s, truth);
        check_close(reading, truth, step / 2 * (1 + 1e-9));
        check_close(reading / step, round(reading / step), 1e-9);
        steps += reading != last;
        last = reading;
    }
    assert_int_equal(steps, 10);
}

TEST(readings_have_the_steps_of_the_converter)
{
    sensors s = fresh_sensors(
        given(ALL_FITTED " sensor.piezo_noise=0 sensor.film_noise=0 "
                         "sensor.accelerometer_noise=0 sensor.piezo_rise_time=0 "
                         "sensor.accelerometer_rise_time=0"));
    check_steps(piezo, &s, 1);
    check_steps(film, &s, 10);
    check_steps(accelerometer, &s, 0.02);
}

TEST(sensors_go_off_scale)
{
    sensors s = fresh_sensors(
        given(ALL_FITTED " sensor.piezo_noise=0 sensor.film_noise=0 "
                         "sensor.accelerometer_noise=0 sensor.piezo_rise_time=0 "
                         "sensor.adc_bits=0 sensor.accelerometer_rise_time=0 "
                         "sensor.piezo_range=8 sensor.accelerometer_range=400"));
    check_close(piezo(&s, 9), 8, 1e-12);
    check_close(piezo(&s, -9), -8, 1e-12);
    check_close(piezo(&s, 7.9), 7.9, 1e-12);
    check_close(accelerometer(&s, 401), 400, 1e-12);
    check_close(accelerometer(&s, -401), -400, 1e-12);
    check_close(film(&s, 1.5), 1, 1e-12); // 10 V/rad: where the converter ends
    sensors wide = fresh_sensors(
        given(ALL_FITTED " sensor.adc_range=1000 sensor.piezo_noise=0 sensor.adc_bits=0 "
                         "sensor.accelerometer_noise=0 sensor.piezo_rise_time=0 "
                         "sensor.piezo_range=0 sensor.accelerometer_rise_time=0 "
                         "sensor.accelerometer_range=0"));
    check_close(piezo(&wide, 900), 900, 1e-9);
    check_close(accelerometer(&wide, 9000), 9000, 1e-9);
}

// Checks mean and spread of the noise on a reading of zero.
static void check_spread(double (*read)(sensors *, double), sensors *s, double spread)
{
    enum { COUNT = 40000 };
    double sum = 0, squares = 0;
    for (int i = 0; i < COUNT; i++) {
        double v = read(s, 0);
        sum += v;
        squares += v * v;
    }
    check_relative(sqrt(squares / COUNT), spread, 0.02);
    check_close(sum / COUNT, 0, 0.02 * spread);
}

TEST(noise_has_its_spread)
{
    sensors s = fresh_sensors(
        given(ALL_FITTED " sensor.adc_bits=0 sensor.piezo_noise=0.03 "
                         "sensor.film_noise=0.02 sensor.accelerometer_noise=0.01"));
    check_spread(piezo, &s, 0.03);
    check_spread(film, &s, 0.002);
    check_spread(accelerometer, &s, 0.5);
}

TEST(each_noise_is_its_own)
{
    sensors s = fresh_sensors(given(
        ALL_FITTED " sensor.adc_bits=0 sensor.tachometer_noise=1 sensor.piezo_noise=1 "
                   "sensor.film_noise=1 sensor.accelerometer_noise=1 "
                   "sensor.tachometer_gain=1 sensor.film_gain=1 "
                   "sensor.accelerometer_gain=1 sensor.piezo_range=0 "
                   "sensor.accelerometer_range=0"));
    enum { COUNT = 20000 };
    double product[6] = {0};
    for (int i = 0; i < COUNT; i++) {
        sensor_reading r = sensors_read(&s, &(sensed_motion){.force = 0});
        double v[4] = {r.tachometer, r.piezo_force, r.film, r.accelerometer};
        for (int a = 0, k = 0; a < 4; a++) {
            for (int b = a + 1; b < 4; b++, k++) {
                product[k] += v[a] * v[b] / COUNT;
            }
        }
    }
    for (int k = 0; k < 6; k++) {
        check_close(product[k], 0, 0.03); // four standard deviations
    }
}

// --- lags and leaks --------------------------------------------------------------------

#define QUIET                                                                            \
    ALL_FITTED                                                                           \
    " sensor.adc_bits=0 sensor.piezo_noise=0 sensor.film_noise=0 "                       \
    "sensor.accelerometer_noise=0"

// A step of 1 N: exp(-t/q) - exp(-t/r), times q/(q - r), with the rise's r and the leak's
// q.
TEST(piezo_rises_and_leaks)
{
    const double r = 5e-5 / RISE_CONSTANTS, q = 5,
                 instants[] = {1e-5, 5e-5, 2e-4, 5e-3, 1, 4, 20};
    sensors s = fresh_sensors(given(QUIET));
    double t = 0, tenth = 0;
    for (int i = 0; i < 7; i++) {
        hold(&s, instants[i] - t, (sensed_motion){.force = 1});
        t = instants[i];
        double expected = q / (q - r) * (exp(-t / q) - exp(-t / r));
        check_close(piezo(&s, 1), expected, 1e-9);
    }
    s = fresh_sensors(given(QUIET));
    for (t = 0; piezo(&s, 1) < 0.9; t += 1e-7) {
        tenth = piezo(&s, 1) < 0.1 ? t : tenth;
        hold(&s, 1e-7, (sensed_motion){.force = 1});
    }
    check_close(t - tenth, 5e-5, 3e-7);
}

// What a gain makes larger at the converter is taken back: the reading is the force, and
// the converter's step is so much finer.
TEST(a_gain_is_taken_back)
{
    sensors s = fresh_sensors(
        given(QUIET " sensor.piezo_rise_time=0 sensor.piezo_gain=4 "
                    "sensor.accelerometer_rise_time=0 sensor.accelerometer_gain=0.5"));
    check_relative(piezo(&s, 1.3), 1.3, 1e-14);
    check_relative(accelerometer(&s, 3), 3.0, 1e-14);
    s = fresh_sensors(given(
        ALL_FITTED " sensor.piezo_noise=0 sensor.piezo_rise_time=0 sensor.piezo_gain=4"));
    const double step = 2 * s.p.adc_range / (double)(1 << s.p.adc_bits) / 4;
    const double codes = piezo(&s, 1.3) / step;
    check_close(codes, round(codes), 1e-9);
    check_close(piezo(&s, 1.3), 1.3, 0.51 * step);
}

TEST(piezo_without_leak_stays_and_without_rise_is_instant)
{
    sensors s = fresh_sensors(given(QUIET " sensor.piezo_leak_time=0"));
    hold(&s, 1000, (sensed_motion){.force = 2});
    check_close(piezo(&s, 2), 2, 1e-12);
    s = fresh_sensors(given(QUIET " sensor.piezo_rise_time=0"));
    check_close(piezo(&s, 2), 2, 1e-12);
    hold(&s, 5, (sensed_motion){.force = 2});
    check_close(piezo(&s, 2), 2 * exp(-1), 1e-12);
}

// An impulse p arrives as p/r; the sensor is off scale until it has died down to its
// range.
TEST(impulse_drives_the_piezo_off_scale)
{
    const double impulse = 0.02, r = 5e-5 / RISE_CONSTANTS;
    const double back = r * log(impulse / r / 10);
    sensors s = fresh_sensors(given(QUIET " sensor.adc_range=20"));
    sensors_strike(&s, impulse);
    check_close(piezo(&s, 0), 10, 0);
    hold(&s, 0.98 * back, (sensed_motion){.force = 0});
    check_close(piezo(&s, 0), 10, 0);
    hold(&s, 0.04 * back, (sensed_motion){.force = 0});
    check_below(piezo(&s, 0), 9.99);
    // the charge that leaked meanwhile is missing
    hold(&s, 40 * r, (sensed_motion){.force = 0});
    check_close(piezo(&s, 0), -impulse / 5, 1e-6);
}

// Strides far shorter than the leak, each with a force that rises and falls by ten
// newtons: a ringing chain of many links makes them. By symmetry the leak sees the mean.
TEST(leak_keeps_its_digits_over_short_strides)
{
    const int strides = 100000;
    const sensed_motion edge = {.force = -5};
    for (double h = 2e-6; h < 1e-3; h *= 6) {
        sensors s = fresh_sensors(given(QUIET " sensor.piezo_leak_time=10"));
        for (int i = 0; i < strides; i++) {
            sensors_follow(&s, h, &edge, &edge, 5.0 / 3); // -5 + 40 u - 40 u^2
        }
        check_close(s.piezo_leak.value, 5.0 / 3 * -expm1(-strides * h / 10), 1e-9);
    }
}

TEST(film_leaks)
{
    sensors s = fresh_sensors(given(QUIET));
    double t = 0;
    for (int i = 0; i < 40; i++) {
        check_close(film(&s, 0.3), 0.3 * exp(-t), 1e-12);
        hold(&s, 0.05, (sensed_motion){.bending = 0.3});
        t += 0.05;
    }
    sensors tight = fresh_sensors(given(QUIET " sensor.film_leak_time=0"));
    hold(&tight, 1000, (sensed_motion){.bending = 0.3});
    check_close(film(&tight, 0.3), 0.3, 1e-12);
}

// A swinging beam: the high pass turns sin(w t) into w q/(1 + w^2 q^2) (w q sin + cos) in
// the end.
TEST(film_follows_a_swing)
{
    const double w = 12, q = 0.2, h = 0.005, share = w * q / (1 + w * w * q * q);
    sensors s = fresh_sensors(given(QUIET " sensor.film_leak_time=0.2"));
    for (int i = 0; i < 1000; i++) {
        double a = w * h * i, b = w * h * (i + 1);
        sensed_motion first = {.bending = 0.1 * sin(a), .bending_rate = 0.1 * w * cos(a)};
        sensed_motion last = {.bending = 0.1 * sin(b), .bending_rate = 0.1 * w * cos(b)};
        sensors_follow(&s, h, &first, &last, 0);
    }
    double end = w * h * 1000;
    check_close(film(&s, 0.1 * sin(end)), 0.1 * share * (w * q * sin(end) + cos(end)),
                1e-8);
}

TEST(accelerometer_rises_in_its_time)
{
    const double tau = 3.5e-4 / RISE_CONSTANTS;
    sensors s = fresh_sensors(given(QUIET));
    for (int i = 0; i < 20; i++) {
        check_close(accelerometer(&s, 100), 100 * (1 - exp(-i * 5e-5 / tau)), 1e-7);
        sensed_motion first = {.velocity = i * 5e-3, .acceleration = 100};
        sensed_motion last = {.velocity = (i + 1) * 5e-3, .acceleration = 100};
        sensors_follow(&s, 5e-5, &first, &last, 0);
    }
}

// A jump of the velocity is a pulse of acceleration: jump/tau, whose integral is the
// jump.
TEST(accelerometer_feels_a_jump)
{
    const double tau = 3.5e-4 / RISE_CONSTANTS, h = 1e-6;
    sensors s =
        fresh_sensors(given(QUIET " sensor.adc_range=1000 sensor.accelerometer_range=0"));
    const sensed_motion before = {.velocity = 0.8}, after = {.velocity = 0.5};
    sensors_follow(&s, 0.01, &before, &before, 0);
    double last = sensors_read(&s, &after).accelerometer, gained = 0;
    check_relative(last, -0.3 / tau, 1e-12);
    for (int i = 0; i < 5000; i++) {
        sensors_follow(&s, h, &after, &after, 0);
        double now = sensors_read(&s, &after).accelerometer;
        gained += h * (last + now) / 2;
        last = now;
    }
    check_relative(gained, -0.3, 1e-5);
}

// --- in a run --------------------------------------------------------------------------

// Against the rows of a run, put through lag and leak in the simplest way.
TEST(run_feeds_the_sensors)
{
    const double tau = 0.01 / RISE_CONSTANTS, leak = 0.1;
    run_result run =
        rig_run(given(QUIET " control.law=force-pd method.step=2e-5 run.duration=0.4 "
                            "initial.angle=-0.02 sensor.film_leak_time=0.1 "
                            "sensor.accelerometer_rise_time=0.01"),
                true);
    const trace *t = &run.trace;
    double felt = 0, leaked = 0, largest = 0, bending_before = 0;
    int compared = 0;
    for (size_t i = 1; i < t->row_count; i++) {
        const sample *a = &t->rows[i - 1], *b = &t->rows[i];
        double h = b->time - a->time, gained = b->hub_velocity - a->hub_velocity;
        double bending = b->last_angle - b->first_angle;
        if (h > 1e-9) {
            felt += (gained / h - felt) * -expm1(-h / tau);
            leaked += ((bending_before + bending) / 2 - leaked) * -expm1(-h / leak);
        } else {
            felt += gained / tau;
        }
        bending_before = bending;
        // a sample that changes the command has its own row
        if (b->film != a->film && h < 1e-9) {
            check_close(b->film, bending - leaked, 1e-7);
            check_close(b->accelerometer, felt, 2e-3);
            largest = fmax(largest, fabs(b->film));
            compared++;
        }
    }
    assert_in_range(compared, 20, 90);
    check_below(0.03, largest);
    check_below(0, run.summary.impacts);
    run_finish(&run);
}

// The arm pressed against the wall is pushed: an impact without an approach.
TEST(sensors_feel_a_push_in_contact)
{
    // a twentieth of a millisecond before a sample
    scenario s = SCRIPTED(rig_parameters_with("control.law=force-pd " QUIET),
                          PUSHES(0.99995, 0.02));
    KEPT_RUN(run) = run_done(&s, true);
    double fsr = 0, piezo_force = 0, acceleration = 0;
    for (EACH_ROW(row, &run.trace)) {
        if (row->time > 0.9) {
            fsr = fmax(fsr, row->force_reading);
            piezo_force = fmax(piezo_force, row->piezo_force);
            acceleration = fmax(acceleration, fabs(row->accelerometer));
        }
    }
    check_close(fsr, 10, 1e-9);
    check_close(piezo_force, 10, 1e-9);
    check_below(1, acceleration);
}

// Steps that do not resolve an impact deliver it as a force, unless it rebounds: then it
// is a jump, and an impulse like any other.
TEST(sensors_feel_an_unresolved_rebound)
{
    RIG_RUN(run,
            QUIET " control.law=open-loop control.rate=5000 method.name=newmark "
                  "arm.links=12 wall.kind=plane wall.restitution=0.8 run.duration=0.305");
    double fsr = 0, largest_impulse = 0;
    for (EACH_ROW(row, &run.trace)) {
        largest_impulse = fmax(largest_impulse, row->impulse);
        fsr = fmax(fsr, row->force_reading);
    }
    check_below(0.003, largest_impulse);
    // 0.003 N s over a time constant of 0.68 ms; the next sample comes within 0.2 ms
    check_below(0.003 / 0.68e-3 * exp(-0.2 / 0.68), fsr);
}

// Which input the last controller got.
static controller_input got;

static void spy(void *memory, const controller_input *input, controller_output *output)
{
    (void)memory;
    got = *input;
    output->command = 0;
}

static const controller spying = {.name = "spying", .sample = spy};

static void see(const char *const *settings)
{
    rig *r;
    bool changed;
    parameters p = rig_parameters(settings);
    const sensed_motion m = {.acceleration = 30, .bending = -0.2, .force = 1.5};
    DONE(rig_create(&r, &p, NULL, &f));
    r->law = &spying;
    sensors_follow(&r->sensors, 5, &m, &m, 1.5);
    DONE(rig_act(r, 0, &m, &changed, &f));
    rig_destroy(r);
}

TEST(controller_gets_what_is_fitted)
{
    see(given("control.law=open-loop"));
    assert_true(isnan(got.piezo_force) && isnan(got.film) && isnan(got.accelerometer));
    check_close(got.force, 1.5, 0.1);
    see(given("control.law=open-loop " ALL_FITTED));
    check_close(got.force, 1.5, 0.1); // the FSR's
    check_close(got.piezo_force, 1.5 * exp(-1), 0.05);
    check_close(got.film, -0.2 * exp(-5), 0.01);
    assert_false(isnan(got.accelerometer));
    see(given("control.law=open-loop sensor.force=piezo"));
    check_close(got.force, 1.5 * exp(-1), 0.05);
    assert_true(isnan(got.film) && isnan(got.accelerometer));
}

TEST(ideal_force_sensors_are_alike)
{
    summary by_fsr = rig_summary_with("control.law=force-pd sensor.ideal=true");
    summary by_piezo =
        rig_summary_with("control.law=force-pd sensor.ideal=true sensor.force=piezo");
    check_relative(by_piezo.peak_force_N, by_fsr.peak_force_N, 1e-9);
    check_relative(by_piezo.steady_force_N, by_fsr.steady_force_N, 1e-9);
}

TEST(printed_arm_feeds_the_sensors_too)
{
    RIG_RUN(run, "control.law=open-loop arm.model=printed sensor.ideal=true " ALL_FITTED);
    double largest = 0;
    for (size_t i = 1; i < run.trace.row_count; i++) {
        const sample *before = &run.trace.rows[i - 1], *row = &run.trace.rows[i];
        if (row->film != before->film) {
            check_close(row->film, before->last_angle - before->first_angle, 1e-12);
            check_close(row->accelerometer, before->hub_acceleration, 1e-9);
            check_close(row->piezo_force, before->force, 1e-9);
            largest = fmax(largest, fabs(row->film));
        }
    }
    check_below(0.02, largest);
}

// --- the beam's shape
// --------------------------------------------------------------------

// Of two links of 0.5 m on a rigid hub the shape follows from the angles alone.
TEST(shape_is_what_the_angles_say)
{
    RIG_RUN(run, "control.law=open-loop sensor.ideal=true sensor.tip_deflection=true "
                 "sensor.root_strain=true sensor.root_strain_distance=0.002");
    double largest = 0;
    for (size_t i = 1; i < run.trace.row_count; i++) {
        const sample *before = &run.trace.rows[i - 1], *row = &run.trace.rows[i];
        if (row->tip_deflection != before->tip_deflection) {
            const double bend = before->last_angle - before->hub_angle;
            check_close(row->tip_deflection, 0.5 * sin(bend), 1e-9);
            check_close(row->root_strain, 0.002 * bend / 0.5, 1e-9);
            largest = fmax(largest, fabs(row->tip_deflection));
        }
    }
    check_below(0.01, largest);
}

// A cantilever under a force f at its tip bends by f L^3/(3 EI), and at its root by f
// L/EI: many links with the beam's own root come near that.
TEST(shape_of_many_links_is_that_of_a_cantilever)
{
    RIG_RUN(run, "control.law=open-loop sensor.ideal=true sensor.tip_deflection=true "
                 "sensor.root_strain=true arm.links=24 arm.hub_joint=beam "
                 "arm.damping_ratio=0.5 arm.EI=5 run.duration=4");
    const sample *end = &run.trace.rows[run.trace.row_count - 1];
    check_relative(end->tip_deflection, -end->force / (3 * 5), 0.01);
    check_relative(end->root_strain, -1e-3 * end->force * 1 / 5, 0.03);
}

// It reads when it is due, and what it read then until it is due again.
TEST(slow_sensor_holds_what_it_read)
{
    sensors s = fresh_sensors(SETTINGS("sensor.tip_deflection=true", "sensor.adc_bits=0",
                                       "sensor.tip_deflection_noise=0",
                                       "sensor.tip_deflection_rate=50"));
    for (int k = 0; k < 40; k++) {
        const sensed_motion now = {.time = k * 0.005, .tip_deflection = 1e-4 * k};
        check_close(sensors_read(&s, &now).tip_deflection, 1e-4 * (k / 4 * 4), 1e-15);
    }
}

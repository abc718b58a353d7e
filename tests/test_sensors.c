// Sensors and converters against their data.
#include "src/rig/sensors.h"

#include "tests/rig_fixture.h"
#include "tests/shipped_scenario.h"

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
    return sensors_read(s, &(sensed_motion){.angle = angle,
                                            .velocity = velocity,
                                            .force = force});
}

// A stride of the force alone.
static void follow_force(sensors *s, double h, double first, double last, double mean)
{
    sensors_follow(s, h, &(sensed_motion){.force = first},
                   &(sensed_motion){.force = last}, mean);
}

TEST(encoder_steps_by_one_count)
{
    sensors s = fresh_sensors(given("sensor.encoder_counts=500"), 1);
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

TEST(converter_has_its_bits_and_range)
{
    const double step = 20.0 / 4096;
    const converter adc = converter_of(12, 10), continuous = converter_of(0, 10);
    check_close(converter_value(&adc, 0.4 * step), 0, 0);
    check_close(converter_value(&adc, 0.6 * step), step, 1e-15);
    check_close(converter_value(&adc, 3), round(3 / step) * step, 1e-12);
    check_close(converter_value(&adc, 25), 10 - step, 1e-12);
    check_close(converter_value(&adc, -25), -10, 0);
    check_close(converter_value(&continuous, 1.23456789), 1.23456789, 0);
    check_close(converter_value(&continuous, 25), 10, 0);
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

// After a step the sensor goes from 10 % to 90 % within its rise time, 1.5 ms.
TEST(force_sensor_rises_in_its_time)
{
    check_close(rise_to(0.9) - rise_to(0.1), 1.5e-3, 4e-6);
}

TEST(force_sensor_follows_a_stride_exactly)
{
    // f = 2 - 3 u + 5 u^2 with u from 0 to 1 over 4 ms: it ends at 4, its mean is
    // 2 - 3/2 + 5/3; at once, and in a thousand short strides from u = a to b
    const double h = 4e-3;
    sensors once = fresh_sensors(NULL, 1), often = once;
    once.fsr.value = often.fsr.value = 0.7;
    follow_force(&once, h, 2, 4, 2 - 1.5 + 5.0 / 3);
    for (int i = 0; i < 1000; i++) {
        double a = i / 1000.0, b = (i + 1) / 1000.0;
        double mean = 2 - 1.5 * (a + b) + 5.0 / 3 * (a * a + a * b + b * b);
        follow_force(&often, h / 1000, 2 - 3 * a + 5 * a * a, 2 - 3 * b + 5 * b * b,
                     mean);
    }
    check_close(once.fsr.value, often.fsr.value, 1e-9);
    // a stride of no length changes nothing
    double before = once.fsr.value;
    follow_force(&once, 1e-17, 1, 3, 1e9);
    check_close(once.fsr.value, before, 1e-4);
}

// Over less than a thousandth of its lag a sensor takes of f = slope u + curve u^2, u the
// share of the stride that is over, x times the integrals of e^-(1-u)x u^n: 1!/2! - x
// 1!/3! + ..., and so on, to the last digits.
TEST(short_strides_lose_no_digits)
{
    const double h = 5e-7, slope = 3, curve = -2;
    sensors s = fresh_sensors(NULL, 1);
    const double x = h / s.fsr.time_constant;
    double of_u = 0, of_square = 0, power = x, factorial = 2;
    assert_true(x > 5e-4 && x < 1e-3);
    for (int n = 0; n < 8; n++) {
        of_u += power / factorial;
        factorial *= n + 3;
        of_square += 2 * power / factorial;
        power *= -x;
    }
    s.fsr.value = 0;
    follow_force(&s, h, 0, slope + curve, slope / 2 + curve / 3);
    check_relative(s.fsr.value, slope * of_u + curve * of_square, 1e-11);
}

// What a lag holds, and the input at a stride's ends and in its mean, add up: each is
// followed whether the others are there or not.
TEST(a_lag_is_linear)
{
    for (int i = 0; i < 2; i++) {
        sensors s = fresh_sensors(NULL, 1);
        const double h = (i == 0 ? 5e-4 : 0.8) * s.fsr.time_constant;
        double of[16];
        for (int parts = 0; parts < 16; parts++) {
            s.fsr.value = parts & 1 ? 0.7 : 0;
            follow_force(&s, h, parts & 2 ? 3 : 0, parts & 4 ? 2 : 0,
                         parts & 8 ? -1.3 : 0);
            of[parts] = s.fsr.value;
        }
        check_close(of[0], 0, 0);
        check_relative(of[1], 0.7 * exp(-h / s.fsr.time_constant), 1e-13);
        for (int parts = 1; parts < 16; parts++) {
            double sum = 0;
            for (int part = 1; part < 16; part *= 2) {
                sum += parts & part ? of[part] : 0;
            }
            check_close(of[parts], sum, 1e-13);
        }
    }
}

// Strides that are as long as the one before up to rounding decay as if there had been
// none before.
TEST(strides_of_nearly_one_length_decay_by_their_own)
{
    sensors s = fresh_sensors(NULL, 1);
    const double lag = s.fsr.time_constant;
    follow_force(&s, 0.5 * lag, 1, 1, 1);
    for (double longer = -9e-10; longer < 1e-9; longer += 3e-10) {
        s.fsr.value = 1;
        follow_force(&s, (0.5 + longer) * lag, 0, 0, 0);
        check_relative(s.fsr.value, exp(-0.5 - longer), 1e-15);
    }
}

// What has no noise takes no numbers from the others.
TEST(quiet_sensors_draw_nothing)
{
    const char *const *one = given("sensor.adc_bits=0 sensor.fsr_noise=0");
    const char *const *two = given("sensor.adc_bits=0 sensor.fsr_noise=0.01");
    sensors alone = fresh_sensors(one, 7), both = fresh_sensors(two, 7);
    for (int i = 0; i < 100; i++) {
        const double taken = read_hub(&alone, 0, 0.5, 1).tachometer;
        if (i % 2 == 0) {
            check_close(read_hub(&both, 0, 0.5, 1).tachometer, taken, 0);
        }
    }
}

// In flight nothing needs to be followed, unless a force is remembered or the arm itself
// is felt.
TEST(sensors_at_rest_remember_no_force)
{
    const sensors fresh = fresh_sensors(NULL, 1);
    assert_true(sensors_at_rest(&fresh));
    for (int i = 0; i < 3; i++) {
        sensors s = fresh;
        *(double *[]){&s.fsr.value, &s.piezo_rise.value, &s.piezo_leak.value}[i] = 1e-9;
        assert_false(sensors_at_rest(&s));
    }
    sensors film = fresh_sensors(given("sensor.film=true"), 1);
    sensors accelerometer = fresh_sensors(given("sensor.accelerometer=true"), 1);
    assert_false(sensors_at_rest(&film) || sensors_at_rest(&accelerometer));

    // an instant sensor keeps nothing of a blow
    sensors ideal = fresh_sensors(given("sensor.ideal=true sensor.piezo=true"), 1);
    sensors_strike(&ideal, 0.1);
    assert_true(sensors_at_rest(&ideal));
    sensors real = fresh;
    sensors_strike(&real, 0.1);
    assert_false(sensors_at_rest(&real));
}

TEST(impulse_arrives_whole)
{
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

TEST(divider_follows_the_power_law)
{
    parameters p = rig_parameters(NULL);
    // half the supply where the sensor has the measuring resistor's 40 kohm: 30 kohm
    // f^-0.75
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

TEST(noise_has_its_spread_and_follows_its_seed)
{
    const char *const *quiet = given("sensor.tachometer_ripple=0 sensor.adc_bits=0");
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

TEST(ripple_follows_the_shaft)
{
    sensors s = fresh_sensors(
        given(
            "sensor.tachometer_noise=0 sensor.adc_bits=0 sensor.tachometer_ripple=0.05"),
        1);
    check_close(read_hub(&s, 0.5 * PI / 79, 2, 0).tachometer, 2.1, 1e-9);
    check_close(read_hub(&s, 1.5 * PI / 79, 2, 0).tachometer, 1.9, 1e-9);
}

// (1 + gain error) times the value and an offset, each sensor its own; none with ideal
// sensors.
TEST(sensors_show_what_they_are_calibrated_for)
{
    for (int ideal = 0; ideal < 2; ideal++) {
        sensors s = fresh_sensors(
            given("sensor.encoder_gain_error=0.02 sensor.encoder_offset=-0.03 "
                  "sensor.tachometer_gain_error=-0.1 sensor.tachometer_offset=0.2 "
                  "sensor.fsr_gain_error=0.25 sensor.fsr_offset=-0.5 "
                  "sensor.piezo_gain_error=0.5 sensor.piezo_offset=0.1 "
                  "sensor.piezo=true sensor.encoder_counts=0 sensor.tachometer_noise=0 "
                  "sensor.tachometer_ripple=0 sensor.fsr_noise=0 "
                  "sensor.fsr_rise_time=0 sensor.piezo_noise=0 "
                  "sensor.piezo_rise_time=0 sensor.piezo_leak_time=0 sensor.adc_bits=0 "
                  "sensor.ideal=%s",
                  ideal ? "true" : "false"),
            1);
        for (double x = 0.5; x < 3; x += 0.7) {
            sensor_reading r = read_hub(&s, x, x, x);
            check_close(r.encoder, ideal ? x : 1.02 * x - 0.03, 1e-12);
            check_close(r.tachometer, ideal ? x : 0.9 * x + 0.2, 1e-12);
            check_close(r.force_reading, ideal ? x : 1.25 * x - 0.5, 1e-12);
            check_close(r.piezo_force, ideal ? x : 1.5 * x + 0.1, 1e-12);
        }
    }
}

// A force that goes up and down shows the loop of a play, and nothing is left where it
// ends.
TEST(hysteresis_is_a_play)
{
    sensors s = fresh_sensors(given("sensor.fsr_hysteresis=0.1 sensor.fsr_noise=0 "
                                    "sensor.fsr_rise_time=0 sensor.adc_bits=0"),
                              1);
    const struct {
        double force, shown;
    } way[] = {{1, 0.9},   {2, 1.8}, {1.9, 1.8}, {1.7, 1.8}, {1, 1.1},
               {1.1, 1.1}, {2, 1.8}, {0, 0},     {0.5, 0.45}};
    for (EACH(c, way)) {
        follow_force(&s, 0.01, c->force, c->force, c->force);
        assert_true(sensors_at_rest(&s) == (c->force == 0));
        check_close(read_hub(&s, 0, 0, c->force).force_reading, c->shown, 1e-12);
    }
}

// A force sensor with a play of that share and a lag of that rise time, nothing else.
static sensors play_of(double share, double rise_time)
{
    return fresh_sensors(
        given("sensor.fsr_hysteresis=%g sensor.fsr_rise_time=%g "
              "sensor.fsr_noise=0 sensor.adc_bits=0 sensor.fsr_saturation=1e6",
              share, rise_time),
        1);
}

// A parabola at once and in four thousand strides, each too short to hide a turn: the
// play is the same, whether the force turns between its ends, the lag once or twice, or
// nothing.
TEST(turns_within_a_stride_move_the_play)
{
    enum { STRIDES = 4000 };
    const double parabolas[][3] = {
        {1, 8, -8}, {2, -6, 7}, {0.5, 3, 0}, {3, -2.9, 0}, {1, 9, -9.5}};
    const double rises[] = {0, 1.5e-3, 0.02, 1}, starts[] = {0.2, 1.5, 6};
    int moved = 0;
    for (EACH(c, parabolas)) {
        const double a = (*c)[0], b = (*c)[1], d = (*c)[2], h = 4e-4;
        for (int i = 0; i < 12; i++) {
            sensors once = play_of(0.2, rises[i / 3]);
            once.fsr.value = once.fsr_shown = starts[i % 3];
            sensors often = once, ends = once;
            follow_force(&once, h, a, a + b + d, a + b / 2 + d / 3);
            for (int k = 0; k < STRIDES; k++) {
                const double u = k / (double)STRIDES, v = (k + 1) / (double)STRIDES;
                follow_force(&often, h / STRIDES, a + u * (b + u * d),
                             a + v * (b + v * d),
                             a + b / 2 * (u + v) + d / 3 * (u * u + u * v + v * v));
            }
            check_close(once.fsr_shown, often.fsr_shown, 1e-5);

            // the play that the ends of the stride alone would give (0.8 and 1.2 are its
            // edges, at a share of 0.2) differs where the force turns within
            ends.p.fsr_hysteresis = 0;
            follow_force(&ends, h, a, a + b + d, a + b / 2 + d / 3);
            const double end = ends.fsr_shown, start = starts[i % 3];
            const double by_ends =
                fmax(0.8 * end, fmin(fmax(0.8 * start, start), 1.2 * end));
            moved += fabs(by_ends - once.fsr_shown) > 1e-3;
        }
    }
    assert_true(moved > 5);
}

// An impulse is a force larger than any play: behind it the reading stands at the upper
// edge of what the force falls to, once that has fallen far enough, as after a short
// strong force.
TEST(a_blow_moves_the_play)
{
    const double h = 0.3, impulse = 0.02, width = 1e-9;
    sensors s = play_of(h, 1.5e-3), pressed = s;
    sensors_strike(&s, impulse);
    check_relative(s.fsr_shown, (1 - h) * impulse / s.fsr.time_constant, 1e-12);
    follow_force(&pressed, width, impulse / width, impulse / width, impulse / width);
    check_relative(pressed.fsr_shown, s.fsr_shown, 1e-5);
    for (int i = 0; i < 4; i++) {
        follow_force(&s, 1e-3, 0.1, 0.1, 0.1);
        follow_force(&pressed, 1e-3, 0.1, 0.1, 0.1);
        check_relative(pressed.fsr_shown, s.fsr_shown, 1e-5);
        check_relative(s.fsr_shown, (1 + h) * s.fsr.value, 1e-12);
    }

    // without a lag at once, and in flight nothing is left of it
    sensors instant = play_of(h, 0), flying = instant;
    sensors_strike(&instant, impulse);
    follow_force(&instant, 1e-3, 0.5, 0.5, 0.5);
    check_relative(instant.fsr_shown, (1 + h) * 0.5, 1e-12);
    sensors_strike(&flying, impulse);
    follow_force(&flying, 1e-3, 0, 0, 0);
    check_close(flying.fsr_shown, 0, 0);

    // a jump of the force before a stride, too: up to 2 N, then down to 1.8 N
    sensors jumped = play_of(h, 0);
    follow_force(&jumped, 1e-3, 1, 1, 1);
    follow_force(&jumped, 1e-3, 2, 1.8, 1.9);
    check_relative(jumped.fsr_shown, (1 - h) * 2, 1e-12);
}

// In a run: what the lag holds at a sample 0.7 ms after the second impact, in closed
// form, is falling, so that the reading stands 30 % above it.
TEST(a_run_reads_the_play_after_an_impact)
{
    KEPT_SCENARIO(s) =
        shipped_with("compare/open-loop",
                     "sensor.fsr_hysteresis=0.3 control.rate=1000 "
                     "sensor.adc_bits=0 sensor.fsr_noise=0 method.step=1e-4");
    KEPT_RUN(r) = run_done(&s, true);
    const double lag = s.parameters.sensor.fsr_rise_time / log(9), sampled = 0.579;
    const event *second = NULL;
    for (size_t i = 0; i < r.trace.event_count; i++) {
        second = r.trace.events[i].kind == EVENT_IMPACT ? &r.trace.events[i] : second;
    }
    const sample *row = &r.trace.rows[trace_row_at(&r.trace, sampled + 1.5e-4)];
    double arrived = second->impulse / lag * exp((second->time - sampled) / lag);
    const double rise = row->force * (1 - exp((second->time - sampled) / lag));
    arrived += rise; // of a force that hardly changes in this time
    check_relative(row->force_reading, 1.3 * arrived, 1e-3);
}

TEST(ideal_sensors_tell_the_truth)
{
    sensors s = fresh_sensors(given("sensor.ideal=true"), 1);
    sensor_reading r = read_hub(&s, 0.1234567, -1.2345678, 3.456789);
    check_close(r.encoder, 0.1234567, 0);
    check_close(r.tachometer, -1.2345678, 1e-12);
    check_close(r.force_reading, 3.456789, 1e-12);

    // of a force beyond any sensor's scale, too
    check_relative(read_hub(&s, 0, 0, 321.5).force_reading, 321.5, 1e-12);
}

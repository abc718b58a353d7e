#include "src/study/sensor_view.h"
#include "tests/arm_fixture.h"

static void an_impulse_jumps_and_decays(void **state)
{
    (void)state;
    sensor_lag s;
    sensor_lag_start(&s, 1e-3, 2);
    sensor_lag_impulse(&s, 0.05);
    check_close(s.value, 50, 1e-12);
    sensor_lag_force(&s, 3e-3, 0, 0, 0);
    check_relative(s.value, 50 * exp(-3), 1e-12);
    check_close(s.peak, 50, 1e-12);
    check_close(s.peak_time, 2, 0);
}

static void a_constant_force_is_reached_without_overshoot(void **state)
{
    (void)state;
    sensor_lag s;
    sensor_lag_start(&s, 2e-3, 0);
    for (int i = 1; i <= 100; i++) {
        sensor_lag_force(&s, 1e-4, 7, 7, 7);
        check_relative(s.value, 7 * (1 - exp(-i * 1e-4 / 2e-3)), 1e-12);
    }
    check_close(s.peak, s.value, 0);
}

// A parabola against the differential equation stepped finely by Runge-Kutta of fourth order.
static void a_curved_force_is_followed_exactly(void **state)
{
    (void)state;
    const double tau = 1e-3, length = 4e-3, a = 3, b = 5e3, c = -1.6e6;
    enum { STEPS = 4000 };
    double y = 2, h = length / STEPS, top = 2, top_time = 0;
    for (int i = 0; i < STEPS; i++) {
        double t = i * h, f[3];
        for (int j = 0; j < 3; j++) {
            double at = t + 0.5 * j * h;
            f[j] = a + b * at + c * at * at;
        }
        double k1 = (f[0] - y) / tau, k2 = (f[1] - y - 0.5 * h * k1) / tau;
        double k3 = (f[1] - y - 0.5 * h * k2) / tau, k4 = (f[2] - y - h * k3) / tau;
        y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        if (y > top) {
            top = y;
            top_time = t + h;
        }
    }
    sensor_lag s;
    sensor_lag_start(&s, tau, 0);
    s.value = 2;
    double last = a + b * length + c * length * length;
    double mean = a + b * length / 2 + c * length * length / 3;
    sensor_lag_force(&s, length, a, last, mean);
    check_relative(s.value, y, 1e-9);
    check_relative(s.peak, top, 1e-6);
    check_close(s.peak_time, top_time, 2e-6);
}

// Whether a stretch is given whole or in two pieces makes no difference.
// A force that decays in a nanosecond from a million newtons, in strides that grow with the time
// since it began: against the closed form of the lag, which hardly tells it from its impulse.
static void a_spike_in_brief_strides_is_felt_as_its_impulse(void **state)
{
    (void)state;
    const double tau = 1e-3, decay = 1e-9, force = 1e6, end = 1e-4;
    sensor_lag s;
    sensor_lag_start(&s, tau, 0);
    for (double t = 0, next = 1e-13; t < end; t = next, next *= 1.1) {
        const double first = force * exp(-t / decay), last = force * exp(-next / decay);
        const double mean = first * -expm1((t - next) / decay) * decay / (next - t);
        sensor_lag_force(&s, next - t, first, last, mean);
    }
    const double fading = force * decay / (tau - decay);
    check_relative(s.value, fading * exp(-s.time / tau), 1e-5);
    check_relative(s.peak, fading, 1e-4);
}

static void pieces_make_the_whole(void **state)
{
    (void)state;
    sensor_lag whole, pieces;
    sensor_lag_start(&whole, 1e-3, 0);
    sensor_lag_start(&pieces, 1e-3, 0);
    // f = 1 + 2 s + 3 s^2 over one second
    sensor_lag_force(&whole, 1e-2, 1, 6, 3);
    sensor_lag_force(&pieces, 5e-3, 1, 2.75, 1.75);
    sensor_lag_force(&pieces, 5e-3, 2.75, 6, 4.25);
    check_relative(pieces.value, whole.value, 1e-12);
}

static scenario fast_touch(void)
{
    static char name[] = "test";
    return (scenario){.name = name,
                      .parameters = fixture_parameters(
                          SETTINGS("wall.kind=plane", "motor.voltage=5", "run.duration=0.5"))};
}

// The force of the ideal contact has no limit, what a sensor of 1 ms reads has the beam's.
static void the_sensor_converges_where_the_force_does_not(void **state)
{
    (void)state;
    scenario s = fast_touch();
    const int links[] = {6, 12, 24};
    sensor_view view[3];
    fault f;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(sensor_view_compute(&s, links[i], NULL, &view[i], &f), STATUS_OK);
    }
    for (int i = 0; i < 2; i++) {
        assert_true(view[i + 1].peak > 1.5 * view[i].peak);
        assert_true(view[i + 1].impulse < 0.6 * view[i].impulse);
    }
    double beam = sensor_beam_peak(&s.parameters, view[2].speed, 1e-3);
    check_relative(view[2].sensed[1], beam, 0.03);
    check_relative(view[2].momentum,
                   sensor_beam_momentum(&s.parameters, view[2].speed, MOMENTUM_WINDOW), 0.03);
    assert_true(fabs(view[0].sensed[1] / beam - 1) > 0.3);
}

// With few links the reading is the first impulse over the time constant.
static void two_links_read_as_one_impulse(void **state)
{
    (void)state;
    scenario s = fast_touch();
    sensor_view view;
    fault f;
    assert_int_equal(sensor_view_compute(&s, 2, NULL, &view, &f), STATUS_OK);
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        check_relative(view.sensed[i], view.impulse / sensor_constants[i], 1e-12);
        check_close(view.delay[i], 0, 0);
    }
    check_close(view.impulse, 0.15583707, 1e-6); // docs/what-a-sensor-sees.md
}

// The limit against the transform it comes from: y(t) of K / sqrt(t) by the substitution u =
// sqrt(t).
static void the_beams_limit_is_the_lag_of_an_inverse_root(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL);
    const double tau = 1e-3, k = sensor_beam_momentum(&p, 2, 1) / 2;
    double largest = 0;
    for (double t = 0.5 * tau; t < 1.5 * tau; t += 0.002 * tau) {
        enum { PIECES = 2000 };
        double sum = 0, width = sqrt(t) / PIECES;
        for (int i = 0; i < PIECES; i++) {
            double u = (i + 0.5) * width;
            sum += 2 * k / tau * exp((u * u - t) / tau) * width;
        }
        largest = fmax(largest, sum);
    }
    check_relative(sensor_beam_peak(&p, 2, tau), largest, 1e-5);
    // K itself for the default beam, by hand: EI = 2.46 N m2, rho A = 0.40108 kg/m
    check_relative(k, 2 * pow(2.46, 0.25) * pow(0.40108, 0.75) / sqrt(2 * 3.14159265358979), 1e-12);
}

static void what_cannot_be_viewed_is_said(void **state)
{
    (void)state;
    scenario s = fast_touch();
    sensor_view view;
    fault f;
    s.parameters.run.duration = 0.01;
    s.parameters.set[PARAMETER_INDEX(run.duration)] = 1;
    assert_int_equal(sensor_view_compute(&s, 2, NULL, &view, &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "no contact"));
    s.parameters.arm.model = ARM_PRINTED;
    assert_int_equal(sensor_view_compute(&s, 2, NULL, &view, &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "printed"));

    // a script is no part of what the study looks at
    s = fast_touch();
    action late = {.time = 0.9, .kind = ACTION_PUSH, .parameter = -1, .value = 0.01};
    s.actions = &late;
    s.action_count = 1;
    assert_int_equal(sensor_view_compute(&s, 2, NULL, &view, &f), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(f.text, "script"));

    // nor is it gone on with when it is to stop
    s.action_count = 0;
    run_monitor monitor = {0};
    atomic_store(&monitor.stop, true);
    assert_int_equal(sensor_view_compute(&s, 2, &monitor, &view, &f), STATUS_STOPPED);
    sensor_study study;
    assert_int_equal(sensor_study_compute(&s, &monitor, &study, &f), STATUS_STOPPED);
    assert_int_equal(study.count, 0);
    assert_int_equal(atomic_load(&monitor.pieces), 0);
}

// Modes that are too fast to follow are told beforehand, with what would make them slower.
static void modes_too_fast_to_follow_are_refused(void **state)
{
    (void)state;
    scenario s = fast_touch();
    sensor_study study;
    fault f;
    run_monitor monitor = {0};
    assert_int_equal(parameter_set_text(&s.parameters, parameter_index("arm.k2"), "1e9", &f),
                     STATUS_OK);
    assert_int_equal(sensor_study_compute(&s, &monitor, &study, &f), STATUS_NO_PROGRESS);
    assert_non_null(strstr(f.text, "arm.k2"));
    assert_int_equal(atomic_load(&monitor.pieces), 0);
}

// A stride of no length brings nothing.
static void a_force_without_time_is_not_felt(void **state)
{
    (void)state;
    sensor_lag lag;
    sensor_lag_start(&lag, 1e-3, 0);
    sensor_lag_force(&lag, 0, 5, 5, 5);
    check_close(lag.value, 0, 0);
    check_close(lag.peak, 0, 0);
}

// The study's rows are the views of their numbers of links, beside the beam that stops alike.
static void the_study_is_its_views(void **state)
{
    (void)state;
    scenario s = fast_touch();
    sensor_study study;
    sensor_view view;
    fault f;
    run_monitor monitor = {0};
    assert_int_equal(sensor_study_compute(&s, &monitor, &study, &f), STATUS_OK);
    assert_int_equal(study.count, SENSOR_LENGTHS);
    assert_int_equal(atomic_load(&monitor.pieces), SENSOR_LENGTHS);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(sensor_view_compute(&s, study.views[i].links, NULL, &view, &f), STATUS_OK);
        check_close(study.links[i], view.links, 0);
        check_close(study.impulse[i], view.impulse, 0);
        check_close(study.momentum[i], view.momentum, 0);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            check_close(study.sensed[k][i], view.sensed[k], 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_impulse_jumps_and_decays),
        cmocka_unit_test(a_constant_force_is_reached_without_overshoot),
        cmocka_unit_test(a_curved_force_is_followed_exactly),
        cmocka_unit_test(a_spike_in_brief_strides_is_felt_as_its_impulse),
        cmocka_unit_test(pieces_make_the_whole),
        cmocka_unit_test(the_sensor_converges_where_the_force_does_not),
        cmocka_unit_test(two_links_read_as_one_impulse),
        cmocka_unit_test(the_beams_limit_is_the_lag_of_an_inverse_root),
        cmocka_unit_test(what_cannot_be_viewed_is_said),
        cmocka_unit_test(modes_too_fast_to_follow_are_refused),
        cmocka_unit_test(a_force_without_time_is_not_felt),
        cmocka_unit_test(the_study_is_its_views),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}

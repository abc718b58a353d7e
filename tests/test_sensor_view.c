#include "src/study/sensor_view.h"
#include "src/run/run.h"
#include "tests/arm_fixture.h"

TEST(an_impulse_jumps_and_decays)
{
    sensor_lag s;
    sensor_lag_start(&s, 1e-3, 2);
    sensor_lag_impulse(&s, 0.05);
    check_close(s.value, 50, 1e-12);
    sensor_lag_force(&s, 3e-3, 0, 0, 0);
    check_relative(s.value, 50 * exp(-3), 1e-12);
    check_close(s.peak, 50, 1e-12);
    check_close(s.peak_time, 2, 0);
}

TEST(a_constant_force_is_reached_without_overshoot)
{
    sensor_lag s;
    sensor_lag_start(&s, 2e-3, 0);
    for (int i = 1; i <= 100; i++) {
        sensor_lag_force(&s, 1e-4, 7, 7, 7);
        check_relative(s.value, 7 * (1 - exp(-i * 1e-4 / 2e-3)), 1e-12);
    }
    check_close(s.peak, s.value, 0);
}

// A parabola against the differential equation stepped finely by Runge-Kutta of fourth order.
TEST(a_curved_force_is_followed_exactly)
{
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

// A force that decays in a nanosecond from a million newtons, in strides that grow with the time
// since it began: against the closed form of the lag, which hardly tells it from its impulse.
TEST(a_spike_in_brief_strides_is_felt_as_its_impulse)
{
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

// Over a thousandth of the time constant: a constant force to the last digits, a rising one to the
// cube of the share.
TEST(a_brief_stride_is_that_of_its_lag)
{
    const double tau = 1e-3, share = 0.9e-3;
    sensor_lag constant, rising;
    sensor_lag_start(&constant, tau, 0);
    sensor_lag_start(&rising, tau, 0);
    sensor_lag_force(&constant, share * tau, 5, 5, 5);
    check_relative(constant.value, -5 * expm1(-share), 1e-13);
    sensor_lag_force(&rising, share * tau, -3, 5, 1);
    const double felt = -expm1(-share);
    check_close(rising.value, -3 * felt + 8 * (1 - felt / share), 1e-9);
}

// Whether a stretch is given whole or in two pieces makes no difference.
TEST(pieces_make_the_whole)
{
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
                      .parameters =
                          parameters_with("wall.kind=plane motor.voltage=5 run.duration=0.5")};
}

// The force of the ideal contact has no limit, what a sensor of 1 ms reads has the beam's.
TEST(the_sensor_converges_where_the_force_does_not)
{
    scenario s = fast_touch();
    const int links[] = {6, 12, 24};
    sensor_view view[3];
    for (int i = 0; i < 3; i++) {
        DONE(sensor_view_compute(&s, links[i], NULL, &view[i], &f));
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
TEST(two_links_read_as_one_impulse)
{
    scenario s = fast_touch();
    sensor_view view;
    DONE(sensor_view_compute(&s, 2, NULL, &view, &f));
    for (int i = 0; i < SENSOR_CONSTANTS; i++) {
        check_relative(view.sensed[i], view.impulse / sensor_constants[i], 1e-12);
        check_close(view.delay[i], 0, 0);
    }
    check_close(view.impulse, 0.15583707, 1e-6); // docs/explanation/trust.md
}

// The limit against the transform it comes from: y(t) of K / sqrt(t) by the substitution u =
// sqrt(t).
TEST(the_beams_limit_is_the_lag_of_an_inverse_root)
{
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

TEST(what_cannot_be_viewed_is_said)
{
    scenario s = fast_touch();
    sensor_view view;
    s.parameters.run.duration = 0.01;
    s.parameters.set[PARAMETER_INDEX(run.duration)] = 1;
    REFUSED(STATUS_BAD_SCENARIO, "no contact", sensor_view_compute(&s, 2, NULL, &view, &f));
    s.parameters.arm.model = ARM_PRINTED;
    REFUSED(STATUS_BAD_SCENARIO, "printed", sensor_view_compute(&s, 2, NULL, &view, &f));

    // a script is no part of what the study looks at
    s = fast_touch();
    action late = {.time = 0.9, .kind = ACTION_PUSH, .parameter = -1, .value = 0.01};
    s.actions = &late;
    s.action_count = 1;
    REFUSED(STATUS_BAD_SCENARIO, "script", sensor_view_compute(&s, 2, NULL, &view, &f));

    // nor is it continued when it is to stop
    s.action_count = 0;
    run_monitor monitor = {0};
    atomic_store(&monitor.stop, true);
    REFUSED(STATUS_STOPPED, "", sensor_view_compute(&s, 2, &monitor, &view, &f));
    sensor_study study;
    REFUSED(STATUS_STOPPED, "", sensor_study_compute(&s, &monitor, &study, &f));
    assert_int_equal(study.count, 0);
    assert_int_equal(atomic_load(&monitor.pieces), 0);
}

// Modes that are too fast to follow are reported in advance, with what would make them slower.
TEST(modes_too_fast_to_follow_are_refused)
{
    scenario s = fast_touch();
    sensor_study study;
    run_monitor monitor = {0};
    DONE(parameter_set_text(&s.parameters, parameter_index("arm.k2"), "1e9", &f));
    REFUSED(STATUS_NO_PROGRESS, "arm.k2", sensor_study_compute(&s, &monitor, &study, &f));
    assert_int_equal(atomic_load(&monitor.pieces), 0);
}

// A stride of no length brings nothing.
TEST(a_force_without_time_is_not_felt)
{
    sensor_lag lag;
    sensor_lag_start(&lag, 1e-3, 0);
    sensor_lag_force(&lag, 0, 5, 5, 5);
    check_close(lag.value, 0, 0);
    check_close(lag.peak, 0, 0);

    // and where there is none, the largest is where it began
    sensor_lag_force(&lag, 1, 0, 0, 0);
    check_close(lag.peak, 0, 0);
    check_close(lag.peak_time, 0, 0);
}

// The study's rows are the views of their numbers of links, with the beam that stops alike.
TEST(the_study_is_its_views)
{
    scenario s = fast_touch();
    sensor_study study;
    sensor_view view;
    run_monitor monitor = {0};
    DONE(sensor_study_compute(&s, &monitor, &study, &f));
    assert_int_equal(study.count, SENSOR_LENGTHS);
    assert_int_equal(atomic_load(&monitor.pieces), SENSOR_LENGTHS);
    for (int i = 0; i < 3; i++) {
        DONE(sensor_view_compute(&s, study.views[i].links, NULL, &view, &f));
        check_close(study.links[i], view.links, 0);
        check_close(study.impulse[i], view.impulse, 0);
        check_close(study.momentum[i], view.momentum, 0);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            check_close(study.sensed[k][i], view.sensed[k], 0);
        }
    }

    // every column, for every number of links
    for (int i = 0; i < SENSOR_LENGTHS; i++) {
        const sensor_view *v = &study.views[i];
        check_close(study.links[i], v->links, 0);
        check_close(study.impulse[i], v->impulse, 0);
        check_close(study.peak[i], v->peak, 0);
        check_close(study.momentum[i], v->momentum, 0);
        check_close(study.beam_momentum[i],
                    sensor_beam_momentum(&s.parameters, v->speed, MOMENTUM_WINDOW), 0);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            check_close(study.sensed[k][i], v->sensed[k], 0);
            check_close(study.beam_peak[k][i],
                        sensor_beam_peak(&s.parameters, v->speed, sensor_constants[k]), 0);
        }
    }
}

// What a run of the same arm comes to, by its rows and events: momentum, impacts, and a lag that is
// stepped finely through all of it.
TEST(a_view_is_what_a_run_comes_to)
{
    static const int links[] = {2, 3, 6};
    for (int kind = 0; kind < 6; kind++) {
        scenario s = fast_touch();
        s.parameters = parameters_with(
            "wall.kind=plane motor.voltage=5 run.duration=0.5 arm.links=%d %s method.step=1e-5",
            links[kind % 3], kind < 3 ? "wall.restitution=0" : "wall.restitution=0.3");
        const run_options options = {.keep_trace = true};
        SCOPED(run_finish) run_result r;
        sensor_view view;
        assert_int_equal(run_scenario_with(&s, &options, &r), STATUS_OK);
        DONE(sensor_view_compute(&s, links[kind % 3], NULL, &view, &f));
        const double touch = r.summary.first_contact_s, end = touch + SENSOR_WINDOW;
        assert_int_equal(view.links, links[kind % 3]);

        // the impacts in both windows
        double momentum = 0, first = (double)NAN, speed = (double)NAN;
        int impacts = 0;
        for (size_t i = 0; i < r.trace.event_count; i++) {
            const event *e = &r.trace.events[i];
            if (e->kind == EVENT_IMPACT && e->time <= end) {
                first = isnan(first) ? e->impulse : first;
                speed = isnan(speed) ? e->speed : speed;
                impacts += e->impulse > 0;
                momentum += e->time <= touch + MOMENTUM_WINDOW ? e->impulse : 0;
            }
        }
        check_relative(view.impulse, first, 1e-9);
        check_relative(view.speed, speed, 1e-9);
        check_close(view.impacts, impacts, 0);

        // forces and a lag of 1 ms between them
        double peak = 0, value = 0, largest = 0, largest_time = 0;
        size_t next = 0;
        for (size_t i = 0; i + 1 < r.trace.row_count; i++) {
            const sample *a = &r.trace.rows[i], *b = a + 1;
            for (; next < r.trace.event_count && r.trace.events[next].time <= a->time; next++) {
                const event *e = &r.trace.events[next];
                value += e->kind == EVENT_IMPACT && e->time <= end ? e->impulse / 1e-3 : 0;
            }
            if (a->time < touch || b->time > end + 1e-9) {
                continue;
            }
            if (value > largest) {
                largest = value;
                largest_time = a->time;
            }
            const double h = b->time - a->time, mean = (a->force + b->force) / 2;
            momentum += b->time <= touch + MOMENTUM_WINDOW + 1e-9 ? h * mean : 0;
            peak = fmax(peak, fmax(a->force, b->force));
            value = mean + (value - mean) * exp(-h / 1e-3);
        }
        check_relative(view.momentum, momentum, 1e-3);
        check_close(view.peak, peak, 1e-3 * peak);
        check_relative(view.sensed[1], largest, 1e-4);
        check_close(view.delay[1], largest_time - touch, 1e-5);
    }
}

// An arm that starts against the wall has touched it: its window opens with the run, also where it
// soon leaves.
TEST(an_arm_against_the_wall_is_felt_from_the_start)
{
    static const char *const walls[] = {"wall.contact=rigid", "wall.contact=kelvin-voigt"};
    for (int i = 0; i < 2; i++) {
        scenario s = fast_touch();
        s.parameters = parameters_with(
            "wall.kind=plane wall.angle=0.1 initial.angle=0.1 motor.voltage=5 arm.links=3 "
            "method.step=1e-5 run.duration=0.02 %s",
            walls[i]);
        const run_options options = {.keep_trace = true};
        SCOPED(run_finish) run_result r;
        sensor_view view;
        assert_int_equal(run_scenario_with(&s, &options, &r), STATUS_OK);
        check_close(r.summary.first_contact_s, 0, 0);
        DONE(sensor_view_compute(&s, 3, NULL, &view, &f));
        check_close(view.speed, 0, 0);
        check_close(view.impulse, 0, 0);
        check_relative(view.peak, r.summary.peak_force_N, 1e-6);

        // momentum and a lag of 1 ms by the run's rows
        double momentum = 0, value = 0, largest = 0;
        for (size_t k = 0; k + 1 < r.trace.row_count; k++) {
            const sample *a = &r.trace.rows[k], *b = a + 1;
            const double h = b->time - a->time, mean = (a->force + b->force) / 2;
            momentum += b->time <= MOMENTUM_WINDOW + 1e-9 ? h * mean : 0;
            value = mean + (value - mean) * exp(-h / 1e-3);
            largest = fmax(largest, value);
        }
        check_relative(view.momentum, momentum, 1e-3);
        check_relative(view.sensed[1], largest, 1e-3);
    }
}

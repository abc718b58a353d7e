// The force that the rig predicts for a touch at every sample: from hub readings alone it
// says what the predictor says of the true state, and a law that keeps to it keeps the
// impact below a limit.

#include "src/predict/predict.h"
#include "src/rig/estimation/touch_forecast.h"
#include "tests/rig_fixture.h"

// The predictor's answer for the true state of a row.
static double predicted_of(const parameters *p, const sample *row)
{
    parameters now = *p;
    prediction touch;
    const three_body_state state = {{row->hub_angle, row->first_angle, row->last_angle},
                                    {row->hub_velocity, row->first_velocity,
                                     row->last_velocity}};
    now.motor.voltage = row->voltage;
    assert_int_equal(predict_impact_dynamics(&now, &state, &touch, NULL), STATUS_OK);
    return touch.impulse > 0 && touch.force > 0 ? touch.force : 0;
}

// At a constant command the beam swings in flight; the rig derives it from the hub's
// readings.
TEST(readings_of_the_hub_say_what_the_state_says)
{
    const char *const volts[] = {"control.approach_voltage=1",
                                 "control.approach_voltage=4"};
    const char *const ways[] = {"initial.angle=-0.1", "initial.angle=-0.3"};
    for (int i = 0; i < 4; i++) {
        const char *const *const settings =
            given("sensor.ideal=true control.law=open-loop control.rate=1000 "
                  "control.force_limit=1 run.duration=0.6 %s %s",
                  volts[i & 1], ways[i >> 1]);
        const parameters p = rig_parameters(settings);
        KEPT_RUN(r) = rig_run(settings, true);
        double worst = 0, largest = 0;
        int compared = 0, turns = 0;

        // the second row of each sample has its answer; the tip of a beam that is set off
        // goes back at first, and the force begins where it turns
        for (size_t k = 2; k < r.trace.row_count; k++) {
            const sample *row = &r.trace.rows[k];
            if (row->time == row[-1].time && row->time < r.summary.first_contact_s) {
                const double truth = predicted_of(&p, row);
                const bool strikes = truth > 0, told = row->predicted_force > 0;
                turns += strikes != told;
                worst =
                    fmax(worst, strikes && told ? fabs(row->predicted_force - truth) : 0);
                largest = fmax(largest, truth);
                compared++;
            }
        }
        print_message("%s, %s: at most %.3g N off in %d samples, up to %.3g N\n",
                      volts[i & 1], ways[i >> 1], worst, compared, largest);
        assert_true(compared > 100);
        assert_true(turns <= 1);
        check_below(worst, 0.01 * largest);
    }
}

// It is there only with a limit, and only without contact.
TEST(there_is_none_in_contact_or_without_a_limit)
{
    RIG_RUN(with, "control.law=hybrid control.force_limit=1.5");
    RIG_RUN(without, "control.law=hybrid");
    for (EACH_ROW(row, &without.trace)) {
        assert_true(isnan(row->predicted_force));
    }

    // a sample after the touch the reading shows it
    for (EACH_ROW(row, &with.trace)) {
        if (row->time > 0.006 && row->time < with.summary.first_contact_s) {
            assert_true(row->predicted_force >= 0);
        } else if (row->time > with.summary.first_contact_s + 0.05) {
            assert_true(isnan(row->predicted_force));
        }
    }

    // the limit alone changes nothing for a law that does not ask
    assert_true(with.summary.peak_force_N == without.summary.peak_force_N);
}

// An arm that swings back is not on its way to the wall.
TEST(a_receding_tip_predicts_nothing)
{
    const parameters p =
        rig_parameters_with("control.law=open-loop control.force_limit=1");
    const controller_setup setup = {.torque_per_volt = 1,
                                    .hub_damping = 0.1,
                                    .stiction = p.motor.stiction,
                                    .hub_inertia = p.arm.hub_inertia,
                                    .link_mass = p.arm.mass / 2,
                                    .link_length = p.arm.length / 2,
                                    .link_inertia = p.arm.link_inertia,
                                    .k2 = p.arm.k2,
                                    .hub_spring = HUGE_VAL};
    touch_forecast t = {0};
    touch_forecast_tell(&t, &p, &setup);
    const controller_input away = {.encoder = -0.1, .tachometer = -0.5};
    const controller_input towards = {.time = 0.005, .encoder = -0.1, .tachometer = 0.5};
    const controller_input touching = {.time = 0.01,
                                       .encoder = 0,
                                       .tachometer = 0.5,
                                       .force = 1};
    assert_true(touch_forecast_sample(&t, &away) == 0);
    t.flies = false; // another flight, with a straight beam
    assert_true(touch_forecast_sample(&t, &towards) > 0);
    assert_true(isnan(touch_forecast_sample(&t, &touching)));
    assert_false(t.flies);
}

// The largest force in the first 0.15 s of contact under the law "speed-limit", which
// starts at an angle before the wall and limits the force [N] (0: no limit).
static double peak_under_speed_limit(double start_angle, double force_limit, int seed)
{
    RIG_RUN(r,
            "control.law=speed-limit control.force=0.3 control.speed_limit=100 "
            "control.approach_voltage=5 run.duration=1.6 initial.angle=%g "
            "control.force_limit=%g control.seed=%d",
            start_angle, force_limit, seed);
    const double touch = r.summary.first_contact_s;
    assert_true(touch > 0);
    double peak = 0;
    for (EACH_ROW(row, &r.trace)) {
        if (row->time >= touch && row->time < touch + 0.15) {
            peak = fmax(peak, row->force);
        }
    }
    return peak;
}

// From near and far and with noise the force at first contact stays below its limit, to
// within 5 %. Without a limit it is larger by a factor of two, or nearly so.
static void check_force_limit(double limit, double least_factor_without)
{
    for (EACH_OF(int, seed, 3, 4)) {
        for (EACH_OF(double, start, -0.1, -0.2, -0.4)) {
            const double with = peak_under_speed_limit(*start, limit, *seed);
            const double without = peak_under_speed_limit(*start, 0, *seed);
            print_message("%g N, from %g rad: %.3g N, without %.3g N\n", limit, *start,
                          with, without);
            check_below(with, 1.05 * limit);
            check_below(least_factor_without * limit, without);
        }
    }
}

TEST(the_speed_limit_law_keeps_to_a_force)
{
    check_force_limit(1, 2);
    check_force_limit(2, 2 / 1.2);
}

// What is told is what the predictor is asked with, and the bend between samples is that
// of its equation, whatever the hub does.
TEST(the_bend_obeys_its_equation)
{
    for (int kind = 0; kind < 4; kind++) {
        const bool spring = kind % 2;
        parameters p =
            rig_parameters_with("control.law=open-loop control.force_limit=1 "
                                "belief.torque_factor=1.1 belief.friction_factor=0.7");
        const controller_setup setup = {.stiction = 0.03,
                                        .hub_inertia = 6e-3,
                                        .link_mass = 0.19,
                                        .link_length = 0.6,
                                        .link_inertia = 5e-3,
                                        .k2 = 6,
                                        .hub_spring = spring ? 80 : HUGE_VAL,
                                        .damping_ratio = kind > 1 ? 0.02 : 0};
        touch_forecast t = {0};
        touch_forecast_tell(&t, &p, &setup);
        const double m33 = 5e-3 + 0.19 * 0.36 / 4, m32 = 0.19 * 0.36 / 2;
        check_relative(t.frequency * t.frequency, 6 / m33, 1e-14);
        check_relative(t.lag, 1 + m32 / m33, 1e-14);
        check_close(t.decay, setup.damping_ratio * t.frequency, 1e-14);
        const arm_parameters *a = &t.arm.arm;
        assert_int_equal(a->model, ARM_CORRECTED);
        assert_int_equal(a->links, 2);
        assert_int_equal(a->hub_joint, spring ? HUB_SPRING : HUB_RIGID);
        check_close(a->k1, spring ? 80 : p.arm.k1, 0);
        check_close(a->k2, 6, 0);
        check_close(a->mass, 0.38, 1e-16);
        check_close(a->link_inertia, 5e-3, 0);
        check_close(a->hub_inertia, 6e-3, 0);
        check_relative(t.arm.motor.torque_constant, 1.1 * p.motor.torque_constant, 1e-15);
        check_relative(t.arm.motor.viscous_friction, 0.7 * p.motor.viscous_friction,
                       1e-15);
        check_close(t.arm.motor.stiction, 0.03, 0);

        // samples at uneven times; between them many small steps of the equation
        double time = 0.3, bend = 0, rate = 0, hub = 0.5, before = hub;
        t.bend = 1;
        t.bend_rate = 1; // of another flight
        for (int k = 0; k < 40; k++) {
            const controller_input in = {.time = time,
                                         .encoder = -0.1 + 0.001 * k,
                                         .tachometer = hub,
                                         .force =
                                             k % 3 == 0 ? p.control.contact_threshold : 0,
                                         .voltage = 0.5 + 0.01 * k};
            const double told = touch_forecast_sample(&t, &in);
            check_close(t.bend, bend, kind > 1 ? 1e-14 : 1e-6);
            check_close(t.bend_rate, rate, kind > 1 ? 1e-12 : 1e-4);
            assert_true(t.flies);

            // the predictor itself, asked for the same state
            prediction touch;
            parameters asked = t.arm;
            asked.motor.voltage = in.voltage;
            const three_body_state now = {.angle = {in.encoder, in.encoder,
                                                    in.encoder + t.bend},
                                          .velocity = {hub, hub, hub + t.bend_rate}};
            assert_int_equal(predict_impact_dynamics(&asked, &now, &touch, NULL),
                             STATUS_OK);
            check_close(told, touch.impulse > 0 && touch.force > 0 ? touch.force : 0, 0);

            // a second look at the same instant changes nothing
            assert_true(touch_forecast_sample(&t, &in) == told);
            const double h = 0.003 + 0.001 * (k % 4);
            before = hub;
            hub = 0.5 + 0.3 * sin(0.4 * k);
            for (int step = 0; step < 4000 && kind < 2; step++) {
                const double s = h / 4000;
                rate +=
                    s * (-t.lag * (hub - before) / h - t.frequency * t.frequency * bend);
                bend += s * rate;
            }

            // damping shrinks the turn about the bend that the acceleration holds
            if (kind > 1) {
                const double f = t.frequency,
                             held = -t.lag * (hub - before) / (h * f * f);
                const double left = exp(-t.decay * h), away = bend - held,
                             turn = rate / f;
                bend = held + left * (away * cos(f * h) + turn * sin(f * h));
                rate = f * left * (turn * cos(f * h) - away * sin(f * h));
            }
            time += h;
        }

        // above the threshold it touches, and the next flight begins straight
        const controller_input touching = {.time = time,
                                           .force = 1.001 * p.control.contact_threshold};
        assert_true(isnan(touch_forecast_sample(&t, &touching)));
        assert_false(t.flies);
        const controller_input free_again = {.time = time + 0.01, .tachometer = 0.4};
        touch_forecast_sample(&t, &free_again);
        check_close(fabs(t.bend) + fabs(t.bend_rate), 0, 0);
    }
}

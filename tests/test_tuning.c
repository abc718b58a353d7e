// Parameters of the rig that change during a run: they hold from the next sample on, and
// nothing before it is any different.
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"
#include "tests/session_fixture.h"

// Rows before an instant are the same to the last bit, and some after it differ.
static void assert_changes_from(const run_result *before, const run_result *after,
                                double time, double until)
{
    const trace *a = &before->trace, *b = &after->trace;
    bool differ = false;
    double first = HUGE_VAL;
    for (size_t i = 0; i < a->row_count && i < b->row_count && !differ; i++) {
        differ = memcmp(&a->rows[i], &b->rows[i], sizeof a->rows[i]) != 0;
        first = fmin(a->rows[i].time, b->rows[i].time);
    }
    assert_true(differ);
    assert_true(first >= time - 1e-12 && first <= until);
}

TEST(test_a_gain_holds_from_the_next_sample_on)
{
    static const struct {
        const char *path, *value;
        double at;
    } changes[] = {
        {"control.kp", "20", 0.4},         {"control.kv", "0.1", 0.4},
        {"control.force", "1.5", 0.8},     {"control.transition_time", "0.5", 0.4},
        {"sensor.fsr_noise", "0.05", 0.4}, {"control.approach_voltage", "0.8", 0.1},
        {"control.delay", "0.002", 0.4},   {"belief.k2_factor", "0.8", 0.8},
        {"motor.voltage_limit", "1", 0.5}, {"sensor.tachometer_noise", "0.2", 0.4},
    };
    for (EACH(c, changes)) {
        OPEN_SESSION(s, "compare/hybrid");
        session_seek(&s, c->at + 0.0021);
        DONE(session_keep_beside(&s, &s.run, &f));
        change(&s, c->path, c->value);
        assert_int_equal(s.inputs[0].kind, SESSION_INPUT_TIMED);

        // the change itself has a row; then nothing is felt before a sample, at most two
        // periods on
        assert_changes_from(&s.other, &s.run, s.inputs[0].time,
                            s.inputs[0].time + 0.0101);
    }
}

TEST(test_another_rate_samples_at_its_own_period)
{
    OPEN_SESSION(s, "compare/hybrid");
    session_seek(&s, 0.502);
    change(&s, "control.rate", "50");
    const trace *t = &s.run.trace;
    double last = -1, command = (double)NAN;
    int samples = 0;
    for (size_t i = 0; i < t->row_count && t->rows[i].time < 0.64; i++) {
        if (t->rows[i].time > 0.503 && t->rows[i].command != command) {
            if (last > 0.503) {
                const double periods = (t->rows[i].time - last) / 0.02;
                check_close(periods, round(periods), 1e-6);
                samples++;
            }
            last = t->rows[i].time;
        }
        command = t->rows[i].command;
    }
    assert_true(samples >= 3);
}

// The rate changes again and again. A sample comes one period of the rate that holds then
// after the one before; an equal rate moves nothing.
TEST(test_rates_that_change_again_and_again)
{
    static const struct {
        double time, rate;
    } changes[] = {{0.0137, 50}, {0.0503, 200},  {0.0588, 125}, {0.0652, 40},
                   {0.0653, 40}, {0.1401, 62.5}, {0.1523, 30},  {0.2411, 45},
                   {0.3009, 20}, {0.5201, 25}};
    enum { CHANGES = sizeof changes / sizeof changes[0] };
    parameters p = rig_parameters(SETTINGS("control.law=hybrid", "sensor.ideal=true"));
    rig *r;
    DONE(rig_create(&r, &p, NULL, &f));
    const sensed_motion at_rest = {.angle = -0.1};

    // the first sample is at the start
    double expected = 0, last = 0;
    int samples = 0;
    for (int i = 0; i <= CHANGES; i++) {
        const double until = i < CHANGES ? changes[i].time : 0.8;
        while (rig_next_time(r) <= until) {
            const double now = rig_next_time(r);
            const long before = r->samples;
            bool changed;
            DONE(rig_act(r, now, &at_rest, &changed, &f));
            if (r->samples > before) {
                check_close(now, expected, 1e-12);
                last = now;
                expected = last + 1 / p.control.rate;
                samples++;
            }
        }
        if (i < CHANGES) {
            p.control.rate = changes[i].rate;
            DONE(rig_retune(r, &p, until, &f));
            expected = last + 1 / p.control.rate;
            assert_true(expected >= until);
        }
    }
    assert_true(samples > 25);

    // where that period is over already, the next sample is at the change, and those
    // after it follow in the new period
    p.control.rate = 1000;
    assert_true(last + 1e-3 < 0.8);
    DONE(rig_retune(r, &p, 0.8, &f));
    for (int i = 0; i < 10; i++) {
        const double now = rig_next_time(r);
        const long before = r->samples;
        bool changed;
        DONE(rig_act(r, now, &at_rest, &changed, &f));
        assert_int_equal(r->samples, before + 1);
        check_close(now, 0.8 + i * 1e-3, 1e-12);
    }
    rig_destroy(r);
}

static int times_told;

static const char *count_telling(void *memory, const controller_setup *setup)
{
    (void)memory;
    assert_non_null(setup);
    times_told++;
    return NULL;
}

// A controller hears of what concerns it, once, and of nothing else: not of the arm, its
// sensors or parameters that are what they were.
TEST(test_a_controller_is_told_what_changed_for_it)
{
    static const struct {
        const char *path, *text;
        bool told;
    } changes[] = {
        {"arm.k2", "5", false},
        {"sensor.fsr_noise", "0.02", false},
        {"motor.voltage", "0.7", false},
        {"wall.angle", "0.4", false},
        {"control.kp", "11", true},
        {"control.force", "1.7", true},
        {"belief.k2_factor", "1.1", true},
        {"motor.voltage_limit", "4", true},
        {"control.rate", "150", true},
    };
    parameters p = rig_parameters(SETTINGS("control.law=hybrid"));
    rig *r;
    DONE(rig_create(&r, &p, NULL, &f));
    controller counting = *r->law;
    counting.tune = count_telling;
    r->law = &counting;
    for (EACH(c, changes)) {
        times_told = 0;
        DONE(rig_retune(r, &p, 0, &f));
        assert_int_equal(times_told, 0);
        DONE(parameter_set_text(&p, parameter_find(c->path), c->text, &f));
        DONE(rig_retune(r, &p, 0, &f));
        assert_int_equal(times_told, c->told);
    }
    rig_destroy(r);
}

// A ramp leads where a step does, later; a wave makes the force swing at its frequency.
TEST(test_setpoints_are_steps_ramps_and_waves)
{
    session step, ramp, wave;
    open_session(&step, "compare/force-integral");
    open_session(&ramp, "compare/force-integral");
    open_session(&wave, "compare/force-integral");
    session *all[] = {&step, &ramp, &wave};
    for (int i = 0; i < 3; i++) {
        change(all[i], "run.duration", "6");
        session_seek(all[i], 2);
    }
    change(&ramp, "control.force_rate", "1");
    change(&step, "control.force", "1.5");
    change(&ramp, "control.force", "1.5");
    const sample *at = &step.run.trace.rows[trace_row_at(&step.run.trace, 2.1)];
    const sample *slow = &ramp.run.trace.rows[trace_row_at(&ramp.run.trace, 2.1)];
    check_below(slow->command, at->command);
    const trace *a = &step.run.trace, *b = &ramp.run.trace;
    check_close(LAST_ROW(b)->force, LAST_ROW(a)->force, 0.05);

    change(&wave, "control.force_amplitude", "0.3");
    change(&wave, "control.force_frequency", "0.5");
    double low = HUGE_VAL, high = -HUGE_VAL;
    const trace *t = &wave.run.trace;
    for (size_t i = trace_row_at(t, 3.5); i < t->row_count; i++) {
        low = fmin(low, t->rows[i].force);
        high = fmax(high, t->rows[i].force);
    }
    check_below(0.2, high - low);
    for (int i = 0; i < 3; i++) {
        session_finish(all[i]);
    }
}

// The force between two instants of a run: its extremes.
static void extremes_of(const trace *t, double from, double to, double *low, double *high)
{
    *low = HUGE_VAL;
    *high = -HUGE_VAL;
    for (EACH_ROW(row, t)) {
        if (row->time > from && row->time <= to) {
            *low = fmin(*low, row->force);
            *high = fmax(*high, row->force);
        }
    }
}

// In contact every law that feeds anything back follows a step of half a newton within
// 0.15 s and a tenth (admittance an eighth) of overshoot, a ramp within 12 %, a wave of 1
// Hz within 15 % and six degrees, and holds its force on a wall that comes and goes by a
// millimetre.
TEST(test_every_law_follows_its_set_point)
{
    for (EACH_TEXT(c, "hybrid", "recovering", "speed-limit", "reverse-torque",
                   "bang-bang", "force-pd", "impedance", "admittance", "discontinuous",
                   "optimal", "predictive", "observer")) {
        session step, ramp, wave, wall;
        session *all[] = {&step, &ramp, &wave, &wall};
        for (int k = 0; k < 4; k++) {
            open_session(all[k], formatted("compare/%s", *c));
            change(all[k], "run.duration", k == 0 ? "4" : "6");
        }
        double low, high;
        change(&wall, "wall.motion", "sine");
        session_seek(&wall, 6);
        extremes_of(&wall.run.trace, 3, 6, &low, &high);
        fail_if(low < 0.9 || high > 1.1, "%s: %g to %g N on a moving wall", *c, low,
                high);

        session_seek(&step, 2);
        change(&step, "control.force", "1.5");
        session_seek(&step, 4);
        extremes_of(&step.run.trace, 2.15, 4, &low, &high);
        fail_if(low < 1.425 || high > 1.575, "%s: %g to %g N after a step", *c, low,
                high);
        extremes_of(&step.run.trace, 2, 4, &low, &high);
        fail_if(high > 1.565, "%s: over by %g N", *c, high - 1.5);

        session_seek(&ramp, 2);
        change(&ramp, "control.force_rate", "5");
        change(&ramp, "control.force", "3");
        session_seek(&ramp, 3);
        const trace *t = &ramp.run.trace;
        for (double time = 2.1; time < 2.4; time += 5e-3) {
            const double is = t->rows[trace_row_at(t, time)].force,
                         wanted = 1 + 5 * (time - 2);
            fail_if(fabs(is - wanted) > 0.12 * wanted, "%s: %g N at %g s for %g N", *c,
                    is, time, wanted);
        }

        change(&wave, "control.force_amplitude", "0.2");
        session_seek(&wave, 6);
        double in_phase = 0, across = 0, before = 3;
        t = &wave.run.trace;
        for (size_t k = trace_row_at(t, 3); k < t->row_count; k++) {
            const sample *row = &t->rows[k];
            const double part = 2.0 / 3 * row->force * (row->time - before) / 0.2;
            in_phase += part * sin(2 * M_PI * row->time);
            across += part * cos(2 * M_PI * row->time);
            before = row->time;
        }
        fail_if(fabs(hypot(in_phase, across) - 1) > 0.15 ||
                    fabs(atan2(across, in_phase)) > 0.1,
                "%s: a wave of %g, %g", *c, in_phase, across);
        for (int k = 0; k < 4; k++) {
            session_finish(all[k]);
        }
    }
}

// The force that is wanted at an instant: as far along the ramp as its rate allows, up or
// down, the wave upon it, and never below zero.
TEST(test_the_wanted_force_is_its_ramp_and_its_wave)
{
    for (int kind = 0; kind < 4; kind++) {
        const double rate = kind & 1 ? 2 : 0, amplitude = kind & 2 ? 0.4 : 0;
        parameters p = rig_parameters(SETTINGS("control.law=hybrid", "control.force=1",
                                               "control.force_frequency=3"));
        p.control.force_rate = rate;
        p.control.force_amplitude = amplitude;
        rig *r;
        DONE(rig_create(&r, &p, NULL, &f));
        double ramp = 1;
        check_close(r->wanted_force, 1, 0);
        for (int k = 0; k < 300; k++) {
            const double time = 0.01 * k, before = 0.01 * (k - 1);
            if (k == 50 || k == 150) {
                p.control.force = k == 50 ? 2.5 : 0.2;
                DONE(rig_retune(r, &p, time, &f));
            }
            const double way = p.control.force - ramp,
                         most = rate * (k > 0 ? time - before : 0);
            ramp = rate == 0 || fabs(way) <= most ? p.control.force
                   : way > 0                      ? ramp + most
                                                  : ramp - most;
            DONE(rig_follow_setpoint(r, time, &f));
            check_close(r->ramp, ramp, 1e-12);
            check_close(r->ramp_time, time, 0);
            const double wave = amplitude * sin(2 * M_PI * 3 * time);
            check_close(r->wanted_force, fmax(ramp + wave, 0), 1e-12);
        }
        rig_destroy(r);
    }
}

// What a change of the rig's own numbers makes of delay, jitter, limits and periods.
TEST(test_delays_and_limits_follow_a_change)
{
    parameters p =
        rig_parameters(SETTINGS("control.law=hybrid", "control.delay=1e-3",
                                "control.delay_periods=0.25", "control.rate=200"));
    rig *r;
    DONE(rig_create(&r, &p, NULL, &f));
    check_close(r->delay, 1e-3 + 0.25 / 200, 1e-15);
    check_close(r->period, 5e-3, 1e-17);
    p.control.delay = 2e-3;
    p.control.jitter = 1e-4;
    p.motor.voltage_limit = 3;
    DONE(rig_retune(r, &p, 0, &f));
    check_close(r->delay, 2e-3 + 0.25 / 200, 1e-15);
    check_close(r->jitter, 1e-4, 0);
    check_close(r->voltage_limit, 3, 0);
    check_close(r->dac.range, 3, 0);
    p.control.rate = 100;
    p.control.delay_periods = 0.5;
    DONE(rig_retune(r, &p, 0, &f));
    check_close(r->delay, 2e-3 + 0.5 / 100, 1e-15);
    check_close(r->period, 1e-2, 1e-17);

    // before the first sample the clock begins as it would have
    check_close(r->clock_start, 0, 0);
    check_close(r->sample_time, 0, 0);
    assert_int_equal(r->clock_samples, 0);

    // sensors alone do not ask the law
    p.sensor.dac_bits = 8;
    DONE(rig_retune(r, &p, 0, &f));
    check_relative(r->dac.step, 6.0 / 256, 1e-14);
    check_close(r->known.control.rate, 100, 0);
    rig_destroy(r);
}

TEST(test_a_law_that_plans_at_its_start_takes_no_dated_change)
{
    OPEN_SESSION(s, "compare/inverse-dynamics");
    session_seek(&s, 0.3);
    assert_false(rig_can_change(&s.effective.parameters, PARAMETER_INDEX(control.force)));
    change(&s, "control.force", "0.8");
    assert_int_equal(s.inputs[0].kind, SESSION_INPUT_START);
}

TEST(test_a_saved_tuned_run_is_the_same)
{
    OPEN_SESSION(s, "compare/hybrid");
    session_seek(&s, 0.4);
    change(&s, "control.kp", "14");
    session_seek(&s, 0.7);
    change(&s, "control.force", "1.4");
    free(save_and_compare(&s));
}

// Without a law, or under one that hears of every change, all of control.* may change at
// any time.
TEST(what_nobody_took_at_the_start_can_change)
{
    parameters p = fresh(ARM_CORRECTED);
    const int force = PARAMETER_INDEX(control.force);
    for (EACH_OF(int, c, LAW_NONE, LAW_PROCESS, LAW_HYBRID)) {
        p.control.law = *c;
        assert_true(rig_can_change(&p, force));
        assert_false(rig_can_change(&p, PARAMETER_INDEX(control.law)));
    }
    p.control.law = LAW_PLUGIN; // whose parameters are not known
    assert_false(rig_can_change(&p, force));

    // one that plans at its start has taken the limit of its command; of the arm it takes
    // no note
    p.control.law = LAW_INVERSE_DYNAMICS;
    assert_false(rig_can_change(&p, PARAMETER_INDEX(motor.voltage_limit)));
    assert_true(rig_can_change(&p, PARAMETER_INDEX(arm.k2)));
}

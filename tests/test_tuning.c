// Parameters of the rig that change during a run: they hold from the next sample on, and
// nothing before it is any different.
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"
#include "tests/session_fixture.h"

// Two runs have the same rows, to the last bit, before the instant `time`, and differ at
// the latest at the instant `until`.
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

// After a change to 50 Hz at 0.502 s the command changes only at instants that are whole
// periods of 20 ms apart.
TEST(test_another_rate_samples_at_its_own_period)
{
    OPEN_SESSION(s, "compare/hybrid");
    session_seek(&s, 0.502);
    change(&s, "control.rate", "50");

    const double changed = 0.503, period = 0.02;
    const trace *t = &s.run.trace;
    double last_time = -1, last_command = (double)NAN;
    int compared = 0;
    for (size_t i = 0; i < t->row_count && t->rows[i].time < 0.64; i++) {
        const sample *row = &t->rows[i];
        if (row->time > changed && row->command != last_command) {
            if (last_time > changed) {
                const double periods = (row->time - last_time) / period;
                check_close(periods, round(periods), 1e-6);
                compared++;
            }
            last_time = row->time;
        }
        last_command = row->command;
    }
    assert_true(compared >= 3);
}

// The rate changes again and again. Each sample comes one period after the sample before
// it, a period of the rate that holds by then; setting the rate it has moves nothing.
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
    double expected = 0, last_sample = 0;
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
                last_sample = now;
                expected = last_sample + 1 / p.control.rate;
                samples++;
            }
        }
        if (i < CHANGES) {
            p.control.rate = changes[i].rate;
            DONE(rig_retune(r, &p, until, &f));
            expected = last_sample + 1 / p.control.rate;
            assert_true(expected >= until);
        }
    }
    assert_true(samples > 25);

    // a period so short that it has passed since the last sample when it is set: the next
    // sample is at the change, and those after it follow in the new period
    p.control.rate = 1000;
    assert_true(last_sample + 1e-3 < 0.8);
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

// A controller's answer to a change of its parameters that only counts how often it is
// asked.
static const char *count_telling(void *memory, const controller_setup *setup)
{
    (void)memory;
    assert_non_null(setup);
    times_told++;
    return NULL;
}

// A controller hears once of each change of a parameter that it uses. It does not hear of
// a change of the arm or the sensors, nor of parameters that have the values they had.
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

    // the law with another function that hears of changes
    controller counting = *r->law;
    counting.tune = count_telling;
    r->law = &counting;
    for (EACH(c, changes)) {
        // nothing has changed
        times_told = 0;
        DONE(rig_retune(r, &p, 0, &f));
        assert_int_equal(times_told, 0);

        // one parameter has
        DONE(parameter_set_text(&p, parameter_find(c->path), c->text, &f));
        DONE(rig_retune(r, &p, 0, &f));
        assert_int_equal(times_told, c->told);
    }
    rig_destroy(r);
}

// A ramp of the commanded force leads to the same force as a step, only later; a wave
// makes the force swing.
TEST(test_setpoints_are_steps_ramps_and_waves)
{
    session step, ramp, wave;
    session *all[] = {&step, &ramp, &wave};
    for (int i = 0; i < 3; i++) {
        open_session(all[i], "compare/force-integral");
        change(all[i], "run.duration", "6");
        session_seek(all[i], 2);
    }

    // from 1 N to 1.5 N at 2 s, at once and at 1 N/s
    change(&ramp, "control.force_rate", "1");
    change(&step, "control.force", "1.5");
    change(&ramp, "control.force", "1.5");

    // in the middle of the ramp the command is below that of the step
    const trace *stepped = &step.run.trace, *ramped = &ramp.run.trace;
    check_below(ramped->rows[trace_row_at(ramped, 2.1)].command,
                stepped->rows[trace_row_at(stepped, 2.1)].command);

    // in the end the forces are the same
    check_close(LAST_ROW(ramped)->force, LAST_ROW(stepped)->force, 0.05);

    // a wave of 0.3 N, which is 0.6 N from crest to trough: a third of it is felt at
    // least
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

// The lowest and the highest force of the rows with from < t <= to.
static void find_force_extremes(const trace *t, double from, double to, double *low,
                                double *high)
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

// On a wall that moves to and fro by a millimetre the force stays within a tenth of the
// newton that is commanded.
static void check_force_on_moving_wall(const char *law)
{
    double low, high;
    OPEN_SESSION(s, formatted("compare/%s", law));
    change(&s, "run.duration", "6");
    change(&s, "wall.motion", "sine");
    session_seek(&s, 6);
    find_force_extremes(&s.run.trace, 3, 6, &low, &high);
    fail_if(low < 0.9 || high > 1.1, "%s: %g to %g N on a moving wall", law, low, high);
}

// A step from 1 N to 1.5 N at 2 s: 0.15 s later the force is within 5 % of the new one
// for good, and it never overshoots by more than 0.065 N, about an eighth of the step.
static void check_force_after_step(const char *law)
{
    double low, high;
    OPEN_SESSION(s, formatted("compare/%s", law));
    change(&s, "run.duration", "4");
    session_seek(&s, 2);
    change(&s, "control.force", "1.5");
    session_seek(&s, 4);

    // settled
    find_force_extremes(&s.run.trace, 2.15, 4, &low, &high);
    fail_if(low < 1.425 || high > 1.575, "%s: %g to %g N after a step", law, low, high);

    // the overshoot
    find_force_extremes(&s.run.trace, 2, 4, &low, &high);
    fail_if(high > 1.565, "%s: over by %g N", law, high - 1.5);
}

// A ramp of 5 N/s from 1 N to 3 N that begins at 2 s: from 0.1 s after its beginning to
// its end at 2.4 s the force is within 12 % of the ramp.
static void check_force_along_ramp(const char *law)
{
    OPEN_SESSION(s, formatted("compare/%s", law));
    change(&s, "run.duration", "6");
    session_seek(&s, 2);
    change(&s, "control.force_rate", "5");
    change(&s, "control.force", "3");
    session_seek(&s, 3);
    const trace *t = &s.run.trace;
    for (double time = 2.1; time < 2.4; time += 5e-3) {
        const double force = t->rows[trace_row_at(t, time)].force,
                     wanted = 1 + 5 * (time - 2);
        fail_if(fabs(force - wanted) > 0.12 * wanted, "%s: %g N at %g s for %g N", law,
                force, time, wanted);
    }
}

// The part of the force between `from` and the run's end that swings at 1 Hz, as
// in_phase * sin(2 pi t) + across * cos(2 pi t), in newtons. These are the Fourier
// coefficients over a whole number of periods: twice the mean of the force times the sine
// or the cosine. Each row counts for the time since the row before it.
static void find_wave_of_1_Hz(const trace *t, double from, double *in_phase,
                              double *across)
{
    const double span = LAST_ROW(t)->time - from;
    double time_before = from;
    *in_phase = *across = 0;
    for (size_t i = trace_row_at(t, from); i < t->row_count; i++) {
        const sample *row = &t->rows[i];
        const double part = 2 * row->force * (row->time - time_before) / span;
        *in_phase += part * sin(2 * M_PI * row->time);
        *across += part * cos(2 * M_PI * row->time);
        time_before = row->time;
    }
}

// A wave of 0.2 N at 1 Hz upon the commanded force comes out with its amplitude to 15 %
// and its phase to 0.1 rad, six degrees.
static void check_force_along_wave(const char *law)
{
    const double commanded = 0.2;
    double in_phase, across;
    OPEN_SESSION(s, formatted("compare/%s", law));
    change(&s, "run.duration", "6");
    change(&s, "control.force_amplitude", "0.2");
    session_seek(&s, 6);
    find_wave_of_1_Hz(&s.run.trace, 3, &in_phase, &across);
    fail_if(fabs(hypot(in_phase, across) / commanded - 1) > 0.15 ||
                fabs(atan2(across, in_phase)) > 0.1,
            "%s: a wave of %g N in phase, %g N across", law, in_phase, across);
}

// Every law that feeds something back makes the force in contact follow what is
// commanded.
TEST(test_every_law_follows_its_set_point)
{
    for (EACH_TEXT(law, "hybrid", "recovering", "speed-limit", "reverse-torque",
                   "bang-bang", "force-pd", "impedance", "admittance", "discontinuous",
                   "observer")) {
        check_force_on_moving_wall(*law);
        check_force_after_step(*law);
        check_force_along_ramp(*law);
        check_force_along_wave(*law);
    }
}

// Its plan takes a quarter of a second to a step, longer than the others.
TEST(test_touch_follows_walls_ramps_and_waves)
{
    check_force_on_moving_wall("touch");
    check_force_along_ramp("touch");
    check_force_along_wave("touch");
}

// `from` after it has moved towards `to` by `most` at most.
static double moved_towards(double to, double from, double most)
{
    const double distance = to - from;
    if (fabs(distance) <= most) {
        return to;
    }
    return from + copysign(most, distance);
}

// The rig's wanted force over 3 s in which the commanded one rises from 1 N to 2.5 N and
// falls to 0.2 N. It is a ramp, which moves towards the commanded force at `rate` [N/s]
// (at once where the rate is 0), and a wave of 3 Hz upon it, but never below zero.
static void check_wanted_force(double rate, double amplitude)
{
    parameters p = rig_parameters(
        SETTINGS("control.law=hybrid", "control.force=1", "control.force_frequency=3"));
    p.control.force_rate = rate;
    p.control.force_amplitude = amplitude;
    rig *r;
    DONE(rig_create(&r, &p, NULL, &f));
    check_close(r->wanted_force, 1, 0);

    const double step = 0.01;
    double ramp = 1;
    for (int k = 0; k < 300; k++) {
        // the commanded force changes at 0.5 s and at 1.5 s
        const double time = step * k;
        if (k == 50) {
            p.control.force = 2.5;
            DONE(rig_retune(r, &p, time, &f));
        } else if (k == 150) {
            p.control.force = 0.2;
            DONE(rig_retune(r, &p, time, &f));
        }

        // the ramp
        if (rate == 0) {
            ramp = p.control.force;
        } else if (k > 0) {
            ramp = moved_towards(p.control.force, ramp, rate * step);
        }
        DONE(rig_follow_setpoint(r, time, &f));
        check_close(r->ramp, ramp, 1e-12);
        check_close(r->ramp_time, time, 0);

        // the wave upon it
        const double wave = amplitude * sin(2 * M_PI * 3 * time);
        check_close(r->wanted_force, fmax(ramp + wave, 0), 1e-12);
    }
    rig_destroy(r);
}

TEST(test_the_wanted_force_is_its_ramp_and_its_wave)
{
    check_wanted_force(0, 0);
    check_wanted_force(2, 0);
    check_wanted_force(0, 0.4);
    check_wanted_force(2, 0.4);
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

    // delay, jitter and the limit of the voltage, which is the converter's range too
    p.control.delay = 2e-3;
    p.control.jitter = 1e-4;
    p.motor.voltage_limit = 3;
    DONE(rig_retune(r, &p, 0, &f));
    check_close(r->delay, 2e-3 + 0.25 / 200, 1e-15);
    check_close(r->jitter, 1e-4, 0);
    check_close(r->voltage_limit, 3, 0);
    check_close(r->dac.range, 3, 0);

    // the rate, whose period is part of the delay
    p.control.rate = 100;
    p.control.delay_periods = 0.5;
    DONE(rig_retune(r, &p, 0, &f));
    check_close(r->delay, 2e-3 + 0.5 / 100, 1e-15);
    check_close(r->period, 1e-2, 1e-17);

    // a change before the first sample leaves the beginning of the clock where it was
    check_close(r->clock_start, 0, 0);
    check_close(r->sample_time, 0, 0);
    assert_int_equal(r->clock_samples, 0);

    // a change of a sensor alone does not ask the law, and keeps what it knows
    p.sensor.dac_bits = 8;
    DONE(rig_retune(r, &p, 0, &f));
    check_relative(r->dac.step, 6.0 / 256, 1e-14);
    check_close(r->known.control.rate, 100, 0);
    rig_destroy(r);
}

// A law that plans its whole command at the start cannot take a change in the course of
// the run: the change applies from the start instead.
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

// Without a law, or under a law that hears of every change, all of control.* but the law
// itself may change at any time.
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

    // a law that plans at its start has used the limit of the voltage for it, but not the
    // arm's stiffness
    p.control.law = LAW_INVERSE_DYNAMICS;
    assert_false(rig_can_change(&p, PARAMETER_INDEX(motor.voltage_limit)));
    assert_true(rig_can_change(&p, PARAMETER_INDEX(arm.k2)));
}

// The sampled loop.
#include "src/rig/rig.h"
#include "src/contact/contact_machine.h"
#include "tests/rig_fixture.h"

TEST(command_holds_between_samples)
{
    RIG_RUN(r, "control.law=hybrid");
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
}

TEST(delay_shifts_the_command)
{
    RIG_RUN(r, "control.law=hybrid control.delay=0.002");
    const trace *t = &r.trace;
    for (size_t i = 1; i < t->row_count; i++) {
        if (t->rows[i].voltage != t->rows[i - 1].voltage) {
            double since = t->rows[i].time * 200;
            check_close(since - floor(since), 0.002 * 200, 1e-6);
        }
    }
}

// A command that is still on its way when the run ends has moved nothing: the largest is
// the largest of the rows.
TEST(a_command_still_on_its_way_does_not_count)
{
    for (EACH_TEXT(c, "run.duration=0.32", "run.duration=0.3102", "run.duration=0.305")) {
        RIG_RUN(r,
                "control.law=force-pd control.force_gain=5 "
                "control.delay=0.003068 control.seed=423 %s",
                *c);
        double largest = 0;
        for (EACH_ROW(row, &r.trace)) {
            largest = fmax(largest, fabs(row->voltage));
        }
        check_close(r.summary.largest_command_V, largest, 0);
    }
}

// A program that takes a whole period to compute: its command goes out with the next
// sample, also where jitter brings that one early.
TEST(a_command_a_period_late_goes_out_with_the_next_sample)
{
    for (EACH_TEXT(c, "control.jitter=0", "control.jitter=0.002")) {
        rig *r;
        bool changed;
        double latest = 0;
        parameters p = rig_parameters_with(
            "control.law=force-pd control.delay_periods=1 %s sensor.ideal=true", *c);
        DONE(rig_create(&r, &p, NULL, &f));
        for (int i = 0; i < 300; i++) {
            // forces that never repeat, so that every command is another one
            sensed_motion now = {.force = 0.5 + 0.003 * i};
            long samples = r->samples;
            DONE(rig_act(r, rig_next_time(r), &now, &changed, &f));
            if (r->samples == samples) {
                continue; // only a command took effect
            }
            assert_true(r->voltage == latest || samples == 0);
            assert_true(r->pending[0] != r->voltage);
            latest = r->pending[0];
        }
        rig_destroy(r);
    }
}

// Commands that are several periods under way keep their order and their delay, also
// where samples scatter over the whole period; with a delay of whole periods they go out
// at a sample at the latest.
TEST(commands_of_several_periods_go_out_in_order)
{
    const char *const delays[] = {"control.delay_periods=2.5", "control.delay_periods=5"};
    const char *const jitters[] = {"control.jitter=0", "control.jitter=0.005"};
    for (int k = 0; k < 4; k++) {
        rig *r;
        bool changed;
        double wanted[64] = {0}, taken[64] = {0}, before = -1;
        int out = 0, samples = 0;
        parameters p = rig_parameters_with("control.law=force-pd %s %s sensor.ideal=true",
                                           delays[k / 2], jitters[k % 2]);
        DONE(rig_create(&r, &p, NULL, &f));
        while (samples < 60) {
            const double time = rig_next_time(r);
            sensed_motion now = {.force = 0.5 + 0.003 * samples};
            DONE(rig_act(r, time, &now, &changed, &f));
            assert_true(time >= before);
            before = time;
            if (r->samples > samples) {
                wanted[samples] = r->output.command;
                taken[samples++] = time;
            }
            if (changed && out < samples && r->voltage == wanted[out]) {
                check_below(time - taken[out], r->delay + 1e-9);
                check_below(k % 2 == 0 ? r->delay : r->delay - 0.005,
                            time - taken[out] + 1e-9);
                out++;
            }
        }
        assert_in_range(out, 54, 58);
        rig_destroy(r);
    }
}

TEST(a_delay_is_at_most_five_periods)
{
    scenario s = {.parameters = rig_parameters_with("control.delay=0.003")};
    DONE(scenario_override(&s, "control.delay_periods=4.4", &f));
    REFUSED(STATUS_BAD_SCENARIO, "together longer than 5 periods of 0.005 s",
            scenario_override(&s, "control.delay_periods=4.5", &f));
}

TEST(jitter_stays_within_its_width)
{
    rig *r;
    bool changed;
    double widest = 0;
    parameters p = rig_parameters_with("control.law=open-loop control.jitter=0.001");
    DONE(rig_create(&r, &p, NULL, &f));
    for (int i = 0; i < 500; i++) {
        double time = rig_next_time(r), off = time - i * 0.005;
        check_below(fabs(off), 0.0005 + 1e-12);
        widest = fmax(widest, fabs(off));
        DONE(rig_act(r, time, &(sensed_motion){0}, &changed, &f));
        assert_int_equal(changed, i == 0);
    }
    check_below(0.00045, widest);
    rig_destroy(r);
}

TEST(rig_changes_the_bare_arm_only_by_its_converter)
{
    summary bare = rig_summary_with("control.law=none");
    summary on = rig_summary_with("control.law=open-loop sensor.ideal=true");
    check_close(on.first_contact_s, bare.first_contact_s, 1e-9);
    check_relative(on.peak_force_N, bare.peak_force_N, 1e-6);
    check_close(on.impacts, bare.impacts, 0);
    // and what the amplifier feeds in is at least the motor's mechanical work
    check_below(on.motor_work_J, on.electrical_energy_J);
    assert_true(isnan(bare.force_command_N));
}

// What the amplifier feeds in is what the rows say, before and after a script lowers its
// limit.
TEST(energy_under_a_limit_that_changes)
{
    static const char *const models[] = {"arm.model=corrected", "arm.model=printed"};
    for (int i = 0; i < 2; i++) {
        scenario s = SCRIPTED(
            rig_parameters_with("%s control.law=open-loop control.approach_voltage=5",
                                models[i]),
            SETS(0.5, motor.voltage_limit, 1));
        KEPT_RUN(r) = run_done(&s, true);

        // the printed arm's row has the voltage of the step before it
        const motor_parameters *m = &s.parameters.motor;
        double energy = 0;
        for (size_t k = 1; k < r.trace.row_count; k++) {
            const sample *to = &r.trace.rows[k], *from = to - 1;
            const double volts = m->amplifier_gain * (i ? to : from)->voltage;
            const double turn = to->hub_angle - from->hub_angle;
            energy += volts / m->resistance *
                      (volts * (to->time - from->time) - m->back_emf * turn);
        }
        check_relative(r.summary.electrical_energy_J, energy, 1e-10);
    }
}

// Errors are those from the force that is commanded at the end.
TEST(errors_are_from_the_last_command)
{
    scenario s = SCRIPTED(rig_parameters_with("control.law=force-pd run.duration=3"),
                          SETS(1, control.force, 2));
    KEPT_RUN(r) = run_done(&s, false);
    const summary *m = &r.summary;
    check_close(m->force_command_N, 2, 0);
    check_close(m->steady_error_N, 0, 0.05);
    check_close(m->steady_error_N, m->steady_force_N - 2, 0);
    check_close(m->force_over_command_N, m->peak_force_N - 2, 0);
    check_close(m->smoothed_over_command_N, m->force_over_command_N, 0.02);
}

TEST(same_seed_same_bytes)
{
    RIG_RUN(a, "control.law=observer control.jitter=0.0005");
    RIG_RUN(b, "control.law=observer control.jitter=0.0005");
    RIG_RUN(c, "control.law=observer control.jitter=0.0005 control.seed=2");
    assert_int_equal(a.trace.row_count, b.trace.row_count);
    assert_memory_equal(a.trace.rows, b.trace.rows, a.trace.row_count * sizeof(sample));
    assert_true(a.summary.peak_force_N != c.summary.peak_force_N);
}

// A beam of twelve links bends further at the hub than two links with the same k2: the
// stiffness that the controller has to believe in, (5.26), is the one measured there.
TEST(many_links_want_their_own_stiffness)
{
    run_result r =
        rig_run(given("control.law=open-loop arm.links=12 run.duration=4"), true);
    const sample *last = LAST_ROW(&r.trace);
    double measured = last->force * 0.5 / (2 * last->first_angle);
    run_finish(&r);
    summary nominal =
        rig_summary_with("control.law=hybrid arm.links=12 run.duration=2.5");
    summary looked_up = rig_summary_with(
        "control.law=hybrid arm.links=12 belief.k2_factor=%.6g run.duration=2.5",
        measured / 4.92);
    check_below(nominal.steady_force_N, 0.8);
    check_close(looked_up.steady_force_N, 1, 0.12); // it still swings a little
}

// A stop of the run and a sample that differ by rounding are one instant: a stride
// between them would be too short for an implicit method.
TEST(instants_apart_by_rounding_are_one)
{
    summary s = rig_summary_with("control.law=hybrid arm.links=12 wall.kind=plane "
                                 "method.name=newmark run.duration=1.5");
    check_below(0, s.impacts);
}

// A hub that friction holds and a command that never stays: forty seconds of torque that
// jumps under a hub at rest, each jump a question of what sticks and what is touched.
TEST(a_command_that_alternates_passes_time)
{
    const char *const *const arms[] = {
        given("run.duration=40"), given("run.duration=4 motor.stiction=0.3"),
        given("run.duration=4 wall.kind=plane control.delay_periods=0.5"),
        given("run.duration=4 arm.hub_joint=spring")};
    const loop_options options = {.commanded = true};
    for (size_t i = 0; i < sizeof arms / sizeof arms[0]; i++) {
        const scenario s = {.parameters = fixture_parameters(arms[i])};
        KEPT_LOOP(l);
        fault f = {.text = ""};
        assert_int_equal(loop_create(&l, &s, &options, &f), STATUS_OK);
        for (long k = 0; !loop_ended(l); k++) {
            loop_command(l, k % 2 ? 1.1 : 1);
            fail_if(loop_step(l, &f) != STATUS_OK, "arm %zu: %s", i, f.text);
        }
        assert_true(loop_summary(l).peak_force_N > 0.5);
        check_below(loop_summary(l).energy_residual_J, 1e-12);
    }
}

// What a lag of that time constant [s] makes of the motion without a rig, `after` the
// first contact [s]: its impulses, and its force in strides that grow by a twentieth of
// the time since.
static double lagged_force(const parameters *p, double time_constant, double after)
{
    STARTED(a, m, p, NULL, p->initial.angle, p->initial.velocity);

    double felt = 0, touched = -1, last = 0, end = p->run.duration;
    while (m->state[SLOT_TIME] < end) {
        motion_report report;
        const double from = m->state[SLOT_TIME],
                     had = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        const double until =
            touched < 0 ? end
                        : fmin(end, from + fmin(2e-6, fmax(1e-11, (from - last) / 20)));
        assert_int_equal(motion_step(&a, m, until, 1e-3, &report), STATUS_OK);
        const double length = m->state[SLOT_TIME] - from;
        const double gained = state_quadratures(m, m->state)[QUADRATURE_FORCE] - had;
        felt *= exp(-length / time_constant);
        felt += gained / time_constant * exp(-length / 2 / time_constant);
        if (report.event == MOTION_REACHED) {
            continue;
        }
        motion_apply(&a, m, &report);
        last = m->state[SLOT_TIME];
        if (report.event == MOTION_IMPACT) {
            felt += report.impulse / time_constant;
            end = touched < 0 ? last + after : end;
            touched = touched < 0 ? last : touched;
        }
    }
    return touched < 0 ? (double)NAN : felt;
}

// The modes of a strongly damped chain decay within nanoseconds of an impact, in which
// they press with thousands of newtons: a force sensor reads their impulse.
TEST(sensors_feel_the_spike_of_a_damped_chain)
{
    for (int i = 0; i < 4; i++) {
        const char *const *settings =
            given("arm.damping_ratio=%g arm.links=%d control.law=open-loop "
                  "control.rate=20000 method.step=5e-5 initial.angle=-0.001 "
                  "initial.velocity=1 run.duration=0.0015 sensor.piezo=true "
                  "sensor.piezo_gain=1e-3 sensor.piezo_leak_time=0 "
                  "sensor.piezo_range=0 sensor.piezo_noise=0 sensor.adc_bits=0 "
                  "sensor.dac_bits=0",
                  i % 2 ? 1 : 0.3, i / 2 ? 32 : 8);
        const parameters p = rig_parameters(settings);
        KEPT_RUN(run) = rig_run(settings, true);

        // the first readings after the touch
        const double touch = run.summary.first_contact_s;
        double compared = 0;
        for (size_t k = 0; k < run.trace.row_count && compared < 3; k++) {
            const sample *row = &run.trace.rows[k];
            const double after =
                row->time - touch - p.method.step; // read a sample before
            if (after > 4e-6 + compared * 5e-5) {
                const double rise = p.sensor.piezo_rise_time / log(9);
                check_relative(row->piezo_force, lagged_force(&p, rise, after), 2e-3);
                compared++;
            }
        }
        assert_true(compared == 3);
    }
}

// The approach speed is the largest of the whole flight, wherever strides end.
TEST(the_approach_speed_is_the_largest_of_the_flight)
{
    static const char *const arms[][8] = {
        {"control.law=observer", "control.approach_voltage=0.6569", "wall.angle=0.0502",
         "initial.angle=0", "arm.k2=53.36", "arm.damping_ratio=0.01",
         "control.force=0.855"},
        {"control.law=bang-bang", "control.approach_voltage=0.5618", "wall.angle=0.2352",
         "initial.angle=0", "arm.k2=2.873", "arm.damping_ratio=0.01",
         "control.force=3.196"}};
    for (EACH(c, arms)) {
        const char *settings[16] = {"control.rate=50", "wall.kind=plane",
                                    "motor.stiction=0", "sensor.ideal=true",
                                    "method.step=1e-4"};
        for (int k = 0; k < 7; k++) {
            settings[5 + k] = (*c)[k];
        }
        KEPT_RUN(r) = rig_run(settings, true);
        double fastest = 0;
        for (EACH_ROW(row, &r.trace)) {
            const bool after =
                row->time > r.summary.first_contact_s; // never, without one
            fastest = after ? fastest : fmax(fastest, -row->gap_velocity);
        }
        check_relative(r.summary.approach_speed_m_s, fastest, 1e-4);
    }
}

// What the rig shows never changes between rows of different instants, and times never go
// back: a sample and a command stand twice, before and after, on the grid of rows or
// between its rows, with jitter, delays, a current that lags, other methods and the
// printed model.
TEST(samples_and_commands_stand_twice)
{
    static const char *const kinds[] = {
        "control.rate=200",
        "control.rate=333 control.delay=0.0007",
        "control.rate=500 control.jitter=0.001 control.delay_periods=1.5",
        "control.rate=700 motor.inductance=0.01",
        "control.rate=200 method.name=newmark",
        "control.rate=200 arm.links=4 wall.contact=kelvin-voigt",
        "control.rate=200 arm.model=printed"};
    for (EACH(kind, kinds)) {
        RIG_RUN(r, "control.law=hybrid run.duration=0.5 %s", *kind);
        int samples = 0, commands = 0;
        for (size_t k = 1; k < r.trace.row_count; k++) {
            const sample *was = &r.trace.rows[k - 1], *is = was + 1;
            const bool reads =
                was->tachometer != is->tachometer && !isnan(was->tachometer);
            const bool sends = was->voltage != is->voltage;
            fail_if(is->time < was->time, "%s: %.17g s after %.17g s", *kind, is->time,
                    was->time);
            fail_if((reads || sends || was->command != is->command) &&
                        !isnan(was->command) && is->time != was->time,
                    "%s: a jump between %.17g and %.17g s", *kind, was->time, is->time);
            if (is->time == was->time) {
                check_close(is->hub_angle, was->hub_angle, 1e-12);
            }
            samples += reads;
            commands += sends;
        }
        assert_true(samples > 60 && commands > 20);
    }
}

// With jitter a delay of periods is one of nominal periods: a command that no sample
// overtakes takes effect just so long after its sample.
TEST(delays_are_nominal_periods_with_jitter)
{
    RIG_RUN(r, "control.law=hybrid run.duration=0.5 control.rate=200 "
               "control.jitter=0.002 control.delay_periods=0.5 sensor.dac_bits=0");
    double sampled = -1, sent = 0;
    int commands = 0;
    for (size_t k = 1; k < r.trace.row_count; k++) {
        const sample *was = &r.trace.rows[k - 1], *is = was + 1;
        if (was->command != is->command && !isnan(was->command)) {
            sampled = is->time;
            sent = is->command;
        }
        if (was->voltage != is->voltage && sampled >= 0 && is->voltage == sent) {
            check_close(is->time - sampled, 0.0025, 1e-9);
            commands++;
        }
    }
    assert_true(commands > 20);
}

// Arms with decays or vibrations much faster than the motion of interest: they take few
// strides or report why not, and their slow modes are right. And arms that start on the
// wall, with first flights that are lower than rounding.
#include "src/contact/zeno_monitor.h"
#include "tests/explicit_stepper.h"
#include "tests/passage.h"

// Two equal links on a rigid wall, arms that nothing but the motor damps, and all others.
TEST(each_arm_has_its_engine)
{
    static const struct {
        const char *settings[4];
        const engine *by;
    } cases[] = {
        // two links
        {{NULL}, &taylor_engine},
        {{"arm.damping_ratio=0.3", "wall.restitution=0.5"}, &taylor_engine},
        {{"arm.hub_joint=spring", "arm.hub_inertia=1e-6", "arm.damping_ratio=0.02"},
         &stiff_engine},
        {{"arm.tip_mass=0.1"}, &stiff_engine},
        {{"motor.current_limit=0.2"}, &stiff_engine},
        {{"motor.inductance=1e-3"}, &stiff_engine},
        {{"wall.contact=kelvin-voigt", "wall.damping=0"}, &stiff_engine},
        {{"wall.contact=kelvin-voigt", "wall.damping=50"}, &stiff_engine},
        {{"wall.contact=hunt-crossley", "wall.damping=0"}, &stiff_engine},

        // other chains
        {{"arm.links=3"}, &stiff_engine},
        {{"arm.links=64", "wall.restitution=0.9"}, &stiff_engine},
        {{"arm.links=16", "wall.contact=kelvin-voigt", "wall.damping=50"}, &stiff_engine},
        {{"arm.links=16", "wall.contact=kelvin-voigt", "wall.damping=1e4"},
         &stiff_engine},
        {{"arm.links=3", "arm.damping_ratio=1e-4"}, &stiff_engine},
        {{"arm.links=3", "arm.modal_ratios=0.01"}, &stiff_engine},
        {{"arm.links=3", "arm.air_drag=0.01"}, &stiff_engine},
        {{"arm.links=3", "arm.stiffening=1"}, &stiff_engine},
        {{"arm.links=1"}, &stiff_engine},
    };
    for (EACH(c, cases)) {
        const parameters p = fixture_parameters(c->settings);
        STARTED(a, m, &p, NULL, 0, 0);
        fail_if(m->engine != c->by, "case %td goes by %s, not %s", c - cases,
                m->engine->name, c->by->name);
    }
}

// A hub of a milligram square metre on a damped spring: its decay of 4e8 1/s is over at
// once.
TEST(a_stiff_hub_takes_few_strides)
{
    for (int links = 2; links <= 4; links++) {
        parameters p = parameters_with("arm.hub_joint=spring arm.hub_inertia=1e-6 "
                                       "arm.damping_ratio=0.02 motor.voltage=1");
        p.arm.links = links;
        passage stiff = passage_of(&p, 0, 0, 0.35, 2000);
        assert_true(stiff.impacts >= 1);
        check_below(stiff.open, 1e-6);
    }
}

// The two-link arm of a stiffer hub, and by the explicit formula.
TEST(a_stiff_pair_moves_as_by_the_formula)
{
    parameters p =
        parameters_with("arm.links=2 arm.hub_joint=spring arm.hub_inertia=2e-4 "
                        "arm.damping_ratio=0.02 motor.voltage=1 wall.restitution=0.5");
    passage stiff = passage_of(&p, 0.09, 0.3, 0.1, 2000);
    passage formula = passage_by(&p, &explicit_engine, 0.09, 0.3, 0.1, 200000);
    assert_true(stiff.impacts > 2);
    assert_int_equal(stiff.impacts, formula.impacts);
    check_relative(stiff.momentum, formula.momentum, 1e-6);
}

// An edit in mid-run makes the arm stiff: the motion goes on by what is right for it
// then, as the same arm would that went on from a copy of its state.
TEST(an_arm_made_stiff_changes_its_engine)
{
    for (int links = 2; links <= 3; links++) {
        parameters p = parameters_with(
            "arm.hub_joint=spring arm.k1=500 arm.damping_ratio=0 motor.voltage=1");
        p.arm.links = links;
        arm before, after;
        arm_init(&before, &p);
        KEPT_MOTION(m) = motion_create(&before, &p.method);
        motion_start(&before, m, 0, 0);
        move_on(&before, m, 0.1, 100000);
        const engine *soft = m->engine;

        // edited
        p.arm.k1 = 1e8;
        p.arm.damping_ratio = 0.02;
        arm_init(&after, &p);
        assert_true(after.fastest_decay > 1e6);
        motion_follow_arm(&after, m);
        motion_rebind(&before, &after, m);
        assert_int_equal(m->engine != soft, links == 2);
        KEPT_MOTION(copy) = motion_create(&after, &p.method);
        assert_ptr_equal(copy->engine, m->engine);
        memcpy(copy->state, m->state, (size_t)m->size * sizeof(double));
        copy->record.start_energy = m->record.start_energy;
        passage on = move_on(&after, m, 0.35, 2000);
        move_on(&after, copy, 0.35, 2000);
        assert_true(on.impacts >= 1);
        assert_memory_equal(copy->state, m->state,
                            (size_t)(m->head_size - KEPT_COUNT) * sizeof(double));

        // and back
        motion_follow_arm(&before, m);
        motion_rebind(&after, &before, m);
        assert_ptr_equal(m->engine, soft);
    }
}

// A stride begins with what decays make of rounding, over at once: the force does not
// leave its band for that, and has settled when its rows have.
TEST(a_stride_that_begins_does_not_unsettle_the_force)
{
    scenario s = {
        .parameters = parameters_with(
            "arm.links=7 arm.hub_joint=spring arm.k1=28214.187 "
            "arm.length=0.384470708390 arm.mass=0.230311454988 "
            "arm.hub_inertia=2.421274642e-4 arm.k2=3.677424150693 "
            "arm.damping_ratio=1 wall.kind=plane wall.angle=1.722191930126 "
            "motor.stiction=0.01 motor.voltage=-0.965138971621489 run.duration=2")};
    KEPT_RUN(r) = run_done(&s, true);
    const double steady = r.summary.steady_force_N;
    size_t outside = 0;
    for (size_t i = 0; i < r.trace.row_count; i++) {
        outside = fabs(r.trace.rows[i].force - steady) > 0.05 * steady ? i : outside;
    }
    const double settled = r.trace.rows[outside + 1].time - r.summary.first_contact_s;
    check_close(r.summary.settling_time_s, settled, 2e-3);
}

// A damper so strong that the arm rests on it for ever: a run that could not end says so
// after a bounded effort.
TEST(a_run_that_could_not_end_says_so)
{
    for (EACH_TEXT(c, "wall.damping=1e12", "wall.damping=1e15")) {
        scenario s = {
            .parameters = parameters_with(
                "wall.contact=kelvin-voigt %s initial.angle=0.099 initial.velocity=0.7",
                *c)};
        KEPT_RUN(r);
        assert_int_equal(run_scenario(&s, false, &r), STATUS_NO_PROGRESS);
        assert_int_equal(r.summary.status, STATUS_NO_PROGRESS);
        assert_true(r.summary.message[0] != '\0');
        assert_true(r.summary.steps > 0);
    }
}

// Arms with decays, of a light hub, a wall's damper or a current, that are over at once
// and would shorten the strides of a formula that is not stiff; at the default tolerance.
TEST(decays_do_not_shorten_strides)
{
    static const char *const arms[][7] = {
        {"arm.links=3", "arm.hub_joint=spring", "arm.hub_inertia=1e-6",
         "arm.damping_ratio=0.02", "arm.tip_mass=0.01"},
        {"wall.contact=kelvin-voigt", "wall.damping=1e6", "initial.angle=0.099",
         "initial.velocity=0.7"},
        {"arm.links=128", "arm.damping_ratio=0.01", "motor.inductance=1e-3"},
        {"motor.inductance=1e-12"},
    };
    for (EACH(c, arms)) {
        scenario s = {.parameters = fixture_parameters(*c)};
        s.parameters.method.tolerance = fresh(ARM_CORRECTED).method.tolerance;
        KEPT_RUN(r) = run_done(&s, false);
        assert_true(r.summary.steps < 2000);
        check_below(r.summary.energy_residual_J, 1e-7 * r.summary.motor_work_J);
    }
}

// The sentence about too short strides names their cause.
TEST(a_run_that_could_not_end_says_why)
{
    static const struct {
        const char *settings[8];
        double angle, velocity;
        const char *cause;
    } cases[] = {
        {{"arm.links=3", "arm.damping_ratio=0.01"}, 0, 0, "fastest mode of the arm"},
        {{"arm.links=3"}, 0, -1e9, "too fast to follow"},
        {{"wall.contact=kelvin-voigt", "wall.stiffness=1e6", "wall.angle=0"},
         0,
         0.1,
         "wall.damping"},
        {{"wall.contact=kelvin-voigt", "wall.stiffness=1e6"},
         0,
         0,
         "fastest mode of the arm"},
        {{"motor.inductance=1"}, 0, 0, "fastest mode of the arm"},
        {{"arm.links=3", "wall.restitution=0.5"}, 0, 0, "arm.damping_ratio"},
    };
    for (EACH(c, cases)) {
        parameters p = fixture_parameters(c->settings);
        STARTED(a, m, &p, NULL, c->angle, c->velocity);

        // the first check only begins to count, and none has passed since
        zeno_monitor looked = zeno_monitor_begin();
        DONE(zeno_monitor_check(&looked, &a, m, 1, 1e-3, &f));
        REFUSED(STATUS_NO_PROGRESS, c->cause,
                zeno_monitor_check(&looked, &a, m, 1, 1e-3, &f));
    }
}

// An arm that a wall throws off and meets again by turns, with no time between, or next
// to none: the run says that it is the wall, also where it ends in flight.
TEST(a_run_that_stands_still_at_a_wall_says_so)
{
    static const struct {
        const char *settings[6];
        const char *cause;
    } cases[] = {
        {{"wall.contact=kelvin-voigt", "wall.damping=1e15"}, "wall.damping"},
        {{"wall.contact=kelvin-voigt", "wall.damping=1e15", "arm.links=8"},
         "wall.damping"},
        {{"wall.contact=kelvin-voigt", "wall.damping=1e15", "wall.mass=1e-9"},
         "wall.mass"},
        {{"wall.contact=kelvin-voigt", "wall.damping=0", "wall.stiffness=1e15",
          "wall.mass=1e-9", "wall.restitution=1"},
         "smaller wall.stiffness"},
    };
    for (EACH(c, cases)) {
        scenario s = {.parameters = fixture_parameters(c->settings)};
        s.parameters.initial.angle = 0.099;
        s.parameters.initial.velocity = 0.7;
        KEPT_RUN(r);
        assert_int_equal(run_scenario(&s, false, &r), STATUS_NO_PROGRESS);
        fail_if(strstr(r.summary.message, c->cause) == NULL, "case %td, '%s': %s",
                c - cases, c->cause, r.summary.message);
    }

    // strides half of which end in contact, and a look in flight
    parameters p = parameters_with("wall.contact=kelvin-voigt");
    STARTED(a, m, &p, NULL, 0, 0);
    zeno_monitor looked = {.steps = ZENO_STEPS, .touching = ZENO_STEPS / 2};
    REFUSED(STATUS_NO_PROGRESS, "wall.damping",
            zeno_monitor_check(&looked, &a, m, 1, 1e-3, &f));
}

// Where strides are expensive, with many links, fewer of them are enough to give a run
// up.
TEST(expensive_strides_are_given_up_sooner)
{
    static const struct {
        const char *settings[4];
        int most; // strides
    } cases[] = {
        {{"wall.contact=kelvin-voigt", "wall.damping=1e12"}, 3 * ZENO_STEPS},
        {{"wall.contact=kelvin-voigt", "wall.damping=1e9", "arm.links=128"},
         ZENO_STEPS / 4},
    };
    for (EACH(c, cases)) {
        const parameters p = fixture_parameters(c->settings);
        STARTED(a, m, &p, NULL, 0.099, 0.7);
        zeno_monitor kept = zeno_monitor_begin();
        fault f;
        status s = STATUS_OK;
        for (int strides = 0; s == STATUS_OK; strides++) {
            assert_true(strides < c->most);
            step_on(&a, m, 1, 1e-3);
            s = zeno_monitor_count(&kept, &a, m, 1, 1e-3, &f);
        }
        assert_int_equal(s, STATUS_NO_PROGRESS);
    }
}

// A program that goes back to a state a thousand times, or asks for instants a nanosecond
// apart, has as many strides as it asks for.
TEST(a_loop_makes_as_many_strides_as_are_asked_for)
{
    enum { EPISODES = 750, STEPS = 100, INSTANTS = 70000 };
    scenario s = {.parameters = parameters_with("run.duration=1")};
    const loop_options options = {0};
    run_loop *l;
    DONE(loop_create(&l, &s, &options, &f));
    const size_t size = loop_saved_size(l);
    KEPT_TEXT(kept) = malloc(2 * size);
    assert_non_null(kept);
    loop_save(l, kept);
    DONE(loop_until(l, 0.5, &f));
    loop_save(l, kept + size);
    loop_destroy(l);

    // a first stride late, then the first tenth of a second again and again
    DONE(loop_create(&l, &s, &options, &f));
    DONE(loop_restore(l, kept + size, size, &f));
    DONE(loop_until(l, 1, &f));
    for (int i = 0; i < EPISODES; i++) {
        DONE(loop_restore(l, kept, size, &f));
        for (int k = 1; k <= STEPS; k++) {
            DONE(loop_until(l, k * 1e-3, &f));
        }
    }

    // and on by less than any run is to take
    DONE(loop_restore(l, kept, size, &f));
    for (int i = 1; i <= INSTANTS; i++) {
        DONE(loop_until(l, i * 1e-9, &f));
    }
    check_close(loop_time(l), INSTANTS * 1e-9, 0);
    loop_destroy(l);
}

// On the wall from the start and going into it: an impact at once, whatever rounding
// makes of the gap, and then flights of less than 1e-15 m, which Runge-Kutta cannot tell
// from rounding.
TEST(an_arm_that_starts_on_the_wall_strikes_it)
{
    static const int links[] = {1, 2, 3, 6, 8, 10, 16};
    for (int i = 0; i < 7 * 4; i++) {
        parameters p = parameters_with("motor.voltage=1");
        p.arm.links = links[i / 4];
        p.wall.kind = i & 1 ? WALL_PLANE : WALL_POINT;
        p.wall.restitution = i & 2 ? 0.5 : 0;
        passage series = passage_of(&p, p.wall.angle, 0.7, 0.05, 1000);
        passage formula = passage_by(&p, &explicit_engine, p.wall.angle, 0.7, 0.05, 2000);
        assert_true(series.impacts >= 1 && formula.impacts >= 1);
        assert_int_equal(series.impacts + series.touches,
                         formula.impacts + formula.touches);
        check_relative(series.momentum, formula.momentum, 1e-9);
        check_below(series.open, 1e-9);
        check_below(formula.open, 1e-9);
    }
}

// A heavy soft chain behind a light hub, with decays of 3e7 1/s, that meets its wall
// once. The explicit formula needs a million strides for this; its answers are given.
TEST(an_impact_is_one_of_the_exact_gap)
{
    parameters p = parameters_with(
        "wall.kind=plane arm.links=6 arm.hub_joint=spring "
        "motor.voltage=-0.5147139341175766 motor.amplifier_gain=13.842765371652092 "
        "motor.torque_constant=0.3932365213925073 motor.back_emf=0 "
        "motor.viscous_friction=0.015406106879498435 motor.stiction=0 "
        "wall.angle=1.0716751263078903 wall.restitution=0.9370014048532785 "
        "arm.length=0.450056287740594 arm.mass=987.1087265748487 "
        "arm.hub_inertia=8.737877005452665e-06 arm.k1=6.9454369649959515 "
        "arm.k2=0.017774528852759045 arm.damping_ratio=0.4640065081757673");
    passage stiff = passage_of(&p, 0.84478210510148122, 3.1260960827520616, 0.13, 5000);
    assert_int_equal(stiff.impacts, 1);
    check_relative(stiff.momentum, 129.426073814, 1e-9);
    check_below(stiff.open, 1e-7);
}

// A chain with decays of 8e6 1/s that bounces and then presses on the wall, bent and at
// rest: what small changes mean there is told by its energy, not by velocities of next to
// nothing.
TEST(an_arm_at_rest_takes_few_strides)
{
    parameters p = parameters_with(
        "wall.kind=plane arm.links=17 arm.hub_joint=spring "
        "motor.voltage=6.7365767390474254 motor.amplifier_gain=14.453409212005569 "
        "motor.torque_constant=6.1153868614456117 motor.back_emf=0.26887346231218617 "
        "motor.resistance=8.0031000871345093 "
        "motor.viscous_friction=0.020549187441489439 "
        "motor.stiction=0.18169370328427453 wall.angle=-0.17752419360221161 "
        "wall.restitution=1 arm.length=1.4657183229289217 "
        "arm.hub_inertia=0.021138195229693537 arm.k1=94477.653277027581 "
        "arm.k2=13673.25777524287 arm.damping_ratio=0.040977110363111233 "
        "initial.angle=-0.4");
    passage stiff = passage_of(&p, -0.35592624390555305, 1.7913204322644631, 0.3, 3000);
    assert_true(stiff.impacts > 100);
    check_below(stiff.open, 1e-6);
}

// A light hub before a heavy beam: what the hub's own fast vibration loses to back EMF
// turns twice as far in a stride as the vibration.
TEST(what_a_fast_hub_loses_is_all_booked)
{
    parameters p = parameters_with("arm.hub_joint=beam arm.length=27.7 arm.mass=594 "
                                   "arm.hub_inertia=0.0022 arm.k2=176 motor.back_emf=15 "
                                   "motor.stiction=0 motor.voltage=-3");
    for (int links = 3; links <= 12; links += 3) {
        p.arm.links = links;
        check_below(passage_of(&p, -0.8, 0, 0.3, 1000).open, 1e-9);
    }
}

// Without damping, of the joints or of the motor, nothing is booked as lost to it, and
// the ledger closes as it does with both: in flight, on the wall, pressed to it and bent.
TEST(an_arm_without_damping_loses_nothing_to_it)
{
    for (int i = 0; i < 8; i++) {
        const bool joints = i & 1, hub = i & 2, stands = i & 4;
        parameters p = parameters_with(
            "arm.links=4 arm.hub_joint=spring arm.hub_inertia=2e-4 arm.k1=169468 "
            "%s %s motor.back_emf=0 motor.voltage=0.5 %s",
            joints ? "arm.damping_ratio=1e-3" : "arm.damping_ratio=0",
            hub ? "motor.viscous_friction=0.01" : "motor.viscous_friction=0",
            stands ? "wall.kind=point" : "wall.kind=none");
        STARTED(a, m, &p, &stiff_engine, 0.09, 0.3);
        const passage all = move_on(&a, m, 0.1, 5000);
        assert_int_equal(all.impacts > 0, stands);
        check_below(all.open, 1e-8);
        const double *lost = state_quadratures(m, m->state);
        assert_int_equal(lost[QUADRATURE_DAMPING] != 0, joints);
        assert_int_equal(lost[QUADRATURE_VISCOUS] != 0, hub);
    }
}
